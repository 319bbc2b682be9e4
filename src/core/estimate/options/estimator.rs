//! Which statistical model an estimate comes from.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The statistical model behind the estimate.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Estimator {
    /// Maximum likelihood with measurement noise: the model is simulated and compared with what was measured.
    #[default]
    OutputError,
    /// The states are disturbed too, as by turbulence: a Kalman filter of steady gain predicts the outputs, and the
    /// intensity of the process noise is estimated along with the parameters.
    FilterError,
    /// Least squares of the state equations on measured, smoothed and differentiated states: quick, needs no start
    /// values, but biased by noise in the states.
    EquationError,
}
