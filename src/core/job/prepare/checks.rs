//! What a spec's options and names must be, beyond their types.

use super::structure;
use super::unknown_name::unknown_name;
use crate::estimate::{Estimator, Noise, Options, Problem, Role, StartMethod, has_equation_error};
use crate::flight::Fault;
use crate::job::no_start::no_measured_state;
use crate::job::spec::{JobKind, JobSpec, ManeuverUse, ModelSource};
use crate::model::{Model, Per};

/// Variances of noise that leave the likelihood a number.
const VARIANCES: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// Most maneuvers in one job.
pub const MOST_MANEUVERS: usize = 256;

/// Most edits of a model, in one job or one candidate.
pub(super) const MOST_EDITS: usize = 64;

/// Most iterations that a job may ask for.
pub(super) const MOST_ITERATIONS: usize = 1_000;

pub(super) fn check_shape(spec: &JobSpec, maneuvers: usize, faults: &mut Vec<Fault>) {
    if maneuvers == 0 {
        faults.push(Fault::new(
            "/maneuvers",
            "no_maneuvers",
            "a job needs at least one maneuver",
        ));
    }
    let uses = &spec.maneuvers;
    if !uses.is_empty() && uses.iter().all(|usage| usage.role == Role::Validation) {
        let message = "all maneuvers are there for validation; at least one must have the role \"estimation\"";
        faults.push(Fault::new("/maneuvers", "no_maneuvers", message));
    }
    if maneuvers > MOST_MANEUVERS {
        let message =
            format!("{maneuvers} maneuvers; at most {MOST_MANEUVERS} are allowed in one job");
        faults.push(Fault::new("/maneuvers", "too_many_maneuvers", message));
    }
    if spec.edits.len() > MOST_EDITS {
        faults.push(too_many_edits("/edits", spec.edits.len()));
    }
    if let ModelSource::Reference(name) = &spec.model
        && name.is_empty()
    {
        faults.push(Fault::new(
            "/model",
            "unknown_model",
            "name a model of the catalog, or send a document",
        ));
    }
}

/// What only one kind of job reads is refused of the others: nothing that is asked for passes in silence.
pub(super) fn check_kind(spec: &JobSpec, faults: &mut Vec<Fault>) {
    if spec.kind != JobKind::Diagnose && !spec.candidates.is_empty() {
        let message = "only a diagnosis tries candidates; say \"kind\": \"diagnose\", or put the edits into \"edits\"";
        faults.push(Fault::new("/candidates", "bad_option", message));
    }
    structure::check_kind(spec, faults);
}

pub(super) fn too_many_edits(pointer: &str, count: usize) -> Fault {
    let message = format!(
        "{count} edits are more than {MOST_EDITS}; write a model document with the effects in it"
    );
    Fault::new(pointer, "too_many_edits", message)
}

pub(super) fn check_options(options: &Options, model: &Model, faults: &mut Vec<Fault>) {
    if !(options.tolerance > 0.0 && options.tolerance <= 1.0) {
        faults.push(Fault::new(
            "/options/tolerance",
            "bad_option",
            "tolerance must be above 0 and at most 1 standard error",
        ));
    }
    if options.max_iterations > MOST_ITERATIONS {
        let message = format!("max_iterations must be from 0 to {MOST_ITERATIONS}");
        faults.push(Fault::new("/options/max_iterations", "bad_option", message));
    }
    if let Some(message) = options.steps_per_sample.fault() {
        let pointer = "/options/steps_per_sample";
        faults.push(Fault::new(pointer, "bad_option", message));
    }
    if let Some(message) = options.derivatives.fault() {
        let pointer = "/options/derivatives/step";
        faults.push(Fault::new(pointer, "bad_option", message));
    }
    if let Some((field, message)) = options.start.unfit() {
        faults.push(Fault::new(
            format!("/options/start/{field}"),
            "bad_option",
            message,
        ));
    }
    check_equation_error(options, faults);
    if let Noise::Given { variance } = &options.noise {
        let outputs: Vec<&str> = model
            .outputs
            .iter()
            .map(|output| output.name.as_str())
            .collect();
        if variance.len() != outputs.len() || variance.iter().any(|v| !VARIANCES.contains(v)) {
            let message = format!(
                "give one variance from 1e-60 to 1e60 for each output, in this order: {}",
                outputs.join(", ")
            );
            faults.push(Fault::new("/options/noise/variance", "bad_option", message));
        }
    }
}

