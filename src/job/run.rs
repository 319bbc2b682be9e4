//! From a spec and its data to a result: pure, synchronous, deterministic.

use std::ops::ControlFlow;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::resolve::{self, Named, Stretch};
use super::{Fault, JobKind, JobSpec, ModelSource, Prepared, study};
use super::{bounds, filter, missing};
use crate::estimate::study::DerivativeStudy;
use crate::estimate::{
    Derivatives, Estimate, Estimator, Noise, Options, Outcome, Problem, Progress, Role, Solution,
    StartMethod, TimeHistory, Unknowns, Unusable, Validation, estimate, has_equation_error,
    predict,
};
use crate::flight::{Maneuver, escape};
use crate::model::{ChannelFormula, Model, ModelDocument, Start};
use crate::simulate::{MOST_DELAY, Segment};

/// A job whose model is compiled and whose data are resolved: nothing left that bad input could break.
pub struct Plan {
    pub prepared: Prepared,
    /// The model as estimated: the declared one with the job's edits and parameter overrides in it.
    pub model: ModelDocument,
    pub problem: Problem,
    /// What is predicted with the estimate.
    pub validation: Vec<Validation>,
}

/// Everything a finished job answers.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct JobResult {
    pub estimate: Estimate,
    pub model: ModelDocument,
    pub histories: Vec<TimeHistory>,
    /// Of a derivative study.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub study: Option<DerivativeStudy>,
}

/// Variances of noise that leave the likelihood a number.
const VARIANCES: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// Most maneuvers in one job.
pub const MOST_MANEUVERS: usize = 256;
/// Most iterations that a job may ask for.
pub const MOST_ITERATIONS: usize = 1_000;

