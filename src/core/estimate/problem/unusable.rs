//! Why a θ gives no cost.

use crate::simulate::{Diverged, MOST_DELAY};

/// Why a θ gives no cost.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
pub enum Unusable {
    /// The simulation left the range of numbers.
    #[error("the simulation leaves the range of numbers (segment {}, sample {})", segment + 1, sample + 1)]
    LeftRange { segment: usize, sample: usize },
    /// Outputs are finite, but the cost or a derivative of an output is not.
    #[error("the cost, an output or a derivative of an output is not a finite number")]
    NotFinite,
    /// The Riccati equation of the Kalman filter has no solution with which the filter is stable.
    #[error("the Kalman filter of segment {} has no steady gain with which it is stable", segment + 1)]
    NoSteadyGain { segment: usize },
    /// An input or output is delayed by more than [`MOST_DELAY`] samples, or by no number; by its
    /// place in [`crate::model::Delays::at`].
    #[error("an input or output is delayed by more than {MOST_DELAY} samples of segment {}", segment + 1)]
    Delayed { segment: usize, delay: usize },
    /// The covariance of the residuals is singular: some outputs' residuals are not independent.
    #[error("the residuals of some outputs are not independent: their covariance is singular")]
    SingularNoise,
    /// Equation error was asked for, and no output measures a state.
    #[error("no output measures a state, as equation error needs")]
    NoMeasuredState,
}

pub(crate) fn left_range(segment: usize, diverged: &Diverged) -> Unusable {
    Unusable::LeftRange {
        segment,
        sample: diverged.sample,
    }
}
