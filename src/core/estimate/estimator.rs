//! Which estimator answers, and what it tells on the way.

use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::answer::Solution;
use super::equation_error::equation_error;
use super::evaluation::Unusable;
use super::filter_error::filter_error;
use super::problem::Problem;
use super::report::Iteration;
use super::second_try;
use super::start::StartReport;

/// The statistical model behind the estimate.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Estimator {
    /// Maximum likelihood with measurement noise: the model is simulated and compared with what was measured.
    #[default]
    OutputError,
    /// The states are disturbed too, as by turbulence: a Kalman filter of steady gain predicts the outputs, and the
    /// intensity of the process noise is estimated along with the parameters.
    FilterError,
    /// Least squares of the state equations on measured, smoothed and differentiated states: quick, needs no start
    /// values, but biased by noise in the states.
    EquationError,
}

/// What an estimation tells on its way.
#[derive(Clone, Copy, Debug)]
pub enum Progress<'a> {
    /// The search for start values.
    Start(&'a StartReport),
    /// An iteration of the estimator.
    Iteration(&'a Iteration),
}

/// Told of all progress; may stop the estimation.
pub type Watcher<'o> = dyn FnMut(Progress<'_>) -> ControlFlow<()> + 'o;

/// Estimates θ as the problem's options say.
///
/// # Errors
/// There is nothing to begin with: why.
pub fn estimate(problem: &Problem, watcher: &mut Watcher<'_>) -> Result<Solution, Unusable> {
    match problem.options.estimator {
        Estimator::OutputError => second_try::from_start(problem, watcher),
        Estimator::FilterError => filter_error(problem, &mut |iteration| {
            watcher(Progress::Iteration(iteration))
        }),
        Estimator::EquationError => equation_error(problem, &mut |iteration| {
            watcher(Progress::Iteration(iteration))
        }),
    }
}
