//! A job's model with its estimates for other programs: source code, aerodynamics of JSBSim, a functional mock-up unit.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::plan::Plan;
use super::trajectories::{NoTrajectory, check_parameters};
use crate::estimate::{Estimate, Estimated};
use crate::model::{FmuSetting, NoAerodynamics, SourceLanguage};

/// What a simulator reads.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum SimulatorFormat {
    /// A functional mock-up unit of FMI 2.0, for co-simulation and model exchange, with C sources.
    #[default]
    Fmu,
    /// The aerodynamics of a JSBSim aircraft.
    Jsbsim,
}

/// Why there is no source code.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum NoSourceCode {
    /// The job is not what it was.
    #[error("{0}")]
    Estimate(#[from] NoTrajectory),
    /// No segment of this label.
    #[error("segment: there is no '{name}'; there is {known}")]
    Segment {
        /// As it was asked for.
        name: String,
        /// Those there are.
        known: String,
    },
    /// The model has no aerodynamics for JSBSim.
    #[error("{0}")]
    Aerodynamics(#[from] NoAerodynamics),
}

/// The functions of the model as it was estimated, with what belongs to a maneuver as it is in the segment of this label, or
/// in the first.
///
/// # Errors
/// The estimate is none of this plan; there is no such segment.
pub fn source_code(
    plan: &Plan,
    estimate: &Estimate,
    segment: Option<&str>,
    language: SourceLanguage,
) -> Result<String, NoSourceCode> {
    let of = OfSegment::of(plan, estimate, segment)?;
    Ok((plan.problem.model).source_code(language, &of.parameters, &of.what))
}

/// The model as it was estimated for a simulator; the segment as in [`source_code`].
///
/// # Errors
/// As [`source_code`]; the model is none that JSBSim can have.
pub fn simulator_model(
    plan: &Plan,
    estimate: &Estimate,
    segment: Option<&str>,
    format: SimulatorFormat,
) -> Result<Vec<u8>, NoSourceCode> {
    let of = OfSegment::of(plan, estimate, segment)?;
    let model = &plan.problem.model;
    if format == SimulatorFormat::Jsbsim {
        return Ok(model.jsbsim(&of.parameters, &of.what)?.into_bytes());
    }
    let data = &plan.problem.segments[of.segment];
    let first = |samples: &Vec<f64>| samples.first().copied().unwrap_or_default();
    let inputs: Vec<f64> = data.inputs.iter().map(first).collect();
    let steps = 1..data.time.len();
    let step = steps.map(|k| data.time[k] - data.time[k - 1]);
    let ends = data.time.first().zip(data.time.last());
    Ok(model.fmu(&FmuSetting {
        parameters: &of.parameters,
        inputs: &inputs,
        step: step.fold(f64::INFINITY, f64::min),
        duration: ends.map_or(0.0, |(first, last)| last - first),
        of: &of.what,
    }))
}

/// The parameters of one segment.
struct OfSegment {
    segment: usize,
    /// SI, in the model's order.
    parameters: Vec<f64>,
    /// In a line.
    what: String,
}

impl OfSegment {
    fn of(plan: &Plan, estimate: &Estimate, label: Option<&str>) -> Result<Self, NoSourceCode> {
        check_parameters(plan, estimate)?;
        let problem = &plan.problem;
        let labels = || {
            problem
                .segments
                .iter()
                .map(|segment| segment.label.as_str())
        };
        let segment =
            match label {
                None => 0,
                Some(name) => labels().position(|label| label == name).ok_or_else(|| {
                    NoSourceCode::Segment {
                        name: name.to_string(),
                        known: labels().collect::<Vec<_>>().join(", "),
                    }
                })?,
            };
        let estimated = Estimated::of(problem, estimate);
        let mut parameters = Vec::new();
        (estimated.unknowns).parameters(segment, &estimated.theta, &mut parameters);
        let label = &problem.segments[segment].label;
        let what = format!("{}, segment {label}", problem.model.document.name);
        Ok(Self {
            segment,
            parameters,
            what,
        })
    }
}
