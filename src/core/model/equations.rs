//! The equations of a document, parsed, with their names and units checked.

use indexmap::IndexMap;

use super::dimensions::measure;
use super::document::ModelDocument;
use super::element::Element;
use super::expression::{self, Expression, Function, Kind, Span};
use super::names::{Meaning, Names};
use super::paths::PathElement;
use crate::flight::{Dimension, Fault, Unit, escape};

/// The parsed and checked equations of a document, in its order.
pub(super) struct Equations {
    pub definitions: Vec<Expression>,
    pub initial: Vec<Expression>,
    pub dynamics: Vec<Expression>,
    pub observation: Vec<Expression>,
    /// Sizes of the elements that inputs and outputs pass, in the order of [`super::Paths`].
    pub input_paths: Vec<(PathElement, Expression)>,
    pub output_paths: Vec<(PathElement, Expression)>,
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
        let input_paths = document.inputs.iter().map(|(name, i)| Signal {
            pointer: format!("/inputs/{}", escape(name)),
            unit: &i.unit,
            path: i.path(),
        });
        let input_paths = sizes(input_paths, names, faults);
        let output_paths = document.outputs.iter().map(|(name, o)| Signal {
            pointer: format!("/outputs/{}", escape(name)),
            unit: &o.unit,
            path: o.path(),
        });
        let output_paths = sizes(output_paths, names, faults);
        for (name, state) in &document.states {
            let pointer = format!("/states/{}/initial", escape(name));
            let remedy = "make a parameter with start = \"first(<channel>)\" where the initial state is to be read off the data";
            let code = "initial_depends_on_data";
            depends_on_parameters_only(&pointer, &state.initial, names, (code, remedy), faults);
        }
        Self {
            definitions,
            initial,
            dynamics,
            observation,
            input_paths,
            output_paths,
        }
    }
}

/// An input or output with its path.
struct Signal<'d> {
    pointer: String,
    unit: &'d str,
    path: Vec<(Element, &'d str)>,
}

/// Reads the sizes of the elements of all paths.
fn sizes<'d>(
    signals: impl Iterator<Item = Signal<'d>>,
    names: &Names,
    faults: &mut Vec<Fault>,
) -> Vec<(PathElement, Expression)> {
    let mut sizes = Vec::new();
    for (index, signal) in signals.enumerate() {
        let unit = Unit::parse(signal.unit).ok();
        for (element, text) in signal.path {
            let pointer = format!("{}/{}", signal.pointer, element.field());
            let wanted = unit.map(|unit| element.measures(unit.dimension));
            let shown = wanted.map_or(String::new(), |wanted| wanted.to_string());
            let size = read_equation(&pointer, text, &shown, wanted, names, faults);
            let remedy = format!("a {} is the same all along a maneuver", element.words());
            let fault = (element.depends_on_data(), remedy.as_str());
            depends_on_parameters_only(&pointer, text, names, fault, faults);
            let at = PathElement {
                signal: index,
                element,
            };
            sizes.push((at, size));
        }
    }
    sizes
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

/// An initial state and the size of an element are known before anything is recorded.
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
