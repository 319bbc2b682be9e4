//! A start from equation error: the regression, as far as a start needs it.

use crate::estimate::descent::gauss_newton::descend;
use crate::estimate::options::Method;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::regression::Regression;
use crate::estimate::report::progress::Observer;

/// Iterations of the regression when it only looks for a start: one where it is linear.
const MOST_ITERATIONS_FOR_A_START: usize = 20;

/// θ of the regression, for output error to start from, and how often it was evaluated; the observer may stop it.
///
/// # Errors
/// No output measures a state, or the regression has no finite residuals.
pub(crate) fn equation_error_start(
    problem: &Problem,
    observer: &mut Observer<'_>,
) -> Result<(Vec<f64>, usize), Unusable> {
    let mut regression = Regression::new(problem).ok_or(Unusable::NoMeasuredState)?;
    let options = &mut regression.problem.options;
    options.max_iterations = MOST_ITERATIONS_FOR_A_START;
    options.method = Method::LevenbergMarquardt;
    let start = regression.problem.unknowns.start();
    let descent = descend(&regression.problem, start, observer)?;
    let theta = regression.theta(&descent.last.theta);
    Ok((theta, descent.evaluator.evaluations))
}
