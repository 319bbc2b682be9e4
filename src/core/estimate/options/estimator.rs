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
    /// Output error in the frequency domain: transforms of the outputs over a band of frequencies are compared with the
    /// model's frequency response times those of the inputs. Nothing is integrated; delays are exact; biases and drifts
    /// are left out. See `frequency`.
    OutputErrorFrequency,
    /// Equation error in the frequency domain: least squares of the transformed state equations on transforms of the
    /// measured states, whose derivatives are these times iω. See `frequency`.
    EquationErrorFrequency,
}

impl Estimator {
    /// All of them, in the order of the help.
    pub const ALL: [Self; 5] = [
        Self::OutputError,
        Self::FilterError,
        Self::EquationError,
        Self::OutputErrorFrequency,
        Self::EquationErrorFrequency,
    ];

    /// As it is written in a job.
    pub fn name(self) -> &'static str {
        match self {
            Self::OutputError => "output_error",
            Self::FilterError => "filter_error",
            Self::EquationError => "equation_error",
            Self::OutputErrorFrequency => "output_error_frequency",
            Self::EquationErrorFrequency => "equation_error_frequency",
        }
    }

    /// Whether it compares transforms, not samples.
    pub fn is_in_frequency_domain(self) -> bool {
        match self {
            Self::OutputErrorFrequency | Self::EquationErrorFrequency => true,
            Self::OutputError | Self::FilterError | Self::EquationError => false,
        }
    }

    /// Whether it regresses the state equations on measured states.
    pub fn is_equation_error(self) -> bool {
        match self {
            Self::EquationError | Self::EquationErrorFrequency => true,
            Self::OutputError | Self::FilterError | Self::OutputErrorFrequency => false,
        }
    }
}
