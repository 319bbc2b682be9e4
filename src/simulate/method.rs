//! How time is stepped: the integrator and what inputs do between samples.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Explicit fixed-step methods, one step a sample.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// First order. For comparison only: Góes, Hemerly, Maciel found it unfit for reconstruction.
    Euler,
    /// Heun's method, second order: the mean of the slopes at both ends of the step.
    Rk2,
    /// The classical Runge-Kutta method, fourth order.
    #[default]
    Rk4,
}

/// What an input does between two samples.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum InputInterpolation {
    /// A straight line: at half a step the mean of both samples.
    #[default]
    Linear,
    /// The value of the earlier sample, held.
    Hold,
}
