//! Confidence intervals beyond the Cramér-Rao bound, side by side with it.
//!
//! ```text
//! bootstrap    z* = y(θ̂) + ê*,  ê* blocks of the residuals in a new order;  θ* by output error from θ̂
//! Monte Carlo  z* = y(θ̂) + v*,  v* noise with covariance and colour of the residuals;  θ* likewise
//! profile      2 (ln L(θ̂) − max ln L(θ | θ_i = v)) = χ²(0.95, 1) = 3.84,  solved for v below and above θ̂_i
//! ```
//!
//! Sources: Künsch, Ann. Statist. 17(3), 1989, and Politis, White, Econometric Reviews 23(1), 2004 (blocks); Efron,
//! Tibshirani, An Introduction to the Bootstrap, 1993, ch. 13 (percentiles); Venzon, Moolgavkar, Appl. Statist. 37(1), 1988
//! (profile likelihood); Kent, Biometrika 69(1), 1982 (likelihood ratio where the noise is not as it says).
//!
//! Invariant: the same problem, options and seed give the same intervals, whatever the number of threads.

mod blocks;
mod fitted;
mod noise;
mod profile;
mod refit;
mod repeated;
mod side_by_side;
mod teller;

use crate::estimate::answer::Solution;
use crate::estimate::options::intervals::IntervalOptions;
use crate::estimate::problem::Problem;
use crate::estimate::report::intervals::ConfidenceIntervals;
use crate::estimate::report::iteration::Outcome;
use crate::estimate::report::progress::Watcher;
use crate::stop;

/// Adds the intervals that options ask for to an answer. Whoever stops it keeps the estimate.
pub(crate) fn add(
    problem: &Problem,
    options: &IntervalOptions,
    solution: &mut Solution,
    watcher: &mut Watcher<'_>,
) {
    if solution.estimate.outcome == Outcome::Cancelled {
        return;
    }
    let found = match none_because(solution) {
        Some(why) => Some(ConfidenceIntervals {
            parameters: Vec::new(),
            bootstrap: None,
            monte_carlo: None,
            remarks: vec![why.to_string()],
        }),
        None => {
            let work = || side_by_side::side_by_side(problem, options, solution, watcher);
            stop::droppable(work).unwrap_or_default()
        }
    };
    let estimate = &mut solution.estimate;
    if found.is_none() {
        estimate.outcome = Outcome::Cancelled;
        estimate.reason = format!(
            "stopped on request while confidence intervals were worked out; of the estimation: {}",
            estimate.reason
        );
    }
    estimate.confidence_intervals = found;
}

/// Why refits would tell nothing.
fn none_because(solution: &Solution) -> Option<&'static str> {
    let estimate = &solution.estimate;
    match estimate.outcome {
        Outcome::Converged | Outcome::AtBound => {}
        Outcome::Singular => {
            return Some(
                "no intervals: the data cannot tell all parameters apart; fix one of each set first",
            );
        }
        _ => return Some("no intervals: the estimate is no minimum, so that refits would wander"),
    }
    if estimate.error_bounds.is_none() {
        return Some(
            "no intervals: the model reproduces an output to rounding, and there is no noise",
        );
    }
    None
}