/// Compiles the model, applies edits and overrides, makes inputs and outputs from recorded channels,
/// checks units. `maneuvers` are in the order of `spec.maneuvers`; `declared` is the spec's model, looked up.
///
/// # Errors
/// Every fault that would prevent the start, each with its JSON pointer into the spec.
pub fn prepare(
    spec: &JobSpec,
    declared: &ModelDocument,
    maneuvers: &[Arc<Maneuver>],
) -> Result<Plan, Vec<Fault>> {
    let mut faults = Vec::new();
    let document = edited(spec, declared, &mut faults);
    check_shape(spec, maneuvers.len(), &mut faults);
    let model = match Model::compile(&document) {
        Ok(model) => model,
        Err(errors) => {
            faults.extend(
                errors
                    .into_iter()
                    .map(|error| model_fault(spec, declared, error)),
            );
            return Err(faults);
        }
    };
    check_options(&spec.options, &model, &mut faults);
    filter::check_options(&spec.options, &model, &mut faults);
    check_names(spec, &model, &mut faults);

    let mut findings = Vec::new();
    let recordings: Vec<&Maneuver> = maneuvers.iter().map(Arc::as_ref).collect();
    let stretches = resolve::stretches(spec, &recordings, &mut findings, &mut faults);
    bounds::check_data(&model, &stretches, &mut faults);
    if faults
        .iter()
        .any(|fault| fault.code == bounds::JOB_TOO_LARGE)
    {
        return Err(faults);
    }
    let (mut fitted, mut predicted) = (Vec::new(), Vec::new());
    for (index, stretches) in stretches.iter().enumerate() {
        for stretch in stretches {
            let segment = resolve::segment(spec, &model, stretch, index, &mut faults);
            match spec.maneuvers[index].role {
                Role::Estimation => fitted.push((segment, stretch)),
                Role::Validation => predicted.push((segment, stretch)),
            }
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let unknowns = unknowns(spec, &model, &fitted)?;
    let segments: Vec<Segment> = fitted.into_iter().map(|(segment, _)| segment).collect();
    missing::check_samples(&model, &segments, &spec.options, &mut findings, &mut faults);
    faults.extend(missing::check_counts(
        &model,
        &segments,
        &unknowns,
        &spec.options,
    ));
    if !faults.is_empty() {
        return Err(faults);
    }
    bounds::check_unknowns(&model, &segments, &unknowns, &spec.options)?;
    let mut validation = Vec::new();
    for resolved in predicted {
        let unknowns = self::unknowns(spec, &model, std::slice::from_ref(&resolved))?;
        let (segment, _) = resolved;
        bounds::check_validation(&model, &segment, &unknowns)?;
        validation.push(Validation { segment, unknowns });
    }
    filter::check_data(&model, &segments, &unknowns, &spec.options)?;
    let problem = Problem::new(model, segments, unknowns, spec.options.clone());
    if spec.kind == JobKind::DerivativeStudy {
        study::check(&problem)?;
    }
    check_estimator(&problem)?;
    let prepared = Prepared {
        segments: problem
            .segments
            .iter()
            .map(|segment| segment.label.clone())
            .collect(),
        validation: (validation.iter())
            .map(|validation| validation.segment.label.clone())
            .collect(),
        samples: problem.samples(),
        outputs: problem
            .model
            .outputs
            .iter()
            .map(|output| output.name.clone())
            .collect(),
        parameters: (0..problem.unknowns.len())
            .map(|place| problem.name(place))
            .chain(filter::process_noise(&problem))
            .collect(),
        findings,
    };
    Ok(Plan {
        prepared,
        model: document,
        problem,
        validation,
    })
}

/// The unknowns over segments, with start values from the recordings where the model asks for that.
fn unknowns(
    spec: &JobSpec,
    model: &Model,
    resolved: &[(Segment, &Stretch<'_>)],
) -> Result<Unknowns, Vec<Fault>> {
    let start = |parameter: usize, segment: usize| {
        let info = &model.parameters[parameter];
        let (segment, stretch) = &resolved[segment];
        let text = match &info.document.start {
            Start::Value(value) => return Ok(info.unit.to_si(*value)),
            Start::FromData(text) => text,
        };
        let on = Named {
            model,
            stretch,
            segment,
        };
        start_from_data(text, &on, info.unit.dimension)
            .map_err(|(code, message)| Fault::new(start_pointer(spec, &info.name), code, message))
    };
    Unknowns::new(model, resolved.len(), start).map_err(|fault| vec![fault])
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
        estimate: mut result,
        mut histories,
    } = estimate(problem, watcher).map_err(|why| vec![no_start(problem, why)])?;
    if result.outcome != Outcome::Cancelled {
        for validation in &plan.validation {
            let (prediction, history) = predict(problem, &result, validation);
            result.prediction.push(prediction);
            histories.extend(history);
        }
    }
    Ok(JobResult {
        estimate: result,
        histories,
        model: plan.model.clone(),
        study: None,
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
        Unusable::NoMeasuredState => no_measured_state(problem),
    }
}

/// Equation error needs states that are measured.
fn check_estimator(problem: &Problem) -> Result<(), Vec<Fault>> {
    let options = &problem.options;
    let asked = options.estimator == Estimator::EquationError
        || options.start == StartMethod::EquationError {};
    if asked && !has_equation_error(problem) {
        return Err(vec![no_measured_state(problem)]);
    }
    Ok(())
}

fn no_measured_state(problem: &Problem) -> Fault {
    let pointer = match problem.options.estimator {
        Estimator::EquationError => "/options/estimator",
        Estimator::OutputError | Estimator::FilterError => "/options/start",
    };
    let message = "equation error needs an output that measures a state: its equation is the state, possibly with a bias, scale or drift parameter; add such an output, or choose another";
    Fault::new(pointer, "no_measured_state", message)
}

/// The declared document with the job's edits and overrides in it.
fn edited(spec: &JobSpec, declared: &ModelDocument, faults: &mut Vec<Fault>) -> ModelDocument {
    let mut document = declared.clone();
    for (i, edit) in spec.edits.iter().enumerate() {
        match edit.apply(&document) {
            Ok(edited) => document = edited,
            Err(error) => faults.push(Fault::new(
                format!("/edits/{i}"),
                error.code(),
                error.to_string(),
            )),
        }
    }
    for (name, &value) in &spec.constants {
        if let Some(constant) = document.constants.get_mut(name) {
            constant.value = value;
            continue;
        }
        let known: Vec<&str> = document.constants.keys().map(String::as_str).collect();
        let message = format!(
            "the model has no constant '{name}'; it has {}",
            if known.is_empty() {
                "none".to_string()
            } else {
                known.join(", ")
            }
        );
        faults.push(Fault::new(
            format!("/constants/{}", escape(name)),
            "unknown_constant",
            message,
        ));
    }
    for (name, change) in &spec.parameters {
        let Some(parameter) = document.parameters.get_mut(name) else {
            let known: Vec<&str> = document.parameters.keys().map(String::as_str).collect();
            let message = format!(
                "the model has no parameter '{name}'; it has {}",
                known.join(", ")
            );
            faults.push(Fault::new(
                format!("/parameters/{}", escape(name)),
                "unknown_parameter",
                message,
            ));
            continue;
        };
        if let Some(start) = &change.start {
            parameter.start = start.clone();
        }
        parameter.lower = change.lower.or(parameter.lower);
        parameter.upper = change.upper.or(parameter.upper);
        parameter.fixed = change.fixed.unwrap_or(parameter.fixed);
        parameter.prior = change.prior.or(parameter.prior);
    }
    document
}

/// Where a fault of the edited document came from: an override, or the model itself.
fn model_fault(spec: &JobSpec, declared: &ModelDocument, fault: Fault) -> Fault {
    let parameter = fault
        .pointer
        .strip_prefix("/parameters/")
        .and_then(|rest| rest.split('/').next());
    let overridden = parameter.is_some_and(|name| {
        spec.parameters.contains_key(name) && declared.parameters.contains_key(name)
    });
    let prefix = if overridden { "" } else { "/model" };
    fault.under(prefix)
}

fn check_shape(spec: &JobSpec, maneuvers: usize, faults: &mut Vec<Fault>) {
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

fn check_options(options: &Options, model: &Model, faults: &mut Vec<Fault>) {
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
    if let Some(message) = options.derivatives.fault() {
        let pointer = "/options/derivatives/step";
        faults.push(Fault::new(pointer, "bad_option", message));
    }
    if !model.delays.is_empty() && options.derivatives != Derivatives::default() {
        let message = "delays are known to the technique \"forward_sensitivities\" alone; choose it, or leave the delays out of the model";
        faults.push(Fault::new("/options/derivatives", "bad_option", message));
    }
    if let Some((field, message)) = options.start.unfit() {
        faults.push(Fault::new(
            format!("/options/start/{field}"),
            "bad_option",
            message,
        ));
    }
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

fn check_names(spec: &JobSpec, model: &Model, faults: &mut Vec<Fault>) {
    for name in spec.channels.keys() {
        let mut known = model
            .inputs
            .iter()
            .chain(&model.outputs)
            .map(|quantity| quantity.name.as_str());
        if !known.clone().any(|k| k == name) {
            let known: Vec<&str> = known.by_ref().collect();
            let message = format!(
                "the model has no input or output '{name}'; it has {}",
                known.join(", ")
            );
            faults.push(Fault::new(
                format!("/channels/{}", escape(name)),
                "unknown_channel",
                message,
            ));
        }
    }
}

/// Where a parameter's start was given.
fn start_pointer(spec: &JobSpec, name: &str) -> String {
    let overridden = spec
        .parameters
        .get(name)
        .is_some_and(|change| change.start.is_some());
    format!(
        "{}/parameters/{}/start",
        if overridden { "" } else { "/model" },
        escape(name)
    )
}

fn start_from_data(
    text: &str,
    on: &Named<'_>,
    wanted: crate::flight::Dimension,
) -> Result<f64, (&'static str, String)> {
    let formula = ChannelFormula::parse(text).map_err(|error| (error.code(), error.to_string()))?;
    let number = formula.number(on).map_err(|error| {
        (error.code(), format!("{error}; give the start as a number: \"parameters\": {{\"<name>\": {{\"start\": ...}}}}"))
    })?;
    match formula.dimension(on) {
        Ok(Some(found)) if found != wanted => Err((
            "unit_mismatch",
            format!("'{text}' is in {found} where the parameter is in {wanted}"),
        )),
        _ => Ok(number),
    }
}
