//! What a mapping says of a channel.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::super::union::Between;
use super::{ChannelTime, NoValue, Titles};

/// How a channel is made from a file.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct MappedChannel {
    /// Where its values are in the file: a variable, field, column or title, or several to choose from.
    pub(in super::super) from: Titles,
    /// `-` for a pure number; it must be said where the file does not say it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub(in super::super) unit: String,
    /// What recorded numbers are multiplied by before the unit is applied.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) scale: Option<f64>,
    /// 1 or -1: another sense than the recorded one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) sign: Option<i8>,
    /// Numbers and words that stand for no value on this channel.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(in super::super) missing: Vec<NoValue>,
    /// Where its values have times of their own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) time: Option<ChannelTime>,
    /// What it has at the times of the other channels: `missing`, `held` or `straight`.
    #[serde(default, skip_serializing_if = "Between::is_missing")]
    pub(in super::super) between: Between,
}

impl MappedChannel {
    /// What recorded numbers are multiplied by.
    pub(in super::super) fn factor(&self) -> f64 {
        self.scale.unwrap_or(1.0) * f64::from(self.sign.unwrap_or(1))
    }
}
