//! Minimisation on gradients alone: BFGS with bounds, and output-error estimation by it.
//!
//! A quasi-Newton method gathers from one gradient after the other the curvature that a Gauss-Newton step has from
//! ∂y/∂θ at once. Nocedal, Wright, Numerical Optimization, chapters 3 and 6.

mod line_search;
pub(in crate::estimate) mod optimiser;
pub(in crate::estimate) mod solve;

pub use optimiser::{Moved, NoWay, Objective, Optimiser, Update};
