//! Why a θ gives no cost.

use crate::simulate::Diverged;

/// Why a θ gives no cost.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Unusable {
    /// The simulation left the range of numbers.
    LeftRange { segment: usize, sample: usize },
    /// Outputs are finite, but the cost or a derivative of an output is not.
    NotFinite,
    /// The Riccati equation of the Kalman filter has no solution with which the filter is stable.
    NoSteadyGain { segment: usize },
    /// An element of a path has a size that it cannot have (see [`crate::simulate::path_out_of_bounds`]); by its place
    /// in [`crate::model::Paths::at`].
    Path { segment: usize, place: usize },
    /// The covariance of the residuals is singular: some outputs' residuals are not independent.
    SingularNoise,
    /// Equation error was asked for, and no output measures a state.
    NoMeasuredState,
}

pub(crate) fn left_range(segment: usize, diverged: &Diverged) -> Unusable {
    Unusable::LeftRange {
        segment,
        sample: diverged.sample,
    }
}
