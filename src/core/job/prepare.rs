//! From a spec and its data to a plan: all that bad input could break is found here.

use std::sync::Arc;

use super::resolve::{self, Named, Stretch};
use super::unknown_name::unknown_name;
use super::{Fault, JobKind, JobSpec, Prepared, diagnosis, study};
use super::{bounds, checks, filter, missing, plausible};
use crate::diagnose::Case;
use crate::estimate::{Problem, Role, Unknowns, Validation};
use crate::flight::{Maneuver, escape};
use crate::model::{ChannelFormula, Model, ModelDocument, Start};
use crate::simulate::Segment;

/// A job whose model is compiled and whose data are resolved: nothing left that bad input could break.
pub struct Plan {
    pub prepared: Prepared,
    /// The model as estimated: the declared one with the job's edits and parameter overrides in it.
    pub model: ModelDocument,
    pub problem: Problem,
    /// What is predicted with the estimate.
    pub validation: Vec<Validation>,
    /// Of a diagnosis: all that it is made from.
    pub case: Option<Case>,
}

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
    checks::check_shape(spec, maneuvers.len(), &mut faults);
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
    checks::check_options(&spec.options, &model, &mut faults);
    filter::check_options(&spec.options, &model, &mut faults);
    checks::check_names(spec, &model, &mut faults);

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
    let (mut fitted, mut predicted, mut flights) = (Vec::new(), Vec::new(), Vec::new());
    for (index, stretches) in stretches.iter().enumerate() {
        for stretch in stretches {
            let segment = resolve::segment(spec, &model, stretch, index, &mut faults);
            if spec.kind == JobKind::Diagnose {
                let role = spec.maneuvers[index].role;
                flights.push(diagnosis::flight(&model, &segment, stretch, role));
            }
            match spec.maneuvers[index].role {
                Role::Estimation => fitted.push((segment, stretch)),
                Role::Validation | Role::Final => predicted.push((segment, stretch)),
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
    findings.extend(plausible::findings(&model, &segments));
    let problem = Problem::new(model, segments, unknowns, spec.options.clone());
    if spec.kind == JobKind::DerivativeStudy {
        study::check(&problem)?;
    }
    checks::check_estimator(&problem)?;
    let case = match spec.kind {
        JobKind::Diagnose => Some(diagnosis::case(spec, &document, &problem, flights)?),
        JobKind::Estimate | JobKind::DerivativeStudy => None,
    };
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
        case,
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

/// The declared document with the job's edits and overrides in it.
fn edited(spec: &JobSpec, declared: &ModelDocument, faults: &mut Vec<Fault>) -> ModelDocument {
    let mut document = declared.clone();
    for (i, edit) in spec.edits.iter().enumerate().take(checks::MOST_EDITS) {
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
        let known = document.constants.keys().map(String::as_str);
        let what = ("constant", name.as_str());
        unknown_name("/constants", "unknown_constant", what, known, faults);
    }
    for (name, change) in &spec.parameters {
        let Some(parameter) = document.parameters.get_mut(name) else {
            let known = document.parameters.keys().map(String::as_str);
            let what = ("parameter", name.as_str());
            unknown_name("/parameters", "unknown_parameter", what, known, faults);
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
