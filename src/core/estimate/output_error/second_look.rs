//! A second look from other starts, where the fit is poor: far worse than the state equations fit by themselves.
//!
//! A simulation that ends at a false minimum reproduces its outputs badly although equation error, which simulates
//! nothing, explains the derivatives of the states with the same model. Where that is so, and the start was ours to choose,
//! the iteration is run from others too, and what came of it is said.

use super::second_try::{Run, from_start};
use crate::estimate::answer::Solution;
use crate::estimate::equation_error::equation_error;
use crate::estimate::options::error_bounds::ErrorBoundsKind;
use crate::estimate::options::start::StartMethod;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::iteration::Outcome;
use crate::estimate::report::progress::{Watcher, unobserved};
use crate::estimate::start::found::Start;
use crate::estimate::start::multi_start::multi_start;
use crate::flight::{Finding, FindingCode};
use crate::stop;

/// An output of which less is explained is looked at,
const GOOD: f64 = 0.9;
/// unless its residual is noise: another minimum would explain what hangs together from sample to sample.
const NOISE: f64 = 0.3;
/// Equation error must explain so much more of its equations.
const FAR: f64 = 0.3;

/// Other starts, as far from the given one as it is from zero.
const STARTS: usize = 12;
const SEED: u64 = 1;
const SPREAD: f64 = 1.0;

/// Samples times unknowns beyond which a dozen descents would take long.
const MOST_WORK: usize = 2_000_000;

/// An optimum is another one where -ln L is lower by this.
const OTHER: f64 = 0.1;

/// # Errors
/// The start gives no cost.
pub(super) fn with_second_look(
    problem: &Problem,
    watcher: &mut Watcher<'_>,
) -> Result<Solution, Unusable> {
    let first = from_start(problem, watcher)?;
    let work = problem.samples() * problem.unknowns.len();
    let ours = problem.options.start == (StartMethod::Automatic {})
        && problem.options.max_iterations > 0
        && first.estimate.outcome != Outcome::Cancelled
        && work <= MOST_WORK;
    let poor = stop::droppable(|| ours.then(|| poor(problem, &first.estimate)).flatten());
    let poor = match poor {
        Ok(Some(poor)) => poor,
        Ok(None) => return Ok(first),
        Err(_) => return Ok(first.stopped("looking at its fit")),
    };
    let number = first.estimate.iterations + 1;
    let from_others = || -> Result<Run, Unusable> {
        let found = multi_start(problem, STARTS, SEED, SPREAD, watcher)?;
        let start = Start {
            theta: found.theta,
            stopped: found.stopped,
            may_shoot: false,
        };
        Run::from(problem, &start, number, watcher)
    };
    let Ok(second) = stop::droppable(from_others) else {
        return Ok(first.stopped("trying other starts"));
    };
    let before = first.estimate.cost;
    let (mut kept, came) = match second {
        Ok(second) if second.solution.estimate.cost < before - OTHER => {
            let cost = second.solution.estimate.cost;
            let came = format!(
                "the best of {STARTS} other starts is kept: -ln L {cost:.1} instead of {before:.1}"
            );
            (second.solution.following(first), came)
        }
        _ => (
            first,
            format!("{STARTS} other starts led to nothing better than -ln L {before:.1}"),
        ),
    };
    let message = format!(
        "the simulation explained {:.0} % of '{}', where equation error explains at least {:.0} % of each of its equations: a false minimum, or a model that drifts away from what it should follow; {came}",
        100.0 * poor.explained.max(0.0),
        poor.output,
        100.0 * poor.by_equations
    );
    let remedy = "look at the fit; give other start values, or say \"start\": {\"kind\": \"multi_start\"} with more starts, or use the estimator \"filter_error\"";
    let finding = Finding::new(FindingCode::SecondLook, message, remedy);
    (kept.estimate.findings).push(finding.of_channel(poor.output).at("/options/start"));
    Ok(kept)
}

/// What is poor about a fit.
struct Poor {
    output: String,
    /// R² of the output.
    explained: f64,
    /// The least R² of equation error.
    by_equations: f64,
}

fn poor(problem: &Problem, found: &Estimate) -> Option<Poor> {
    let outputs = found.outputs.iter();
    let poor = outputs.filter(|fit| fit.r_squared <= GOOD && fit.autocorrelation > NOISE);
    let worst = poor.min_by(|a, b| a.r_squared.total_cmp(&b.r_squared))?;
    let mut quick = problem.clone();
    quick.options.error_bounds = ErrorBoundsKind::Conventional;
    let equations = equation_error(&quick, &mut unobserved).ok()?.estimate;
    let least = (equations.outputs.iter()).map(|output| output.r_squared);
    let by_equations = least.fold(f64::INFINITY, f64::min);
    (by_equations.is_finite() && by_equations - worst.r_squared.max(0.0) > FAR).then(|| Poor {
        output: worst.name.clone(),
        explained: worst.r_squared,
        by_equations,
    })
}
