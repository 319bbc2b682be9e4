//! Filter error with integration steps as short as the estimate is worth: the iteration goes on from the estimate with
//! shorter ones where they are too long.

use super::filter_error;
use crate::estimate::accuracy::finer_steps::{MOST_ROUNDS, with_finer};
use crate::estimate::answer::Solution;
use crate::estimate::options::process_noise::ProcessNoise;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::iteration::Iteration;
use crate::estimate::report::progress::Observer;

/// As [`filter_error`], with steps that the options leave to us.
///
/// # Errors
/// The start values give no cost.
pub(in crate::estimate) fn filter_error_in_steps(
    problem: &Problem,
    observer: &mut Observer<'_>,
) -> Result<Solution, Unusable> {
    let mut found = filter_error(problem, observer)?;
    let mut finer = None;
    for _ in 0..MOST_ROUNDS {
        let Some(mut next) = with_finer(finer.as_ref().unwrap_or(problem), &found.estimate) else {
            break;
        };
        begin_at(&mut next, &found);
        let number = found.estimate.iterations + 1;
        let solution = filter_error(&next, &mut |iteration| {
            let mut iteration: Iteration = iteration.clone();
            iteration.number += number;
            observer(&iteration)
        });
        let Ok(mut solution) = solution else {
            break;
        };
        if !solution.may_follow(&found) {
            break;
        }
        solution.estimate.iterations += number;
        with_starts_of(&mut solution, &found);
        found = solution.following(found);
        finer = Some(next);
    }
    Ok(found)
}

/// Puts start values where a solution is.
fn begin_at(problem: &mut Problem, found: &Solution) {
    problem.unknowns.begin_at(&found.theta);
    let noises = found.estimate.filter.iter();
    for noise in noises.flat_map(|filter| &filter.process_noise) {
        if !noise.fixed && noise.estimate > 0.0 {
            let start = ProcessNoise {
                start: Some(noise.estimate),
                fixed: false,
            };
            (problem.options.process_noise).insert(noise.state.clone(), start);
        }
    }
}

/// Where the whole way began.
fn with_starts_of(solution: &mut Solution, first: &Solution) {
    let rows = solution.estimate.parameters.iter_mut();
    for (row, first) in rows.zip(&first.estimate.parameters) {
        row.start = first.start;
    }
    let filters = solution.estimate.filter.iter_mut();
    for (filter, first) in filters.zip(&first.estimate.filter) {
        let noises = filter.process_noise.iter_mut();
        for (noise, first) in noises.zip(&first.process_noise) {
            noise.start = first.start;
        }
    }
}
