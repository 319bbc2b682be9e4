//! The equations of a document, parsed, with their names and units checked.

use super::dimensions::measure;
use super::document::ModelDocument;
use super::expression::{self, Expression, Function, Kind, Span};
use super::names::{Meaning, Names};
use crate::flight::{Dimension, Fault, Unit, escape};

/// The parsed and checked equations of a document, in its order.
pub(super) struct Equations {
    pub definitions: Vec<Expression>,
    pub initial: Vec<Expression>,
    pub dynamics: Vec<Expression>,
    pub observation: Vec<Expression>,
}

impl Equations {
    pub fn read(document: &ModelDocument, names: &Names, faults: &mut Vec<Fault>) -> Self {
        let mut read = |pointer: String, text: &str, unit: &str, of: Option<Dimension>| {
            read_equation(&pointer, text, unit, of, names, faults)
        };
        let dimension = |unit: &str| Unit::parse(unit).ok().map(|unit| unit.dimension);
        let definitions = (document.definitions.iter())
            .map(|(name, d)| {
                read(
                    format!("/definitions/{}/equation", escape(name)),
                    &d.equation,
                    &d.unit,
                    dimension(&d.unit),
                )
            })
            .collect();
        let initial = (document.states.iter())
            .map(|(name, s)| {
                read(
                    format!("/states/{}/initial", escape(name)),
                    &s.initial,
                    &s.unit,
                    dimension(&s.unit),
                )
            })
            .collect();
        let dynamics = (document.states.iter())
            .map(|(name, s)| {
                let rate = dimension(&s.unit).map(|d| d.over(Dimension::SECOND));
                let unit = if matches!(s.unit.as_str(), "" | "-") {
                    "1/s".to_string()
                } else {
                    format!("{}/s", s.unit)
                };
                read(
                    format!("/states/{}/derivative", escape(name)),
                    &s.derivative,
                    &unit,
                    rate,
                )
            })
            .collect();
        let observation = (document.outputs.iter())
            .map(|(name, o)| {
                read(
                    format!("/outputs/{}/equation", escape(name)),
                    &o.equation,
                    &o.unit,
                    dimension(&o.unit),
                )
            })
            .collect();
        for (name, state) in &document.states {
            initial_is_constant(name, &state.initial, names, faults);
        }
        Self {
            definitions,
            initial,
            dynamics,
            observation,
        }
    }
}

/// Parses one equation, checks its names and units. What cannot be read counts as 0, with a fault added.
fn read_equation(
    pointer: &str,
    text: &str,
    unit: &str,
    wanted: Option<Dimension>,
    names: &Names,
    faults: &mut Vec<Fault>,
) -> Expression {
    let mut fault = |code, message: String| faults.push(Fault::new(pointer, code, message));
    let zero = Expression {
        kind: Kind::Number(0.0),
        span: Span::default(),
    };
    let parsed = match expression::parse(text) {
        Ok(parsed) => parsed,
        Err(error) => {
            fault("syntax_error", error.to_string());
            return zero;
        }
    };
    let mut all_known = true;
    for (name, span) in parsed.names() {
        if names.meaning(name).is_none() {
            all_known = false;
            fault(
                "unknown_symbol",
                format!("column {}: {}", span.start + 1, names.unknown(name)),
            );
        }
    }
    if let Some(function) = data_function(&parsed) {
        let message = format!(
            "{}() looks at a recording and may stand only in a parameter's start",
            function.name()
        );
        fault("syntax_error", message);
        return zero;
    }
    if all_known {
        match (measure(&parsed, &|name| names.dimension(name)), wanted) {
            (Err(mismatch), _) => {
                let place = mismatch.span.start + 1;
                fault(
                    "unit_mismatch",
                    format!("column {place}: {}", mismatch.message),
                );
            }
            (Ok(Some(found)), Some(wanted)) if found != wanted => {
                let unit = if unit.is_empty() { "-" } else { unit };
                fault(
                    "unit_mismatch",
                    format!("'{text}' is in {found} where {wanted} is needed (unit '{unit}')"),
                );
            }
            _ => {}
        }
    }
    parsed
}

/// The first function in the tree that needs a recording.
fn data_function(expression: &Expression) -> Option<Function> {
    match &expression.kind {
        Kind::Number(_) | Kind::Name(_) => None,
        Kind::Negate(inner) => data_function(inner),
        Kind::Binary(_, left, right) => data_function(left).or_else(|| data_function(right)),
        Kind::Call(function @ (Function::First | Function::Mean), _) => Some(*function),
        Kind::Call(_, arguments) => arguments.iter().find_map(data_function),
    }
}

/// An initial state is known before anything is recorded.
fn initial_is_constant(state: &str, text: &str, names: &Names, faults: &mut Vec<Fault>) {
    let Ok(parsed) = expression::parse(text) else {
        return;
    };
    for (name, span) in parsed.names() {
        if !matches!(
            names.meaning(name),
            None | Some(Meaning::Constant(_) | Meaning::Parameter(_))
        ) {
            let message = format!(
                "column {}: '{name}' is not a parameter or constant; make a parameter with start = \"first({name})\" where the initial state is to be read off the data",
                span.start + 1
            );
            let pointer = format!("/states/{}/initial", escape(state));
            faults.push(Fault::new(pointer, "initial_depends_on_data", message));
        }
    }
}
