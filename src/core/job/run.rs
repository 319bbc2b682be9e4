//! From a plan to a result: pure, synchronous, deterministic.

use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::prepare::Plan;
use super::{Fault, checks, filter};
use crate::diagnose::Diagnosis;
use crate::estimate::study::DerivativeStudy;
use crate::estimate::{
    Estimate, Outcome, Problem, Progress, Solution, TimeHistory, Unusable, estimate, predict,
};
use crate::model::ModelDocument;
use crate::simulate::MOST_DELAY;

/// Everything a finished job answers.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct JobResult {
    pub estimate: Estimate,
    pub model: ModelDocument,
    pub histories: Vec<TimeHistory>,
    /// Of a derivative study.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub study: Option<DerivativeStudy>,
    /// Of a diagnosis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diagnosis: Option<Diagnosis>,
}

/// Runs a plan; `watcher` is told of its progress and may stop it.
///
/// # Errors
/// The start values lead nowhere: there is no iterate to speak of.
pub fn run(
    plan: &Plan,
    watcher: &mut dyn FnMut(Progress<'_>) -> ControlFlow<()>,
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

/// Why the start values lead nowhere.
pub(super) fn no_start(problem: &Problem, why: Unusable) -> Fault {
    match why {
        Unusable::LeftRange { segment, sample } => {
            let segment = &problem.segments[segment];
            let time = segment.time[sample.min(segment.len() - 1)];
            let message = format!(
                "with the start values the simulation leaves the range of numbers in segment {} at {time:.3} s (sample {}); give other \"start\" values, or a shorter stretch of \"rows\"",
                segment.label,
                sample + 1
            );
            Fault::new("/parameters", "diverged_at_start", message)
        }
        Unusable::NotFinite => {
            let message = "with the start values an output or its derivative by a parameter is not a finite number at some sample (a root, logarithm, power or quotient at zero?); give other \"start\" values, or guard the expression with if(...)";
            Fault::new("/parameters", "diverged_at_start", message)
        }
        Unusable::NoSteadyGain { segment } => filter::no_gain(problem, segment),
        Unusable::Delayed { segment, delay } => {
            let (model, delays) = (&problem.model, &problem.model.delays);
            let (what, name) = match delays.inputs.get(delay) {
                Some(&input) => ("input", &model.inputs[input].name),
                None => {
                    let output = delays.outputs[delay - delays.inputs.len()];
                    ("output", &model.outputs[output].name)
                }
            };
            let message = format!(
                "with the start values the delay of the {what} '{name}' is more than {MOST_DELAY} samples of segment {}; give other \"start\" values, or \"lower\" and \"upper\" bounds",
                problem.segments[segment].label
            );
            Fault::new("/parameters", "delay_too_long", message)
        }
        Unusable::SingularNoise => {
            let message = "the residuals of some outputs are not independent, so that their full covariance is singular; use the structure \"diagonal\", or leave one of these outputs out";
            Fault::new("/options/noise", "singular_noise", message)
        }
        Unusable::NoMeasuredState => checks::no_measured_state(problem),
    }
}
