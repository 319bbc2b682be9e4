//! What a reader of an estimate should know beside its numbers: one list, to which each check adds what it has found.
//!
//! A check is a file here with a function of the problem and where its estimation ended. What can be found only while an
//! estimation runs is put into [`Estimate::findings`](super::Estimate::findings) by who finds it; the list of here goes
//! behind it. Trial fits of a diagnosis are not checked: only [`estimate`](super::estimate()) is.

mod convergence;
mod frequency;
mod identifiability;
mod input_interpolation;
mod steps;
mod unstable;

use crate::estimate::answer::Solution;
use crate::estimate::problem::Problem;
use crate::flight::Finding;

/// What is to be said of where an estimation ended.
pub(super) fn findings(problem: &Problem, solution: &Solution) -> Vec<Finding> {
    // with no iteration nothing is estimated: what the data can show is all that was asked for
    let estimated = problem.options.max_iterations > 0;
    let checks = [
        convergence::findings(&solution.estimate, estimated),
        frequency::findings(problem, &solution.estimate),
        identifiability::findings(&solution.estimate),
        input_interpolation::findings(problem, solution),
        steps::findings(problem, &solution.estimate),
        unstable::finding(problem, &solution.estimate)
            .into_iter()
            .collect(),
    ];
    checks.into_iter().flatten().collect()
}
