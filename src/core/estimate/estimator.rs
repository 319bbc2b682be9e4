//! Which estimator answers, and what it tells on the way.

use crate::estimate::answer::Solution;
use crate::estimate::equation_error::equation_error;
use crate::estimate::filter_error::finer_steps::filter_error_in_steps;
use crate::estimate::findings::findings;
use crate::estimate::frequency::{equation_error_frequency, output_error_frequency};
use crate::estimate::intervals;
use crate::estimate::options::estimator::Estimator;
use crate::estimate::output_error::finer_steps::from_start;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::progress::{Progress, Watcher};
use crate::flight::FindingCode;

/// Estimates θ as the problem's options say; what a reader of the answer should know is in its findings.
///
/// # Errors
/// There is nothing to begin with: why.
pub fn estimate(problem: &Problem, watcher: &mut Watcher<'_>) -> Result<Solution, Unusable> {
    let mut solution = match problem.options.estimator {
        Estimator::OutputError => from_start(problem, watcher),
        Estimator::FilterError => filter_error_in_steps(problem, &mut |iteration| {
            watcher(Progress::Iteration(iteration))
        }),
        Estimator::EquationError => equation_error(problem, &mut |iteration| {
            watcher(Progress::Iteration(iteration))
        }),
        Estimator::OutputErrorFrequency => output_error_frequency(problem, &mut |iteration| {
            watcher(Progress::Iteration(iteration))
        }),
        Estimator::EquationErrorFrequency => equation_error_frequency(problem, &mut |iteration| {
            watcher(Progress::Iteration(iteration))
        }),
    }?;
    let found = findings(problem, &solution);
    let estimate = &mut solution.estimate;
    estimate.findings.extend(found);
    let not_converged = FindingCode::NotConverged.name();
    let short = (estimate.findings.iter()).any(|finding| finding.code == not_converged);
    for row in &mut estimate.parameters {
        row.provisional = short && !row.fixed;
    }
    if let Some(options) = &problem.options.confidence_intervals {
        intervals::add(problem, options, &mut solution, watcher);
    }
    Ok(solution)
}
