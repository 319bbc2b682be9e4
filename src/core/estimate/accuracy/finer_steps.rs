//! Integration steps as short as an estimate is worth: shorter ones where halving them would move a parameter noticeably.

use crate::estimate::problem::Problem;
use crate::estimate::problem::substeps::{REACH, is_automatic, shortened};
use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::iteration::Outcome;

/// Shifts of less than this, in standard errors, are left; those of more are made about as small as the second.
const LARGEST_SHIFT: f64 = 0.05;
const WANTED_SHIFT: f64 = 0.01;
/// The order of the method with which steps are chosen.
const ORDER: f64 = 4.0;

/// How much shorter steps are made at a time.
const LEAST_FACTOR: f64 = 1.2;
const MOST_FACTOR: f64 = 8.0;
/// And how often.
pub(crate) const MOST_ROUNDS: usize = 8;

/// Most integration steps over all segments.
const MOST_STEPS: usize = 5_000_000;

/// The problem with shorter steps, where those of the estimate are too long.
pub(crate) fn with_finer(problem: &Problem, found: &Estimate) -> Option<Problem> {
    let options = &problem.options;
    if !is_automatic(options) || options.max_iterations == 0 || found.outcome == Outcome::Cancelled
    {
        return None;
    }
    let integration = found.integration.as_ref()?;
    let shift = integration
        .halved
        .as_ref()
        .map_or(0.0, |halved| halved.most);
    let factor = if shift > LARGEST_SHIFT {
        (shift / WANTED_SHIFT).powf(1.0 / ORDER)
    } else if !found.outcome.is_minimum() && integration.fastest > REACH {
        // no estimate yet, perhaps for want of a trajectory
        integration.fastest / REACH
    } else {
        return None;
    };
    let factor = factor.clamp(LEAST_FACTOR, MOST_FACTOR);
    let mut finer = problem.clone();
    for segment in &mut finer.segments {
        segment.substeps = shortened(segment, factor);
    }
    let steps: usize = (finer.segments.iter())
        .map(|segment| segment.most_substeps() * segment.len())
        .sum();
    let is_finer = (finer.segments.iter().zip(&problem.segments))
        .any(|(now, before)| now.most_substeps() > before.most_substeps());
    (is_finer && steps <= MOST_STEPS).then_some(finer)
}
