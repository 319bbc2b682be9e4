//! What is known of the parameters after a sample.

use serde::Serialize;
use utoipa::ToSchema;

/// A parameter that is followed.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, ToSchema)]
pub struct TrackedParameter {
    /// As the model has it.
    #[schema(example = "Ma")]
    pub name: String,
    /// The parameter's unit.
    #[schema(example = "1/s^2")]
    pub unit: String,
}

/// Estimates after a sample, in the order of [`super::Tracker::parameters`] and in the parameters' own units. NaN: the data do not
/// determine it yet.
#[derive(Clone, PartialEq, Debug)]
pub struct Estimates {
    /// The time up to which samples count in them, s. With `rls` it is half a window before that of the last sample.
    pub time: f64,
    /// How many samples count in them, with forgetting all those that ever did.
    pub samples: usize,
    /// θ.
    pub values: Vec<f64>,
    /// Standard deviations of the estimates.
    pub standard_errors: Vec<f64>,
}

impl Estimates {
    pub(super) fn none(parameters: usize) -> Self {
        Self {
            time: f64::NAN,
            samples: 0,
            values: vec![f64::NAN; parameters],
            standard_errors: vec![f64::NAN; parameters],
        }
    }
}
