//! The choice of how many integration steps lie between two samples.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Integration steps from one sample to the next: `"auto"`, or a number from 1 to 1000.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(
    untagged,
    expecting = "steps_per_sample must be \"auto\" or a number of steps from 1 to 1000"
)]
pub enum StepsPerSample {
    /// As many as the fastest motion needs, and the parameters are worth.
    Auto(Auto),
    /// As many everywhere.
    Number(usize),
}

/// The word for it.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Auto {
    /// With `rk4`: one, or more where the fastest eigenvalue times the step would be above 1, and where halving the step
    /// would move a parameter by more than 0.05 of its standard errors. With `euler` and `rk2`, which are there for
    /// comparison: one. A diagnosis keeps the steps with which it begins, so that all models are stepped alike.
    #[default]
    Auto,
}

impl Default for StepsPerSample {
    fn default() -> Self {
        Self::Auto(Auto::Auto)
    }
}

impl StepsPerSample {
    /// The most that may be asked for, or are taken.
    pub const MOST: usize = 1000;

    /// The fault of the number, if it has one.
    pub fn fault(self) -> Option<String> {
        match self {
            Self::Number(count) if !(1..=Self::MOST).contains(&count) => Some(format!(
                "steps_per_sample must be \"auto\" or a number from 1 to {}",
                Self::MOST
            )),
            _ => None,
        }
    }
}
