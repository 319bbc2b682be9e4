//! How the model was stepped through time, and what the steps are worth.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// How the model was stepped through time, and what the steps are worth.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Integration {
    /// Integration steps from one sample to the next, by segment; where samples are uneven, the most.
    #[schema(example = json!([1]))]
    pub steps_per_sample: Vec<usize>,
    /// The fastest motion along the estimate, in each step: the largest |λ| h of the linearised model. Above 1 the
    /// classical Runge-Kutta method is inaccurate, above 2.8 unstable.
    #[schema(example = 0.21)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub fastest: f64,
    /// How far estimates would move if each step were halved; absent where standard errors mean nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub halved: Option<HalvedSteps>,
}

/// How far estimates would move if each integration step were halved, in their standard errors.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct HalvedSteps {
    /// None would move by more. Where `shifts` is empty this is a bound from the outputs alone, and the shifts are
    /// smaller.
    #[schema(example = 0.0031)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub most: f64,
    /// By free parameter, in the order of the iterations' `parameters`; `null` where a parameter has no standard error.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shifts: Vec<Option<f64>>,
}

impl Integration {
    /// The most steps from one sample to the next.
    pub fn most_steps(&self) -> usize {
        self.steps_per_sample.iter().copied().max().unwrap_or(1)
    }
}
