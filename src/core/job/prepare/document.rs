//! The model of a job: the declared one with the job's edits and overrides in it, compiled.

use super::checks::MOST_EDITS;
use super::flown::is_own_constant;
use super::unknown_name::unknown_name;
use crate::flight::Fault;
use crate::job::spec::JobSpec;
use crate::model::{Model, ModelDocument, Parameter, Per, Start};

/// The declared document with the job's edits and overrides in it.
pub(super) fn edited(
    spec: &JobSpec,
    declared: &ModelDocument,
    faults: &mut Vec<Fault>,
) -> ModelDocument {
    let mut document = declared.clone();
    for (i, edit) in spec.edits.iter().enumerate().take(MOST_EDITS) {
        match edit.apply(&document) {
            Ok(edited) => document = edited.document,
            Err(error) => faults.push(Fault::new(
                format!("/edits/{i}"),
                error.code(),
                error.to_string(),
            )),
        }
    }
    for (name, value) in &spec.constants {
        if let Some(constant) = document.constants.get_mut(name) {
            // what stands in a recording and could not be found there is a fault already
            constant.value = value.number().unwrap_or(constant.value);
            continue;
        }
        let known = document.constants.keys().map(String::as_str);
        let what = ("constant", name.as_str());
        unknown_name("/constants", "unknown_constant", what, known, faults);
    }
    for (index, usage) in spec.maneuvers.iter().enumerate() {
        for name in usage.constants.keys() {
            of_each_maneuver(&mut document, index, name, faults);
        }
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

/// Turns a constant into what each maneuver has a value of its own of, and nothing is estimated of.
fn of_each_maneuver(
    document: &mut ModelDocument,
    index: usize,
    name: &str,
    faults: &mut Vec<Fault>,
) {
    if let Some(constant) = document.constants.shift_remove(name) {
        let parameter = Parameter {
            unit: constant.unit,
            start: Start::Value(constant.value),
            lower: None,
            upper: None,
            fixed: true,
            per: Per::Maneuver,
            only_in: Vec::new(),
            prior: None,
            quantity: constant.quantity,
            description: constant.description,
        };
        document.parameters.insert(name.to_string(), parameter);
        return;
    }
    // it is one already where another maneuver has named it
    if document.parameters.get(name).is_some_and(is_own_constant) {
        return;
    }
    let pointer = format!("/maneuvers/{index}/constants");
    let known = document.constants.keys().map(String::as_str);
    let what = ("constant", name);
    unknown_name(&pointer, "unknown_constant", what, known, faults);
}

/// The program of a document; faults are where it came from.
pub(super) fn compiled(
    document: &ModelDocument,
    spec: &JobSpec,
    declared: &ModelDocument,
    faults: &mut Vec<Fault>,
) -> Result<Model, Vec<Fault>> {
    Model::compile(document).map_err(|found| {
        let found = found.into_iter();
        faults.extend(found.map(|fault| model_fault(spec, declared, fault)));
        std::mem::take(faults)
    })
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
