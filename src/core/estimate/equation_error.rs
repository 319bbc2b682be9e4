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

use crate::estimate::answer::{Solution, answer};
use crate::estimate::descent::gauss_newton::descend;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unknowns::Unknown;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::regression::Regression;
use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::iteration::Outcome;
use crate::estimate::report::progress::Observer;

/// Whether an equation-error estimation of the problem can be made.
pub fn has_equation_error(problem: &Problem) -> bool {
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
    let theta = regression.theta(&descent.last.theta);
    let Solution {
        estimate,
        histories,
    } = answer(own, descent);
    Ok(Solution {
        estimate: in_the_problem(problem, &regression, &theta, estimate),
        histories,
    })
}

/// The regression's answer in the parameters of the problem that it was made of.
fn in_the_problem(
    problem: &Problem,
    regression: &Regression,
    theta: &[f64],
    found: Estimate,
) -> Estimate {
    let unknowns = &problem.unknowns;
    let own = &regression.problem.unknowns;
    let by_number = |(index, unknown): (usize, &Unknown)| {
        let mut row = found.parameters[index].clone();
        let place = unknowns.free.iter().position(|&free| free == index);
        if let Some(place) = place {
            let unit = problem.unit(place);
            row.estimate = unit.from_si(theta[place]);
            row.fixed = unknown.fixed;
        }
        row
    };
    // both lay out the same parameters over the same segments
    let parameters = unknowns.all.iter().enumerate().map(by_number).collect();
    let correlation = |a: usize, b: usize| match (regression.place(a), regression.place(b)) {
        (Some(a), Some(b)) => found.correlation[a][b],
        _ => f64::from(u8::from(a == b)),
    };
    let places = 0..unknowns.len();
    let correlation = if found.correlation.is_empty() && !own.is_empty() {
        Vec::new()
    } else {
        places
            .clone()
            .map(|a| places.clone().map(|b| correlation(a, b)).collect())
            .collect()
    };
    let left: Vec<String> = places
        .filter(|&place| regression.place(place).is_none())
        .map(|place| problem.name(place))
        .collect();
    Estimate {
        reason: reason(&found, &left, &regression.integrated),
        parameters,
        correlation,
        ..found
    }
}

/// What the regression's reason leaves unsaid.
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
