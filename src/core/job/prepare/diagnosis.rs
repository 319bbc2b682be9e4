//! What a diagnosis asks for beyond an estimation, and what it is made from.

use indexmap::IndexMap;

use super::bounds::JOB_TOO_LARGE;
use super::checks::{MOST_EDITS, too_many_edits};
use super::knowledge;
use super::stretch::Stretch;
use crate::diagnose::{Case, Effect, Flight};
use crate::estimate::{Derivatives, Estimator, Options, Problem, StepsPerSample};
use crate::flight::Fault;
use crate::job::spec::{JobSpec, ManeuverUse};
use crate::model::{Model, ModelDocument, Recorded, Start, expression};
use crate::simulate::Segment;

/// Most values of all outputs: each candidate is simulated along all of them, and kept.
const MOST_VALUES: usize = 500_000;
const MOST_CANDIDATES: usize = 100;

/// A stretch with everything that was recorded along it, and what the job's formulas made of it under the model's names.
pub(super) fn flight(
    model: &Model,
    segment: &Segment,
    stretch: &Stretch<'_>,
    usage: &ManeuverUse,
) -> Flight {
    let inputs = model.inputs.iter().zip(&segment.inputs);
    let of_model = inputs.chain(model.outputs.iter().zip(&segment.measured));
    let mut channels: IndexMap<String, _> = of_model
        .map(|(quantity, values)| {
            (
                quantity.name.clone(),
                (values.clone(), quantity.unit.dimension),
            )
        })
        .collect();
    for name in stretch.names() {
        if let (false, Some((values, dimension))) =
            (channels.contains_key(&name), stretch.channel(&name))
        {
            channels.insert(name, (values.to_vec(), dimension));
        }
    }
    Flight {
        label: segment.label.clone(),
        role: usage.role,
        time: segment.time.clone(),
        steps: segment.steps.clone(),
        channels,
        own: own(usage),
    }
}

/// Constants that a maneuver has for itself, which are parameters of it by now, and its start values.
fn own(usage: &ManeuverUse) -> IndexMap<String, Start> {
    let constants = usage.constants.iter();
    let constants =
        constants.filter_map(|(name, value)| Some((name, Start::Value(value.number()?))));
    let starts = usage
        .start
        .iter()
        .map(|(name, start)| (name, start.clone()));
    let all = starts.chain(constants);
    all.map(|(name, start)| (name.clone(), start)).collect()
}

/// Recorded channels that the job's formulas use.
fn consumed(spec: &JobSpec) -> Vec<String> {
    let formulas = spec.channels.values();
    let formulas = formulas.filter_map(|text| expression::parse(text).ok());
    let names = formulas.flat_map(|tree| {
        let names = tree.names().into_iter().map(|(name, _)| name.to_string());
        names.collect::<Vec<_>>()
    });
    names.collect()
}

/// The case of a job, checked.
pub(super) fn case(
    spec: &JobSpec,
    document: &ModelDocument,
    problem: &Problem,
    flights: Vec<Flight>,
) -> Result<Case, Vec<Fault>> {
    let mut faults = Vec::new();
    if spec.options.estimator != Estimator::OutputError {
        let message = "a diagnosis starts from output error (and turns to filter error where it finds turbulence); choose \"output_error\"";
        faults.push(Fault::new("/options/estimator", "bad_option", message));
    }
    if spec.options.derivatives != Derivatives::default() {
        let message =
            "a diagnosis uses the technique \"forward_sensitivities\"; leave \"derivatives\" out";
        faults.push(Fault::new("/options/derivatives", "bad_option", message));
    }
    let values = problem.samples() * problem.model.outputs.len();
    if values > MOST_VALUES {
        let message = format!(
            "{values} values of outputs, at most {MOST_VALUES} are allowed for a diagnosis; choose \"rows\", or fewer maneuvers"
        );
        faults.push(Fault::new("/maneuvers", JOB_TOO_LARGE, message));
    }
    if spec.candidates.len() > MOST_CANDIDATES {
        let message = format!("at most {MOST_CANDIDATES} candidates are allowed");
        faults.push(Fault::new("/candidates", JOB_TOO_LARGE, message));
    }
    for (i, candidate) in spec.candidates.iter().enumerate().take(MOST_CANDIDATES) {
        let pointer = format!("/candidates/{i}/edits");
        if candidate.edits.len() > MOST_EDITS {
            faults.push(too_many_edits(&pointer, candidate.edits.len()));
            continue;
        }
        let effect = Effect::own(&candidate.name, candidate.edits.clone());
        if let Err(error) = effect.apply(document) {
            faults.push(Fault::new(pointer, error.code(), error.to_string()));
        }
    }
    // what is compared is stepped alike: a motion that only shorter steps could follow is beyond what was recorded
    let steps = problem.segments.iter().map(Segment::most_substeps).max();
    let case = Case {
        document: document.clone(),
        flights,
        options: Options {
            steps_per_sample: StepsPerSample::Number(steps.unwrap_or(1)),
            ..spec.options.clone()
        },
        candidates: (spec.candidates.iter())
            .map(|candidate| Effect::own(&candidate.name, candidate.edits.clone()))
            .collect(),
        knowledge: spec.knowledge.clone(),
        consumed: consumed(spec),
    };
    knowledge::check(&case, &problem.model, &mut faults);
    match faults.is_empty() {
        true => Ok(case),
        false => Err(faults),
    }
}
