//! Turbulence: the model fitted by filter error, with process noise on its states.

use std::ops::ControlFlow;

use super::case::{Case, Unfit};
use super::fitted::Fitted;
use super::screen::critical;
use crate::estimate::{Estimator, Outcome, Problem, ProcessNoise, filter_error};
use crate::flight::{Family, PhysicalQuantity};
use crate::model::{ModelDocument, Quantities};

/// Shares of the intensity that a filter with white errors of measuring finds.
const SHARES: [f64; 6] = [0.5, 0.25, 0.12, 0.06, 0.03, 0.015];

/// A force elsewhere must be likelier than turbulence by this much of 2 ln L.
const CLEARLY: f64 = 10.0;

/// The model with process noise on one state alone.
///
/// # Errors
/// The fit came to nothing.
pub(super) fn disturbed(case: &Case, base: &Fitted, state: &str) -> Result<Fitted, Unfit> {
    let free = filtered(case, base, &|other| other != state)?;
    if free.is_coloured() {
        Ok(told_from_colour(free, state))
    } else {
        Ok(free)
    }
}

/// A filter knows white errors of measuring alone, and takes coloured ones for disturbances. The intensity is the one at
/// which innovations are likeliest with the noise that suits them: looked for downwards, until they become less likely.
fn told_from_colour(free: Fitted, state: &str) -> Fitted {
    let Some(most) = intensity(&free, state) else {
        return free;
    };
    let mut best = (free.ln_evidence(), free);
    let mut worse = 0;
    for share in SHARES {
        let held = ProcessNoise {
            start: Some(share * most),
            fixed: true,
        };
        let mut problem = best.1.problem.clone();
        for (place, &value) in best.1.theta.iter().enumerate() {
            let index = problem.unknowns.free[place];
            problem.unknowns.all[index].start = value;
        }
        problem.options.process_noise.insert(state.into(), held);
        let Ok(fitted) = fit(best.1.document.clone(), problem) else {
            break;
        };
        let evidence = fitted.ln_evidence();
        if evidence > best.0 {
            best = (evidence, fitted);
            worse = 0;
        } else {
            worse += 1;
        }
        if worse > 1 {
            break;
        }
    }
    best.1
}

/// Of a state's process noise, in its own units.
fn intensity(fitted: &Fitted, state: &str) -> Option<f64> {
    let noise = &fitted.estimate.filter.as_ref()?.process_noise;
    let of_state = noise.iter().find(|noise| noise.state == state)?;
    (of_state.estimate > 0.0).then_some(of_state.estimate)
}

/// A rate whose equation a disturbance fits clearly better than that of the flow, `one`: what moves it is no turbulence.
pub(super) fn disturbed_elsewhere(
    case: &Case,
    calm: &Fitted,
    one: &Fitted,
) -> Option<(String, Fitted)> {
    let quantities = Quantities::of(&calm.document);
    let is_rate = |name: &&String| {
        let quantity = quantities.get(name);
        quantity.is_some_and(|quantity: PhysicalQuantity| quantity.family() == Family::Gyro)
    };
    let rates = calm.document.states.keys().filter(is_rate);
    let fits = rates.filter_map(|rate| Some((rate.clone(), disturbed(case, calm, rate).ok()?)));
    let (rate, best) = fits.max_by(|(_, a), (_, b)| a.ln_evidence().total_cmp(&b.ln_evidence()))?;
    let gain = 2.0 * (best.ln_evidence() - one.ln_evidence());
    (gain > CLEARLY).then_some((rate, best))
}

/// Another document, fitted by the estimator of a fit and with its process noise.
///
/// # Errors
/// The fit came to nothing.
pub(super) fn again(case: &Case, like: &Fitted, document: ModelDocument) -> Result<Fitted, Unfit> {
    let mut problem = case.problem(&document, &like.values())?;
    problem.options = like.problem.options.clone();
    fit(document, problem)
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
    fit(base.document.clone(), problem)
}

/// By filter error, as the options have its process noise.
///
/// # Errors
/// The fit came to nothing.
pub(super) fn fit(document: ModelDocument, problem: Problem) -> Result<Fitted, Unfit> {
    if !problem.model.paths.of_outputs().is_empty() {
        let why = "the filter-error method knows no lag or delay of an output";
        return Err(Unfit(why.into()));
    }
    let solution = filter_error(&problem, &mut |_| ControlFlow::Continue(()))
        .map_err(|why| Unfit(why.to_string()))?;
    if solution.estimate.outcome == Outcome::Diverged {
        return Err(Unfit(solution.estimate.reason));
    }
    Ok(Fitted::of(document, problem, &solution))
}
