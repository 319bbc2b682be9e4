//! One iteration of a solver, and why the last was the last.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Why the solver stopped. A result with a reason, apart from the job's own status.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// A further step would move the estimate by less than the tolerance.
    Converged,
    /// As converged, with at least one parameter held at its bound.
    AtBound,
    /// The data cannot tell some parameters apart, or not see them: see `collinear`.
    Singular,
    /// No step lowers the cost any more, before the tolerance was met.
    Stalled,
    /// The simulation left the range of numbers and no smaller step brought it back.
    Diverged,
    /// The budget of iterations is used up.
    Budget,
    /// Stopped on request; the best iterate is kept.
    Cancelled,
}

impl Outcome {
    /// As it is written in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::AtBound => "at_bound",
            Self::Singular => "singular",
            Self::Stalled => "stalled",
            Self::Diverged => "diverged",
            Self::Budget => "budget",
            Self::Cancelled => "cancelled",
        }
    }

    /// Whether the solver stopped before it was at a minimum of any kind.
    pub fn is_short(self) -> bool {
        matches!(
            self,
            Self::Stalled | Self::Diverged | Self::Budget | Self::Cancelled
        )
    }

    /// Whether the estimate is the minimum that was asked for.
    pub fn is_minimum(self) -> bool {
        matches!(self, Self::Converged | Self::AtBound)
    }
}

/// One iteration, as told to an observer.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Iteration {
    /// 0 is the start value; a second try, from another start, counts on.
    #[schema(example = 3)]
    pub number: usize,
    /// -ln L, the negative log-likelihood J(θ, R), plus ½ Σ ((θ - mean)/sd)² of the parameters' priors.
    #[schema(example = -4821.7)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub cost: f64,
    /// det R, what the field's programs print as cost.
    #[schema(example = 8.9377e-12)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub det_r: f64,
    /// Variance of each output's residual, SI units squared (the diagonal of R).
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub variance: Vec<f64>,
    /// All free parameters in the order of the parameter table, each in its own unit; with filter error the free
    /// process noises follow, in the order of the states.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub parameters: Vec<f64>,
    /// Length of the gradient of the cost, each component times the standard error that the parameter
    /// would have if it were the only one.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub gradient_norm: f64,
    /// Length of the step that led here, in standard errors; 0 for the start.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub step: f64,
    /// Levenberg-Marquardt damping λ, relative to the scaled information matrix; 0 for Gauss-Newton.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub damping: f64,
    /// How often the step was shortened.
    pub halvings: usize,
}
