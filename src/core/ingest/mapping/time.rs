//! Where a mapping says that time is: that of the recording, and that of channels and tables with times of their own.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::Titles;

/// Either `from`, or `step` (with `start`, else 0) for even sampling.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct MappedTime {
    /// May be left out where a table says it, or has time stamps.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub(in super::super) unit: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) from: Option<Titles>,
    /// The column of a table that has the date of a time of day.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) date: Option<Titles>,
    /// The column of a table that has the week of the satellites' clock; `from` has its seconds, or in `unit`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) week: Option<Titles>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) start: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) step: Option<f64>,
    /// What is made of several rows of a table with one time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) repeated: Option<Repeated>,
}

impl MappedTime {
    pub(super) fn is_silent(&self) -> bool {
        *self == Self::default()
    }

    /// Whether it says where time is.
    pub(super) fn is_stated(&self) -> bool {
        self.from.is_some() || self.step.is_some()
    }
}

/// What is made of several rows with one time. Rows that are the same in all cells are kept once in any case.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(in super::super) enum Repeated {
    /// The first is kept.
    First,
    /// The mean of each channel is kept.
    Mean,
    /// All are kept, evenly between this time and the next: the clock is coarser than the rate.
    Spread,
}

/// A time axis of its own.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct Axis {
    /// Absent: as the file says it, or the recording's.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "AIR(:,1)")]
    pub(in super::super) from: Option<Titles>,
    /// Absent: that of the recording's time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in super::super) unit: Option<String>,
    /// Seconds that are added to its times.
    #[serde(default)]
    #[schema(example = 0.12)]
    pub(in super::super) offset: f64,
}

/// The source of a time axis, in the unit of the recording's time; or all that is to be said of it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub(in super::super) enum ChannelTime {
    From(Titles),
    Axis(Axis),
}

impl ChannelTime {
    /// All that is said of it.
    pub(in super::super) fn axis(&self) -> Axis {
        match self {
            Self::From(from) => Axis {
                from: Some(from.clone()),
                ..Axis::default()
            },
            Self::Axis(axis) => axis.clone(),
        }
    }
}
