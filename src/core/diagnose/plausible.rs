//! The range in which the size of an effect is looked for.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::flight::Unit;
use crate::model::{Parameter, Prior};

/// The range in which the size of an effect is looked for, SI.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Plausible {
    /// Least size, SI, from nothing.
    #[schema(example = -0.3)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub lower: f64,
    /// Largest size, SI, from nothing.
    #[schema(example = 0.3)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub upper: f64,
    /// Standard deviation of sizes that are usual; of what is known, it counts in the estimate.
    #[schema(example = 0.1)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub sd: f64,
    /// Whether the job says it, or the model does by declaring where the sensor is.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub known: bool,
}

impl Plausible {
    /// Bounds a parameter that is the size of an effect; `none` is its value without effect, in its own unit. Where its own
    /// range is narrower, as that of what cannot be negative, it stays so.
    pub(super) fn bound(&self, size: &mut Parameter, none: f64) {
        let unit = Unit::parse(&size.unit).unwrap_or(Unit::NONE);
        let lower = none + self.lower / unit.scale;
        let upper = none + self.upper / unit.scale;
        size.lower = Some(size.lower.map_or(lower, |own| own.max(lower)));
        size.upper = Some(size.upper.map_or(upper, |own| own.min(upper)));
        if self.known && self.sd > 0.0 {
            size.prior = Some(Prior {
                mean: none,
                sd: self.sd / unit.scale,
            });
        }
    }
}
