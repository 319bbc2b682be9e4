//! From a plan to a result: pure, synchronous, deterministic.

mod diagnosis;
mod finish;
mod structure;
mod study;

pub use diagnosis::run_diagnosis;
pub use structure::{StructureProgress, run_structure};
pub use study::{StudyProgress, run_study};

use std::ops::ControlFlow;

use nalgebra::DMatrix;

use finish::finish;

use super::no_start::no_start;
use super::plan::Plan;
use super::result::JobResult;
use crate::estimate::{
    self, Estimate, Outcome, Problem, Solution, TimeHistory, Validation, estimate, predict,
};
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

/// Adds what is predicted with an estimate, unless it was stopped.
fn predicted(
    problem: &Problem,
    theta: &[f64],
    covariance: &DMatrix<f64>,
    validation: &[Validation],
    result: &mut Estimate,
    histories: &mut Vec<TimeHistory>,
) {
    if result.outcome == Outcome::Cancelled {
        return;
    }
    for validation in validation {
        let mut validation = validation.clone();
        if let Some(integration) = &result.integration {
            validation = validation.stepped_as(problem, integration);
        }
        let (prediction, history) = predict(problem, theta, covariance, &validation);
        result.prediction.push(prediction);
        histories.extend(history);
    }
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
        distance: _,
    } = estimate(problem, watcher).map_err(|why| no_start(problem, why))?;
    predicted(
        problem,
        &theta,
        &covariance,
        &plan.validation,
        &mut result,
        &mut histories,
    );
    Ok(JobResult {
        estimate: result,
        histories,
        model: plan.model.clone(),
        study: None,
        diagnosis: None,
        structure: None,
    })
}
