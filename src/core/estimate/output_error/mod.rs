//! The output-error method: Gauss-Newton or Levenberg-Marquardt on the likelihood concentrated in R.
//! (With the adjoint's gradient alone: `quasi_newton`.)

pub(super) mod second_try;

use crate::estimate::answer::Solution;
use crate::estimate::descent::gauss_newton::descend;
use crate::estimate::descent::quasi_newton::solve::solve;
use crate::estimate::options::technique::Derivatives;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::progress::Observer;

/// Estimates θ from the start values of the problem, as they stand.
///
/// # Errors
/// The start values give no cost, so that there is nothing to begin with.
pub fn output_error(problem: &Problem, observer: &mut Observer<'_>) -> Result<Solution, Unusable> {
    let theta = problem.unknowns.start();
    match problem.options.derivatives {
        Derivatives::Adjoint { scaling } => solve(problem, theta, scaling, observer),
        _ => Ok(descend(problem, theta, observer)?.solution(problem)),
    }
}
