//! Prediction of a segment that took no part in the estimation.

use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::evaluation::Unusable;
use super::options::Noise;
use super::output_error::output_error;
use super::problem::Problem;
use super::report::{Estimate, Outcome, OutputFit, ParameterEstimate, TimeHistory};
use super::role::Role;
use super::unknowns::Unknowns;
use crate::model::{Model, Per};
use crate::simulate::Segment;

/// A segment to be predicted.
#[derive(Clone, PartialEq, Debug)]
pub struct Validation {
    pub segment: Segment,
    /// Of this segment alone.
    pub unknowns: Unknowns,
}

/// How well the estimated model predicts one segment that it was not fitted to.
///
/// What all maneuvers share is held at the estimate. What belongs to a maneuver (`per = "maneuver"`: its initial
/// state, its biases) is no property of the aircraft, and is estimated on the segment itself unless it is fixed,
/// with the noise covariance held at its estimate.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Prediction {
    #[schema(example = "doublet")]
    pub segment: String,
    /// Of the estimation of the segment's own parameters; `converged` where it has none.
    pub outcome: Outcome,
    pub reason: String,
    /// The segment's own parameters.
    pub parameters: Vec<ParameterEstimate>,
    /// Empty where the simulation left the range of numbers.
    pub outputs: Vec<OutputFit>,
    pub samples: usize,
}

/// Predicts a segment with the result of the estimation of `problem`.
pub fn predict(
    problem: &Problem,
    estimate: &Estimate,
    validation: &Validation,
) -> (Prediction, Option<TimeHistory>) {
    let held = held(problem, estimate, validation);
    let segment = validation.segment.label.clone();
    let samples = validation.segment.len();
    match output_error(&held, &mut |_| ControlFlow::Continue(())) {
        Ok(solution) => {
            let Estimate {
                outcome,
                reason,
                parameters,
                outputs,
                ..
            } = solution.estimate;
            let prediction = Prediction {
                segment,
                outcome,
                reason: if held.unknowns.is_empty() {
                    "simulated with the estimate; the segment has no parameters of its own to estimate".into()
                } else {
                    reason
                },
                parameters: parameters
                    .into_iter()
                    .filter(|p| p.segment.is_some())
                    .collect(),
                outputs,
                samples,
            };
            let history = solution.histories.into_iter().next();
            let history = history.map(|history| TimeHistory {
                role: Role::Validation,
                ..history
            });
            (prediction, history)
        }
        Err(why) => {
            let reason = match why {
                Unusable::LeftRange { sample, .. } => format!(
                    "with the estimate the simulation leaves the range of numbers at sample {}",
                    sample + 1
                ),
                Unusable::Delayed { .. } => {
                    "with the estimate an input or output is delayed too long".to_string()
                }
                // it is simulated without a filter, and not regressed
                Unusable::NotFinite
                | Unusable::SingularNoise
                | Unusable::NoSteadyGain { .. }
                | Unusable::NoMeasuredState => {
                    "with the estimate an output is not a finite number at some sample".to_string()
                }
            };
            let prediction = Prediction {
                segment,
                outcome: Outcome::Diverged,
                reason,
                parameters: Vec::new(),
                outputs: Vec::new(),
                samples,
            };
            (prediction, None)
        }
    }
}

/// The problem of the segment alone, with shared parameters and the noise held at the estimate.
fn held(problem: &Problem, estimate: &Estimate, validation: &Validation) -> Problem {
    let model = &problem.model;
    let unknowns =
        (validation.unknowns).with_shared_held(|parameter| shared(model, estimate, parameter));
    let mut options = problem.options.clone();
    let variance = |i: usize| estimate.noise_covariance[i][i];
    options.noise = Noise::Given {
        variance: (0..model.outputs.len()).map(variance).collect(),
    };
    options.max_iterations = options.max_iterations.max(1);
    let segments = vec![validation.segment.clone()];
    Problem::new(model.clone(), segments, unknowns, options)
}

/// The estimate of a parameter that all segments share, SI; `None` where each has its own.
fn shared(model: &Model, estimate: &Estimate, parameter: usize) -> Option<f64> {
    let info = &model.parameters[parameter];
    let row = (estimate.parameters.iter()).find(|row| row.name == info.name)?;
    (info.document.per != Per::Maneuver).then(|| info.unit.to_si(row.estimate))
}
