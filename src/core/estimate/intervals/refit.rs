//! One more fit, from where another one ended.

use crate::estimate::descent::gauss_newton::descend_with;
use crate::estimate::descent::stopped::Stopped;
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::problem::Problem;
use crate::estimate::report::progress::unobserved;

/// Where a descent stalls so near to a minimum, rounding or a corner keeps it; standard errors.
const NEAR: f64 = 0.1;

/// A minimum and its -ln L.
pub(super) struct Minimum {
    pub theta: Vec<f64>,
    pub cost: f64,
}

/// The minimum from a θ; none where the descent finds none.
pub(super) fn refit(problem: &Problem, from: Vec<f64>) -> Option<Minimum> {
    let mut evaluator = Evaluator::new(problem);
    if problem.unknowns.is_empty() {
        let cost = evaluator.cost(&from).ok()?;
        return Some(Minimum { theta: from, cost });
    }
    let descent = descend_with(evaluator, from, &mut unobserved).ok()?;
    let is_minimum = match descent.stopped {
        Stopped::Minimum { .. } => true,
        Stopped::Stalled { distance } | Stopped::Corner { distance } => distance < NEAR,
        _ => false,
    };
    is_minimum.then_some(Minimum {
        cost: descent.last.weighting.cost,
        theta: descent.last.theta,
    })
}
