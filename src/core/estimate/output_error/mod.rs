//! The output-error method: the likelihood of the simulation's residuals, concentrated in R, at its greatest.

pub(super) mod finer_steps;
mod second_look;
mod second_try;

use crate::estimate::answer::{Solution, answer};
use crate::estimate::descent::{gauss_newton, quasi_newton};
use crate::estimate::options::technique::Derivatives;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::progress::Observer;

/// Estimates θ from the start values of the problem, as they stand.
///
/// # Errors
/// The start values give no cost, so that there is nothing to begin with.
pub fn output_error(problem: &Problem, observer: &mut Observer<'_>) -> Result<Solution, Unusable> {
    from(problem, problem.unknowns.start(), observer)
}

/// Estimates θ from a θ: with all of ∂y/∂θ, or with the adjoint's gradient alone.
///
/// # Errors
/// This θ gives no cost.
fn from(
    problem: &Problem,
    theta: Vec<f64>,
    observer: &mut Observer<'_>,
) -> Result<Solution, Unusable> {
    let Derivatives::Adjoint { scaling } = problem.options.derivatives else {
        let descent = gauss_newton::descend(problem, theta, observer)?;
        return Ok(answer(problem, descent));
    };
    let descent = quasi_newton::solve::descend(problem, theta, scaling, observer)?;
    let mut solution = answer(problem, descent);
    solution
        .estimate
        .reason
        .push_str(" (gradients by the adjoint; error bounds by forward sensitivities at the end)");
    Ok(solution)
}
