//! From one θ to the next until there is a reason to stop. The cost never rises from one iterate to the next, but for
//! rounding, and where the other method begins anew.

pub(super) mod acceleration;
pub(super) mod damping;
pub(super) mod fallback;
pub(super) mod gauss_newton;
pub(super) mod iterate;
pub mod quasi_newton;
pub(super) mod search;
pub(super) mod step;
pub(super) mod stopped;

use nalgebra::DMatrix;

use iterate::Iterate;
use stopped::Stopped;

/// Where an iteration ended, and why.
pub(crate) struct Descent<E> {
    pub evaluator: E,
    /// The information matrix at the start; none where the iteration looks at gradients alone.
    pub first_information: Option<DMatrix<f64>>,
    pub last: Iterate,
    pub iterations: usize,
    pub stopped: Stopped,
}
