//! Minimisation on gradients alone: BFGS with bounds, and output-error estimation by it.
//!
//! What a Gauss-Newton step knows from ∂y/∂θ, a quasi-Newton method must gather from one gradient after the
//! other. Nocedal, Wright, Numerical Optimization, chapters 3 and 6.

mod line_search;
pub(in crate::estimate) mod optimiser;
pub(in crate::estimate) mod solve;

pub use optimiser::{Moved, NoWay, Objective, Optimiser, Update};
