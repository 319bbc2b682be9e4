//! The names of a document: what each stands for, and whether they are fit to be used.

use indexmap::IndexMap;

use super::document::ModelDocument;
use super::expression::{Function, is_name, written_unit};
use crate::flight::{Dimension, Fault, Unit, escape};

/// What a name in an equation stands for.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Meaning {
    /// A number in SI.
    Constant(f64),
    Input(usize),
    Parameter(usize),
    Definition(usize),
    State(usize),
    Time,
}

/// All names of a document, with what they stand for and measure.
pub(super) struct Names<'d> {
    table: IndexMap<&'d str, (Meaning, Option<Dimension>)>,
}

/// Names with a meaning of their own.
const TIME: &str = "t";
const PI: &str = "pi";

impl<'d> Names<'d> {
    /// Collects names and units; what is wrong with them is added to `faults`.
    pub(super) fn collect(document: &'d ModelDocument, faults: &mut Vec<Fault>) -> Self {
        let mut table = IndexMap::new();
        table.insert(TIME, (Meaning::Time, Some(Dimension::SECOND)));
        table.insert(
            PI,
            (
                Meaning::Constant(std::f64::consts::PI),
                Some(Dimension::NONE),
            ),
        );
        let mut names = Self { table };
        for (name, constant) in &document.constants {
            let unit = unit(
                &constant.unit,
                &format!("/constants/{}/unit", escape(name)),
                faults,
            );
            if !constant.value.is_finite() {
                let pointer = format!("/constants/{}/value", escape(name));
                faults.push(Fault::new(
                    pointer,
                    "not_finite",
                    "a constant must be a finite number",
                ));
            }
            let value = unit.map_or(constant.value, |unit| unit.to_si(constant.value));
            names.add("constants", name, Meaning::Constant(value), unit, faults);
        }
        for (i, (name, input)) in document.inputs.iter().enumerate() {
            let unit = unit(
                &input.unit,
                &format!("/inputs/{}/unit", escape(name)),
                faults,
            );
            names.add("inputs", name, Meaning::Input(i), unit, faults);
        }
        for (i, (name, parameter)) in document.parameters.iter().enumerate() {
            let unit = unit(
                &parameter.unit,
                &format!("/parameters/{}/unit", escape(name)),
                faults,
            );
            names.add("parameters", name, Meaning::Parameter(i), unit, faults);
        }
        for (i, (name, definition)) in document.definitions.iter().enumerate() {
            let unit = unit(
                &definition.unit,
                &format!("/definitions/{}/unit", escape(name)),
                faults,
            );
            names.add("definitions", name, Meaning::Definition(i), unit, faults);
        }
        for (i, (name, state)) in document.states.iter().enumerate() {
            let unit = unit(
                &state.unit,
                &format!("/states/{}/unit", escape(name)),
                faults,
            );
            names.add("states", name, Meaning::State(i), unit, faults);
        }
        for name in document.outputs.keys() {
            let pointer = format!("/outputs/{}", escape(name));
            if let Some(fault) = unfit(name, &pointer) {
                faults.push(fault);
            }
            if document.inputs.contains_key(name) {
                let message = format!(
                    "'{name}' is an input too; what is recorded once cannot drive the model and test it"
                );
                faults.push(Fault::new(pointer, "duplicate_name", message));
            }
        }
        names
    }

    pub(super) fn meaning(&self, name: &str) -> Option<Meaning> {
        if let Some(Ok(unit)) = written_unit(name) {
            return Some(Meaning::Constant(unit.scale));
        }
        self.table.get(name).map(|&(meaning, _)| meaning)
    }

    pub(super) fn dimension(&self, name: &str) -> Option<Dimension> {
        if let Some(Ok(unit)) = written_unit(name) {
            return Some(unit.dimension);
        }
        self.table.get(name).and_then(|&(_, dimension)| dimension)
    }

    /// What is said of a name that is not there.
    pub(super) fn unknown(&self, name: &str) -> String {
        let known = self.table.keys().copied();
        let near = known
            .filter(|candidate| candidate.len().abs_diff(name.len()) <= 2)
            .map(|candidate| (strsim::osa_distance(candidate, name), candidate))
            .filter(|&(distance, candidate)| distance <= 2.min(candidate.len() / 2))
            .min();
        match near {
            Some((_, candidate)) => format!("'{name}' is not defined; did you mean '{candidate}'?"),
            None => Self::undefined(name),
        }
    }

    /// As [`Self::unknown`], without a guess at what was meant.
    pub(super) fn undefined(name: &str) -> String {
        format!("'{name}' is not a constant, input, parameter, definition or state of this model")
    }

    fn add(
        &mut self,
        section: &str,
        name: &'d str,
        meaning: Meaning,
        unit: Option<Unit>,
        faults: &mut Vec<Fault>,
    ) {
        let pointer = format!("/{section}/{}", escape(name));
        if let Some(fault) = unfit(name, &pointer) {
            faults.push(fault);
        } else if self
            .table
            .insert(name, (meaning, unit.map(|unit| unit.dimension)))
            .is_some()
        {
            let message = format!(
                "'{name}' is defined twice; constants, inputs, parameters, definitions and states share their names"
            );
            faults.push(Fault::new(pointer, "duplicate_name", message));
        }
    }
}

/// Functions of recordings have no place in equations, so that models may have such names; those that came first keep theirs.
fn is_reserved(name: &str) -> bool {
    const FIRST: [Function; 3] = [Function::First, Function::Mean, Function::Interpolated];
    let reserves = |function: Function| !function.is_of_recordings() || FIRST.contains(&function);
    Function::find(name).is_some_and(reserves)
}

fn unfit(name: &str, pointer: &str) -> Option<Fault> {
    let why = if !is_name(name) {
        "a name is a letter or '_' followed by letters, digits and '_', at most 64 in all"
            .to_string()
    } else if name == TIME || name == PI || is_reserved(name) {
        format!("'{name}' has a meaning of its own in equations; choose another name")
    } else {
        return None;
    };
    Some(Fault::new(pointer, "invalid_name", why))
}

fn unit(text: &str, pointer: &str, faults: &mut Vec<Fault>) -> Option<Unit> {
    Unit::parse(text)
        .map_err(|error| faults.push(Fault::new(pointer, "unknown_unit", error.to_string())))
        .ok()
}
