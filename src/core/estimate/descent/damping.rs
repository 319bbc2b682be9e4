//! Levenberg-Marquardt damping λ, relative to the scaled information matrix; 0 is a Gauss-Newton step.
//!
//! How much of what the quadratic model promised a step gained says how far that model can be trusted (Marquardt 1963;
//! Nielsen, IMM-REP-1999-05; Madsen, Nielsen, Tingleff 2004): λ falls after a step that gained it, and grows after one that
//! did not, each time from where it was.

use crate::estimate::options::Method;

/// Where it starts, ...
const START: f64 = 1e-3;
/// ... the least that a step which failed makes of it, and how it grows from there, ...
const LEAST_RAISED: f64 = 1e-6;
const RAISED: f64 = 10.0;
/// ... and below what it is none.
const NONE: f64 = 1e-10;

/// Gains above this share show that the quadratic model holds, those below the other that it does not.
const HOLDS: f64 = 0.75;
const FAILS: f64 = 0.25;
/// What the damping is multiplied by above, between, and below.
const EASED: f64 = 1e-2;
const EASED_LITTLE: f64 = 0.3;
const GROWN: f64 = 2.0;

/// Where it starts.
pub(crate) fn start(method: Method) -> f64 {
    match method {
        Method::LevenbergMarquardt => START,
        Method::GaussNewton => 0.0,
    }
}

/// After a step that did not lower the cost.
pub(crate) fn raised(damping: f64) -> f64 {
    (damping * RAISED).max(LEAST_RAISED)
}

/// After one that did; `gain` is the share of what the quadratic model promised.
pub(crate) fn eased(damping: f64, gain: f64) -> f64 {
    let eased = if gain > HOLDS {
        damping * EASED
    } else if gain > FAILS {
        damping * EASED_LITTLE
    } else {
        damping * GROWN
    };
    if eased < NONE { 0.0 } else { eased }
}
