//! The equations of a document, parsed, with their names and units checked.

use indexmap::IndexMap;

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
    /// Delays of inputs and of outputs, by index of what is delayed.
    pub input_delays: Vec<(usize, Expression)>,
    pub output_delays: Vec<(usize, Expression)>,
}

impl Equations {
    pub(super) fn read(document: &ModelDocument, names: &Names, faults: &mut Vec<Fault>) -> Self {
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
        let delay = |list: &str, name: &str| format!("/{list}/{}/delay", escape(name));
        let mut delays = |list: &str, all: &mut dyn Iterator<Item = (&String, &Option<String>)>| {
            let delayed = |(i, (name, text)): (usize, (&String, &Option<String>))| {
                let pointer = delay(list, name);
                let text = text.as_deref()?;
                Some((i, read(pointer, text, "s", Some(Dimension::SECOND))))
            };
            all.enumerate().filter_map(delayed).collect()
        };
        let mut inputs = document.inputs.iter().map(|(name, i)| (name, &i.delay));
        let input_delays = delays("inputs", &mut inputs);
        let mut outputs = document.outputs.iter().map(|(name, o)| (name, &o.delay));
        let output_delays = delays("outputs", &mut outputs);
        for (name, state) in &document.states {
            let pointer = format!("/states/{}/initial", escape(name));
            let remedy = "make a parameter with start = \"first(<channel>)\" where the initial state is to be read off the data";
            let code = "initial_depends_on_data";
            depends_on_parameters_only(&pointer, &state.initial, names, (code, remedy), faults);
        }
        let inputs = document.inputs.iter().map(|(n, i)| ("inputs", n, &i.delay));
        let outputs = document
            .outputs
            .iter()
            .map(|(n, o)| ("outputs", n, &o.delay));
        for (list, name, text) in inputs.chain(outputs) {
            if let Some(text) = text {
                let remedy = "a delay is the same all along a maneuver";
                let code = "delay_depends_on_data";
                depends_on_parameters_only(&delay(list, name), text, names, (code, remedy), faults);
            }
        }
        Self {
            definitions,
            initial,
            dynamics,
            observation,
            input_delays,
            output_delays,
        }
    }
}

/// Names that are told of one equation: each once, and no more than these.
const MOST_NAMES: usize = 20;

/// The first faults of a document come with a guess at what was meant: guessing takes the longest of all.
const MOST_GUESSES: usize = 20;

/// The names in the tree that are wrong, each where it stands first.
fn each_once(parsed: &Expression, is_wrong: impl Fn(&str) -> bool) -> IndexMap<&str, Span> {
    let mut wrong = IndexMap::new();
    for (name, span) in parsed.names() {
        if wrong.len() < MOST_NAMES && is_wrong(name) {
            wrong.entry(name).or_insert(span);
        }
    }
    wrong
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
    let zero = Expression {
        kind: Kind::Number(0.0),
        span: Span::default(),
    };
    let parsed = match expression::parse(text) {
        Ok(parsed) => parsed,
        Err(error) => {
            faults.push(Fault::new(pointer, "syntax_error", error.to_string()));
            return zero;
        }
    };
    let unknown = each_once(&parsed, |name| names.meaning(name).is_none());
    let all_known = unknown.is_empty();
    for (name, span) in unknown {
        let message = match faults.len() < MOST_GUESSES {
            true => names.unknown(name),
            false => Names::undefined(name),
        };
        let message = format!("column {}: {message}", span.start + 1);
        faults.push(Fault::new(pointer, "unknown_symbol", message));
    }
    let mut fault = |code, message: String| faults.push(Fault::new(pointer, code, message));
    if let Some(function) = data_function(&parsed) {
        let message = format!(
            "{}() looks at a recording and may stand only in a parameter's start, or where a job says how to make a channel",
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
        Kind::Call(function, _) if function.is_of_recordings() => Some(*function),
        Kind::Call(_, arguments) => arguments.iter().find_map(data_function),
    }
}

/// An initial state and a delay are known before anything is recorded.
fn depends_on_parameters_only(
    pointer: &str,
    text: &str,
    names: &Names,
    (code, remedy): (&'static str, &str),
    faults: &mut Vec<Fault>,
) {
    let Ok(parsed) = expression::parse(text) else {
        return;
    };
    let is_wrong = |name: &str| {
        let fit = matches!(
            names.meaning(name),
            None | Some(Meaning::Constant(_) | Meaning::Parameter(_))
        );
        !fit
    };
    for (name, span) in each_once(&parsed, is_wrong) {
        let place = span.start + 1;
        let message = format!("column {place}: '{name}' is not a parameter or constant; {remedy}");
        faults.push(Fault::new(pointer, code, message));
    }
}
