//! From a plan to a result: pure, synchronous, deterministic.

mod diagnosis;
mod finish;
mod study;

pub use diagnosis::run_diagnosis;
pub use study::{StudyProgress, run_study};

use std::ops::ControlFlow;

use finish::finish;

use super::no_start::no_start;
use super::plan::Plan;
use super::result::JobResult;
use crate::estimate::{self, Outcome, Solution, estimate, predict};
use crate::flight::Faults;

/// Runs a plan; `watcher` is told of its progress and may stop it.
///
/// # Errors
/// The start values lead nowhere: there is no iterate to speak of. A finding that a strict job refuses.
pub fn run(
    plan: &Plan,
    watcher: &mut dyn FnMut(estimate::Progress<'_>) -> ControlFlow<()>,
) -> Result<JobResult, Faults> {
    finish(plan, fit(plan, watcher)?)
}

/// The estimation, and what is predicted with it.
fn fit(
    plan: &Plan,
    watcher: &mut dyn FnMut(estimate::Progress<'_>) -> ControlFlow<()>,
) -> Result<JobResult, Faults> {
    let problem = &plan.problem;
    let Solution {
        theta,
        covariance,
        estimate: mut result,
        mut histories,
    } = estimate(problem, watcher).map_err(|why| no_start(problem, why))?;
    if result.outcome != Outcome::Cancelled {
        for validation in &plan.validation {
            let mut validation = validation.clone();
            if let Some(integration) = &result.integration {
                validation = validation.stepped_as(problem, integration);
            }
            let (prediction, history) = predict(problem, &theta, &covariance, &validation);
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
