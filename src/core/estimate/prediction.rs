//! Prediction of a segment that took no part in the estimation.

use std::ops::ControlFlow;

use nalgebra::DMatrix;

use crate::estimate::options::Noise;
use crate::estimate::options::role::Role;
use crate::estimate::output_error::output_error;
use crate::estimate::problem::Problem;
use crate::estimate::problem::substeps::no_longer;
use crate::estimate::problem::unknowns::Unknowns;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::history::TimeHistory;
use crate::estimate::report::integration::Integration;
use crate::estimate::report::iteration::Outcome;
use crate::estimate::report::prediction::Prediction;
use crate::model::Per;
use crate::simulate::Segment;

/// A segment to be predicted.
#[derive(Clone, PartialEq, Debug)]
pub struct Validation {
    /// Its inputs and measured outputs.
    pub segment: Segment,
    /// Of this segment alone.
    pub unknowns: Unknowns,
}

impl Validation {
    /// With integration steps no longer than those that the estimate took more than one of from sample to sample: what is
    /// fitted and what is predicted are stepped alike.
    #[must_use]
    pub fn stepped_as(mut self, problem: &Problem, integration: &Integration) -> Self {
        let counts = integration.steps_per_sample.iter();
        let steps = (problem.segments.iter().zip(counts))
            .filter(|(_, count)| **count > 1)
            .map(|(segment, count)| segment.steps.longest() / *count as f64);
        if let Some(longest) = steps.reduce(f64::min) {
            self.segment.substeps = no_longer(&self.segment, longest);
        }
        self
    }
}

/// Predicts a segment with the estimate of `problem`: θ and R, SI.
pub fn predict(
    problem: &Problem,
    theta: &[f64],
    covariance: &DMatrix<f64>,
    validation: &Validation,
) -> (Prediction, Option<TimeHistory>) {
    let held = held(problem, theta, covariance, validation);
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
                Unusable::Path { .. } => {
                    "with the estimate an input or output is delayed too long, or its rate limited to less than nothing"
                        .to_string()
                }
                // it is simulated without a filter, and not regressed
                Unusable::NotFinite
                | Unusable::SingularNoise
                | Unusable::NoSteadyGain { .. }
                | Unusable::NoMeasuredState
                | Unusable::NoBand => {
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
fn held(
    problem: &Problem,
    theta: &[f64],
    covariance: &DMatrix<f64>,
    validation: &Validation,
) -> Problem {
    let model = &problem.model;
    let is_shared = |parameter: usize| model.parameters[parameter].document.per != Per::Maneuver;
    let mut parameters = Vec::new();
    problem.unknowns.parameters(0, theta, &mut parameters);
    let unknowns = (validation.unknowns)
        .with_shared_held(|parameter| is_shared(parameter).then(|| parameters[parameter]));
    let mut options = problem.options.clone();
    options.noise = Noise::Given {
        variance: covariance.diagonal().iter().copied().collect(),
    };
    options.max_iterations = options.max_iterations.max(1);
    let segments = vec![validation.segment.clone()];
    Problem::new(model.clone(), segments, unknowns, options)
}
