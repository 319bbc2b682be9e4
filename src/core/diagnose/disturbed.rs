//! Turbulence: the model fitted by filter error, with process noise on its states.

use std::ops::ControlFlow;

use super::case::{Case, Unfit};
use super::fitted::Fitted;
use super::screen::critical;
use crate::estimate::{Estimator, Outcome, ProcessNoise, filter_error};

/// The model with process noise on one state alone.
///
/// # Errors
/// The fit came to nothing.
pub(super) fn disturbed(case: &Case, base: &Fitted, state: &str) -> Result<Fitted, Unfit> {
    filtered(case, base, &|other| other != state)
}

/// What disturbs one state disturbs others: the same model with process noise on all of them, where the likelihood says
/// so. `calm` is the fit without any.
pub(super) fn disturbed_throughout(case: &Case, calm: &Fitted, one: Fitted) -> Fitted {
    const ERROR: f64 = 0.01;
    let Ok(all) = filtered(case, calm, &|_| false) else {
        return one;
    };
    // both are filters, whose innovations should be white: their costs are their likelihoods
    let gain = 2.0 * (one.estimate.cost - all.estimate.cost);
    let others = one.problem.model.states.len() - 1;
    if gain > critical(ERROR, 1.0, others) {
        all
    } else {
        one
    }
}

/// The declared model fitted by filter error, without process noise on the states that are `held`.
fn filtered(case: &Case, base: &Fitted, held: &dyn Fn(&str) -> bool) -> Result<Fitted, Unfit> {
    let mut problem = case.problem(&base.document, &base.values())?;
    if !problem.model.paths.of_outputs().is_empty() {
        let why = "the filter-error method knows no lag or delay of an output";
        return Err(Unfit(why.into()));
    }
    problem.options.estimator = Estimator::FilterError;
    problem.options.tolerance = problem.options.tolerance.max(1e-3);
    problem.options.process_noise = (problem.model.states.iter())
        .filter(|state| held(&state.name))
        .map(|state| {
            (
                state.name.clone(),
                ProcessNoise {
                    start: Some(0.0),
                    fixed: true,
                },
            )
        })
        .collect();
    let solution = filter_error(&problem, &mut |_| ControlFlow::Continue(()))
        .map_err(|why| Unfit(why.to_string()))?;
    if solution.estimate.outcome == Outcome::Diverged {
        return Err(Unfit(solution.estimate.reason));
    }
    Ok(Fitted::of(base.document.clone(), problem, &solution))
}
