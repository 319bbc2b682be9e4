//! Where output error starts: values of the document, or values found before the first iteration. A start lies within
//! the bounds and gives a cost; how good it is only the iteration from it tells.

mod automatic;
mod equation_error;
pub(super) mod found;
pub(super) mod multi_start;
mod nelder_mead;
pub(super) mod shooting;

use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::options::start::StartMethod;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::progress::{Progress, Watcher, unobserved};
use crate::estimate::report::start::{StartKind, StartReport};
use equation_error::equation_error_start;
use found::Start;
use shooting::multiple_shooting;

/// Finds the start that the options ask for.
///
/// # Errors
/// The method asked for finds no θ that gives a cost.
pub(crate) fn find_start(problem: &Problem, watcher: &mut Watcher<'_>) -> Result<Start, Unusable> {
    let theta = problem.unknowns.start();
    let found = |theta, stopped| Start {
        theta,
        stopped,
        may_shoot: false,
    };
    match &problem.options.start {
        StartMethod::Document {} => Ok(found(theta, false)),
        StartMethod::Automatic {} => automatic::automatic(problem, watcher),
        StartMethod::EquationError {} => {
            let (theta, evaluations) = equation_error_start(problem, &mut unobserved)?;
            let cost = Evaluator::new(problem).cost(&theta).ok();
            let report = StartReport {
                method: StartKind::EquationError,
                evaluations,
                cost,
                text: "start values from equation error".to_string(),
            };
            let stopped = watcher(Progress::Start(&report)).is_break();
            Ok(found(theta, stopped))
        }
        StartMethod::NelderMead { max_evaluations } => {
            nelder_mead::nelder_mead(problem, theta, *max_evaluations, watcher)
        }
        StartMethod::MultiStart {
            starts,
            seed,
            spread,
        } => multi_start::multi_start(problem, *starts, *seed, *spread, watcher),
        StartMethod::MultipleShooting { interval } => {
            let mut told = |report: &StartReport| watcher(Progress::Start(report));
            let shot = multiple_shooting(problem, theta, *interval, &mut told)?;
            Ok(found(shot.theta, shot.stopped))
        }
    }
}
