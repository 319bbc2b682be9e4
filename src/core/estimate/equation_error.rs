//! Equation error: least squares of the state equations themselves, on measured and differentiated states.
//!
//! ```text
//! dx/dt_measured − f(x_measured, u, θ)  and  z − g(x_measured, u, θ),  each with a variance of its own
//! ```
//!
//! Nothing is integrated, so that an unstable aircraft or a θ far away does no harm, and where the equations are
//! linear in θ one step is all it takes. The price: noise in the measured states biases the estimate (Klein and
//! Morelli, Aircraft System Identification, ch. 5), and what only enters outputs that measure a state, such as its
//! bias, is not found. So it is a start for output error, or a quick look.

use crate::estimate::answer::{Asked, Solution, answer_to};
use crate::estimate::descent::gauss_newton::descend;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::regression::Regression;
use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::iteration::Outcome;
use crate::estimate::report::progress::Observer;

/// Whether an equation-error estimation of the problem can be made.
pub(crate) fn has_equation_error(problem: &Problem) -> bool {
    Regression::new(problem).is_some()
}

/// Estimates θ by equation error. Outputs of the answer are the derivatives of the measured states, and those
/// recorded outputs that measure no state.
///
/// # Errors
/// No output measures a state, or the regression has no finite residuals at the start values.
pub fn equation_error(
    problem: &Problem,
    observer: &mut Observer<'_>,
) -> Result<Solution, Unusable> {
    let regression = Regression::new(problem).ok_or(Unusable::NoMeasuredState)?;
    let own = &regression.problem;
    let descent = descend(own, own.unknowns.start(), observer)?;
    let asked = Asked {
        problem,
        theta: regression.theta(&descent.last.theta),
        solved: &|place| regression.place(place),
    };
    let mut solution = answer_to(asked, own, descent);
    let left: Vec<String> = (0..problem.unknowns.len())
        .filter(|&place| regression.place(place).is_none())
        .map(|place| problem.name(place))
        .collect();
    solution.estimate.reason = reason(&solution.estimate, &left, &regression.integrated);
    Ok(solution)
}

/// The regression's reason, with a reader of the original problem in mind.
fn reason(found: &Estimate, left: &[String], integrated: &[String]) -> String {
    let mut reason = format!("equation error: {}", found.reason);
    if found.outcome == Outcome::Converged {
        reason += "; noise in the measured states biases it, so prefer output_error for the final estimate";
    }
    if !integrated.is_empty() {
        reason += &format!("; no output measures {}: integrated", integrated.join(", "));
    }
    if !left.is_empty() {
        reason += &format!(
            "; in no equation of the regression, left at the start or read off the first sample: {}",
            left.join(", ")
        );
    }
    reason
}
