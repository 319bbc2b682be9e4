//! Predictions with inputs alone: an estimated model simulated along other recordings, with bounds; and how it compares
//! with what they have of its outputs.

use std::sync::Arc;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::prepare::prepare_prediction;
use super::spec::{JobSpec, ManeuverUse};
use super::tolerance::{Tolerance, ToleranceHeld};
use crate::estimate::{
    DRAWS, Estimate, MonteCarlo, OutputFit, Problem, QuantityKind, SimulatedQuantity,
    SimulatedSegment, is_kinematic, simulate_estimate,
};
use crate::flight::{Fault, Faults, Maneuver};
use crate::model::{ModelDocument, Quantities};

/// What is to be predicted.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct PredictionSpec {
    /// Recordings of the inputs, and of as many outputs as they have. Parameters of a maneuver (initial states, biases) are at
    /// the model's start values, or at what `start` says; nothing is estimated. What the job takes from its recordings
    /// (`recording.mass`) is taken from these; what each of its maneuvers had a value of its own of, each of these says in
    /// `constants`. `role` does not matter.
    #[schema(min_items = 1)]
    pub maneuvers: Vec<ManeuverUse>,
    /// How model inputs and outputs are made from recorded channels, where not as the job says.
    #[serde(
        default,
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(example = json!({"da": "(da_right - da_left)/2"}))]
    pub channels: IndexMap<String, String>,
    /// States, definitions and outputs to answer with; empty: all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(example = json!(["alpha", "q"]))]
    pub names: Vec<String>,
    /// Ranges by draws over the covariance of the parameters; absent: standard errors alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub monte_carlo: Option<MonteCarlo>,
}

/// One recording, predicted.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct PredictedSegment {
    /// The maneuver's label.
    #[schema(example = "doublet")]
    pub segment: String,
    /// Seconds of the recording.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub time: Vec<f64>,
    /// States, then definitions, then outputs, in the order of the model.
    pub quantities: Vec<SimulatedQuantity>,
    /// Of outputs that are recorded: how well they are predicted.
    pub outputs: Vec<PredictedOutput>,
    /// Draws that the simulation could not follow; they do not count.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub draws_lost: Option<usize>,
}

/// How well a recorded output is predicted.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct PredictedOutput {
    /// RMS error, bias, R², Theil's coefficient with its shares.
    #[serde(flatten)]
    pub fit: OutputFit,
    /// Against what simulators are qualified by, where that knows the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<ToleranceHeld>,
}

/// Predicts recordings with an estimate. `spec` is the job that was estimated, `estimated` the model as it was.
///
/// # Errors
/// Every fault with its JSON pointer into `wanted`; a simulation that leaves the range of numbers.
pub fn predicted(
    spec: &JobSpec,
    wanted: &PredictionSpec,
    estimated: &ModelDocument,
    estimate: &Estimate,
    maneuvers: &[Arc<Maneuver>],
) -> Result<Vec<PredictedSegment>, Faults> {
    check(wanted, estimated)?;
    let mut channels = spec.channels.clone();
    channels.extend(wanted.channels.clone());
    let spec = JobSpec {
        maneuvers: with_constants_of(spec, &wanted.maneuvers),
        channels,
        // what they did is in the model
        edits: Vec::new(),
        parameters: IndexMap::new(),
        constants: IndexMap::new(),
        ..spec.clone()
    };
    let problem = prepare_prediction(&spec, estimated, estimate, maneuvers)?;
    let simulated = simulate_estimate(&problem, estimate, &wanted.names, wanted.monte_carlo)
        .map_err(|why| vec![Fault::new("/maneuvers", "no_prediction", why.to_string())])?;
    let known = Quantities::of(&problem.model.document);
    // what a reconstruction computes is recorded motion, and no response
    let known = match is_kinematic(&problem.model) {
        true => Quantities::default(),
        false => known,
    };
    let report = |(index, segment): (usize, SimulatedSegment)| PredictedSegment {
        segment: problem.segments[index].label.clone(),
        time: problem.segments[index].time.clone(),
        outputs: (segment.fits.into_iter())
            .map(|(place, fit)| compared(&problem, &known, index, place, fit, &segment.outputs))
            .collect(),
        quantities: segment.quantities,
        draws_lost: segment.draws_lost,
    };
    Ok(simulated.into_iter().enumerate().map(report).collect())
}

/// Constants that the job takes from what is said of its recordings are taken from that of these, where they do not say
/// otherwise.
fn with_constants_of(spec: &JobSpec, wanted: &[ManeuverUse]) -> Vec<ManeuverUse> {
    let mut wanted = wanted.to_vec();
    for (name, value) in &spec.constants {
        if value.of_recording().is_none() {
            continue;
        }
        let silent = |usage: &&mut ManeuverUse| !usage.start.contains_key(name);
        for usage in wanted.iter_mut().filter(silent) {
            let own = usage.constants.entry(name.clone());
            own.or_insert_with(|| value.clone());
        }
    }
    wanted
}

fn compared(
    problem: &Problem,
    known: &Quantities,
    index: usize,
    output: usize,
    fit: OutputFit,
    simulated: &[Vec<f64>],
) -> PredictedOutput {
    let measured = &problem.segments[index].measured[output];
    let residual: Vec<f64> = (measured.iter().zip(&simulated[output]))
        .map(|(z, y)| z - y)
        .collect();
    let tolerance = known
        .output(&fit.name)
        .and_then(|quantity| Tolerance::of(quantity, &fit.unit));
    PredictedOutput {
        tolerance: tolerance.map(|tolerance| tolerance.held(measured, &residual)),
        fit,
    }
}

fn check(wanted: &PredictionSpec, document: &ModelDocument) -> Result<(), Vec<Fault>> {
    let mut faults = Vec::new();
    let known = |name: &String| {
        document.states.contains_key(name)
            || document.definitions.contains_key(name)
            || document.outputs.contains_key(name)
    };
    for (at, name) in wanted
        .names
        .iter()
        .enumerate()
        .filter(|(_, name)| !known(name))
    {
        let all = (document.states.keys())
            .chain(document.definitions.keys())
            .chain(document.outputs.keys());
        let mut all: Vec<&str> = all.map(String::as_str).collect();
        all.sort_unstable();
        all.dedup();
        let message = format!("the model has no '{name}'; it has {}", all.join(", "));
        faults.push(Fault::new(format!("/names/{at}"), "unknown_name", message));
    }
    if let Some(question) = wanted
        .monte_carlo
        .filter(|question| !DRAWS.contains(&question.draws))
    {
        let message = format!(
            "{} draws; choose from {} to {}",
            question.draws,
            DRAWS.start(),
            DRAWS.end()
        );
        faults.push(Fault::new("/monte_carlo/draws", "bad_option", message));
    }
    if faults.is_empty() {
        Ok(())
    } else {
        Err(faults)
    }
}

impl PredictedSegment {
    /// The series of an output.
    pub fn output(&self, name: &str) -> Option<&SimulatedQuantity> {
        let mut all = self.quantities.iter();
        all.find(|series| series.kind == QuantityKind::Output && series.name == name)
    }
}
