//! From a plan to a result: pure, synchronous, deterministic.

mod diagnosis;
mod study;

pub use diagnosis::run_diagnosis;
pub use study::{StudyProgress, run_study};

use std::ops::ControlFlow;

use super::no_start::no_start;
use super::plan::Plan;
use super::result::JobResult;
use crate::estimate::{self, Outcome, Solution, estimate, predict};
use crate::flight::Fault;

/// Runs a plan; `watcher` is told of its progress and may stop it.
///
/// # Errors
/// The start values lead nowhere: there is no iterate to speak of.
pub fn run(
    plan: &Plan,
    watcher: &mut dyn FnMut(estimate::Progress<'_>) -> ControlFlow<()>,
) -> Result<JobResult, Vec<Fault>> {
    let problem = &plan.problem;
    let Solution {
        theta,
        covariance,
        estimate: mut result,
        mut histories,
    } = estimate(problem, watcher).map_err(|why| vec![no_start(problem, why)])?;
    if result.outcome != Outcome::Cancelled {
        for validation in &plan.validation {
            let (prediction, history) = predict(problem, &theta, &covariance, validation);
            result.prediction.push(prediction);
            histories.extend(history);
        }
    }
    Ok(JobResult {
        estimate: result,
        histories,
        model: plan.model.clone(),
        study: None,
        diagnosis: None,
    })
}
