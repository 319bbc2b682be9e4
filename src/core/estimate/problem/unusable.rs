//! Why a θ gives no cost.

use crate::simulate::{Diverged, MOST_DELAY};

/// Why a θ gives no cost.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
pub enum Unusable {
    /// The simulation left the range of numbers.
    #[error("the simulation leaves the range of numbers (segment {}, sample {})", segment + 1, sample + 1)]
    LeftRange {
        /// Index of the segment.
        segment: usize,
        /// Index of the first sample that is not finite, as far as it is known.
        sample: usize,
    },
    /// Outputs are finite, but the cost or a derivative of an output is not.
    #[error("the cost, an output or a derivative of an output is not a finite number")]
    NotFinite,
    /// The Riccati equation of the Kalman filter has no solution with which the filter is stable.
    #[error("the Kalman filter of segment {} has no steady gain with which it is stable", segment + 1)]
    NoSteadyGain {
        /// Index of the segment.
        segment: usize,
    },
    /// An element of a path has a size that it cannot have: no number, a rate limit below 0, or a delay of more than
    /// [`MOST_DELAY`] samples.
    #[error("in segment {} an input or output is delayed by more than {MOST_DELAY} samples, or its rate limited to less than nothing", segment + 1)]
    Path {
        /// Index of the segment.
        segment: usize,
        /// Which element, by its place in [`crate::model::Paths::at`].
        place: usize,
    },
    /// The covariance of the residuals is singular: some outputs' residuals are not independent.
    #[error("the residuals of some outputs are not independent: their covariance is singular")]
    SingularNoise,
    /// Equation error was asked for, and no output measures a state.
    #[error("no output measures a state, as equation error needs")]
    NoMeasuredState,
    /// An estimator of the frequency domain was asked for, and no band of frequencies.
    #[error("an estimator of the frequency domain needs a band of frequencies")]
    NoBand,
}

pub(crate) fn left_range(segment: usize, diverged: &Diverged) -> Unusable {
    Unusable::LeftRange {
        segment,
        sample: diverged.sample,
    }
}
