//! Levenberg-Marquardt damping λ, relative to the scaled information matrix; 0 is a Gauss-Newton step.

use crate::estimate::options::Method;

/// Where it starts, ...
pub(crate) const START: f64 = 1e-3;
/// ... what failure and success make of it, ...
const RAISED: f64 = 10.0;
const EASED: f64 = 1e-2;
/// ... and below what it is none.
const NONE: f64 = 1e-10;

pub(crate) fn start(method: Method) -> f64 {
    match method {
        Method::LevenbergMarquardt => START,
        Method::GaussNewton => 0.0,
    }
}

/// After a step that did not lower the cost.
pub(crate) fn raised(damping: f64) -> f64 {
    (damping * RAISED).max(START)
}

/// After a step that did.
pub(crate) fn eased(damping: f64) -> f64 {
    let eased = damping * EASED;
    if eased < NONE { 0.0 } else { eased }
}