/// Least squares of the equations have a noise of their own, and begin where the document says.
fn check_equation_error(options: &Options, faults: &mut Vec<Fault>) {
    if options.estimator != Estimator::EquationError {
        return;
    }
    if options.noise != Noise::default() {
        let message = "the noise of equation error is that of derivatives, not of outputs: each has a variance of its own, which is estimated; leave this out";
        faults.push(Fault::new("/options/noise", "bad_option", message));
    }
    if !matches!(
        options.start,
        StartMethod::Automatic {} | StartMethod::Document {}
    ) {
        let message = "\"equation_error\" is least squares and begins with the start values of the parameters; leave this out";
        faults.push(Fault::new("/options/start", "bad_option", message));
    }
}

pub(super) fn check_names(spec: &JobSpec, model: &Model, faults: &mut Vec<Fault>) {
    for name in spec.channels.keys() {
        let quantities = model.inputs.iter().chain(&model.outputs);
        let known = quantities.map(|quantity| quantity.name.as_str());
        if !known.clone().any(|known| known == name) {
            let what = ("input or output", name.as_str());
            unknown_name("/channels", "unknown_channel", what, known, faults);
        }
    }
    for (index, usage) in spec.maneuvers.iter().enumerate() {
        check_own_names(index, usage, model, faults);
    }
}

/// Names that a maneuver says something of for itself.
fn check_own_names(index: usize, usage: &ManeuverUse, model: &Model, faults: &mut Vec<Fault>) {
    for name in usage.channels.keys() {
        let quantities = model.inputs.iter().chain(&model.outputs);
        let known = quantities.map(|quantity| quantity.name.as_str());
        if !known.clone().any(|known| known == name) {
            let what = ("input or output", name.as_str());
            let pointer = format!("/maneuvers/{index}/channels");
            unknown_name(&pointer, "unknown_channel", what, known, faults);
        }
    }
    for name in usage.start.keys() {
        let own = model.parameters.iter();
        let own = own.filter(|parameter| parameter.document.per == Per::Maneuver);
        let known = own.map(|parameter| parameter.name.as_str());
        if !known.clone().any(|known| known == name) {
            let what = ("parameter of each maneuver's own", name.as_str());
            let pointer = format!("/maneuvers/{index}/start");
            unknown_name(&pointer, "unknown_parameter", what, known, faults);
        }
    }
}

/// Equation error needs states that are measured.
pub(super) fn check_estimator(problem: &Problem) -> Result<(), Vec<Fault>> {
    let options = &problem.options;
    let asked =
        options.estimator.is_equation_error() || options.start == StartMethod::EquationError {};
    if asked && !has_equation_error(problem) {
        return Err(vec![no_measured_state(problem)]);
    }
    Ok(())
}

/// Motions must be such that steps can follow them.
pub(super) fn check_stiffness(problem: &Problem) -> Result<(), Vec<Fault>> {
    let Some(found) = problem.too_stiff() else {
        return Ok(());
    };
    let state = &problem.model.states[found.state].name;
    let message = format!(
        "with the start values '{state}' moves at {:.3e} 1/s, which takes {:.0} integration steps from one sample of segment {} to the next, or too many in all; give the state its steady value as a quantity, start closer, or say \"steps_per_sample\"",
        found.rate,
        found.steps.ceil(),
        problem.segments[found.segment].label
    );
    Err(vec![Fault::new("/model/states", "too_stiff", message)])
}
