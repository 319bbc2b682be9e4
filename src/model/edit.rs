//! Edits: an effect is a function from a model document to a model document with a parameter more,
//! whose zero is the model before.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::dimensions::measure;
use super::document::{ModelDocument, Parameter, Per, Start};
use super::expression::{self, SyntaxError};
use super::names::Names;
use crate::flight::{Dimension, Unit};

/// One edit. `kind` and `target` are the words of the effect catalogue.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Edit {
    pub kind: EditKind,
    /// An output for `sensor_*`, an input for `input_*`, a state (its equation), a definition or an
    /// output for `missing_term`.
    #[schema(example = "q")]
    pub target: String,
    /// The term of a `missing_term`, an expression: `alpha^2`, `de*abs(de)`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "alpha^2")]
    pub term: Option<String>,
    /// Name of the parameter that is added; absent: made from kind and target.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "Maa")]
    pub parameter: Option<String>,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum EditKind {
    /// y + b
    SensorBias,
    /// (1 + k) y
    SensorScale,
    /// y + d t, t from the start of the segment
    SensorDrift,
    /// u + b
    InputBias,
    /// (1 + k) u
    InputScale,
    /// u(t - τ)
    InputDelay,
    /// y(t - τ)
    SensorDelay,
    /// ψ term, added to an equation
    MissingTerm,
}

#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum EditError {
    #[error("the model has no {wanted} '{target}'; it has {}", list(known))]
    NoTarget {
        wanted: &'static str,
        target: String,
        known: Vec<String>,
    },
    #[error("the name '{name}' is taken; give the edit another \"parameter\"")]
    NameTaken { name: String },
    #[error("a missing_term needs its \"term\", such as \"alpha^2\"")]
    NoTerm,
    #[error("the term '{term}': {source}")]
    Syntax { term: String, source: SyntaxError },
    #[error("the term '{term}': {message}")]
    Units { term: String, message: String },
}

impl EditError {
    /// The stable word for it.
    pub fn code(&self) -> &'static str {
        match self {
            Self::NoTarget { .. } => "unknown_target",
            Self::NameTaken { .. } => "duplicate_name",
            Self::NoTerm => "missing_term_absent",
            Self::Syntax { .. } => "syntax_error",
            Self::Units { .. } => "unit_mismatch",
        }
    }
}

fn list(names: &[String]) -> String {
    if names.is_empty() {
        "none".to_string()
    } else {
        names.join(", ")
    }
}

impl Edit {
    /// The document with the effect in it: one parameter more, which starts at zero.
    ///
    /// # Errors
    /// The target is not in the model, the term cannot be read, or the parameter's name is taken.
    pub fn apply(&self, document: &ModelDocument) -> Result<ModelDocument, EditError> {
        let mut edited = document.clone();
        let name = self
            .parameter
            .clone()
            .unwrap_or_else(|| self.default_name(document));
        let taken = document.parameters.contains_key(&name)
            || document.constants.contains_key(&name)
            || document.inputs.contains_key(&name)
            || document.states.contains_key(&name)
            || document.definitions.contains_key(&name);
        if taken {
            return Err(EditError::NameTaken { name });
        }
        let unit = match self.kind {
            EditKind::SensorBias | EditKind::SensorScale | EditKind::SensorDrift => {
                let Some(output) = edited.outputs.get_mut(&self.target) else {
                    return Err(self.no_target("output", document.outputs.keys()));
                };
                let (equation, unit) = (&output.equation, &output.unit);
                let (equation, unit) = match self.kind {
                    EditKind::SensorBias => (format!("{equation} + {name}"), of_a_difference(unit)),
                    EditKind::SensorScale => {
                        (format!("(1 + {name})*({equation})"), "-".to_string())
                    }
                    _ => (format!("{equation} + {name}*t"), per_second(unit)),
                };
                output.equation = equation;
                unit
            }
            EditKind::InputBias | EditKind::InputScale => {
                let Some(input) = document.inputs.get(&self.target) else {
                    return Err(self.no_target("input", document.inputs.keys()));
                };
                let (text, unit) = match self.kind {
                    EditKind::InputBias => {
                        (format!("({} + {name})", self.target), input.unit.clone())
                    }
                    _ => (format!("((1 + {name})*{})", self.target), "-".to_string()),
                };
                edited.substitute(&self.target, &text);
                unit
            }
            EditKind::InputDelay => {
                let Some(input) = edited.inputs.get_mut(&self.target) else {
                    return Err(self.no_target("input", document.inputs.keys()));
                };
                later(&mut input.delay, &name)
            }
            EditKind::SensorDelay => {
                let Some(output) = edited.outputs.get_mut(&self.target) else {
                    return Err(self.no_target("output", document.outputs.keys()));
                };
                later(&mut output.delay, &name)
            }
            EditKind::MissingTerm => self.add_term(&mut edited, document, &name)?,
        };
        let parameter = Parameter {
            unit,
            start: Start::Value(0.0),
            lower: None,
            upper: None,
            fixed: false,
            per: Per::Job,
            prior: None,
            description: format!("{} of {}", self.kind.words(), self.target),
        };
        edited.parameters.insert(name, parameter);
        Ok(edited)
    }

    /// Adds ψ term to the target's equation; the answer is ψ's unit.
    fn add_term(
        &self,
        edited: &mut ModelDocument,
        document: &ModelDocument,
        name: &str,
    ) -> Result<String, EditError> {
        let term = self.term.as_deref().ok_or(EditError::NoTerm)?;
        let parsed = expression::parse(term).map_err(|source| EditError::Syntax {
            term: term.to_string(),
            source,
        })?;
        let names = Names::collect(document, &mut Vec::new());
        let measured = measure(&parsed, &|name| names.dimension(name)).map_err(|mismatch| {
            EditError::Units {
                term: term.to_string(),
                message: mismatch.message,
            }
        })?;
        let dimension =
            |unit: &str| Unit::parse(unit).map_or(Dimension::NONE, |unit| unit.dimension);
        let (equation, target) = if let Some(state) = edited.states.get_mut(&self.target) {
            (
                &mut state.derivative,
                dimension(&state.unit).over(Dimension::SECOND),
            )
        } else if let Some(definition) = edited.definitions.get_mut(&self.target) {
            (&mut definition.equation, dimension(&definition.unit))
        } else if let Some(output) = edited.outputs.get_mut(&self.target) {
            (&mut output.equation, dimension(&output.unit))
        } else {
            let known = document
                .states
                .keys()
                .chain(document.definitions.keys())
                .chain(document.outputs.keys());
            return Err(self.no_target("state, definition or output", known));
        };
        *equation = format!("{equation} + {name}*({parsed})");
        Ok(target.over(measured.unwrap_or(Dimension::NONE)).to_string())
    }

    fn default_name(&self, document: &ModelDocument) -> String {
        let base = match self.kind {
            EditKind::SensorBias | EditKind::InputBias => format!("{}_bias", self.target),
            EditKind::SensorScale | EditKind::InputScale => format!("{}_scale", self.target),
            EditKind::SensorDrift => format!("{}_drift", self.target),
            EditKind::InputDelay | EditKind::SensorDelay => format!("{}_delay", self.target),
            EditKind::MissingTerm => format!("{}_term", self.target),
        };
        let numbered = (2..).map(|n| format!("{base}_{n}"));
        let free = std::iter::once(base.clone())
            .chain(numbered)
            .find(|name| !document.parameters.contains_key(name));
        free.unwrap_or(base)
    }

    fn no_target<'a>(
        &self,
        wanted: &'static str,
        known: impl Iterator<Item = &'a String>,
    ) -> EditError {
        EditError::NoTarget {
            wanted,
            target: self.target.clone(),
            known: known.cloned().collect(),
        }
    }
}

impl ModelDocument {
    /// Puts a text in the place of a name in all equations but those of initial states.
    pub fn substitute(&mut self, name: &str, by: &str) {
        for equation in equations(self) {
            *equation = replace_name(equation, name, by);
        }
    }
}

impl EditKind {
    fn words(self) -> &'static str {
        match self {
            Self::SensorBias | Self::InputBias => "bias",
            Self::SensorScale | Self::InputScale => "scale factor, less one,",
            Self::SensorDrift => "drift",
            Self::InputDelay | Self::SensorDelay => "time delay",
            Self::MissingTerm => "missing term",
        }
    }
}

/// Adds a parameter to a delay; the answer is its unit.
fn later(delay: &mut Option<String>, name: &str) -> String {
    *delay = Some(match delay {
        Some(before) => format!("{before} + {name}"),
        None => name.to_string(),
    });
    "s".to_string()
}

/// The unit of a difference: a temperature in degC differs by kelvins.
fn of_a_difference(unit: &str) -> String {
    match Unit::parse(unit) {
        Ok(parsed) if parsed.offset != 0.0 => parsed.dimension.to_string(),
        _ => unit.to_string(),
    }
}

fn per_second(unit: &str) -> String {
    Unit::parse(unit)
        .map_or(Dimension::NONE, |unit| unit.dimension)
        .over(Dimension::SECOND)
        .to_string()
}

fn equations(document: &mut ModelDocument) -> impl Iterator<Item = &mut String> {
    let definitions = document
        .definitions
        .values_mut()
        .map(|definition| &mut definition.equation);
    let states = document
        .states
        .values_mut()
        .map(|state| &mut state.derivative);
    let outputs = document
        .outputs
        .values_mut()
        .map(|output| &mut output.equation);
    definitions.chain(states).chain(outputs)
}

/// The text with a name replaced wherever it stands; the rest stays as it was written.
fn replace_name(text: &str, name: &str, by: &str) -> String {
    // an equation that cannot be read is left alone: compiling says what is wrong with it
    let Ok(parsed) = expression::parse(text) else {
        return text.to_string();
    };
    let mut replaced = String::new();
    let mut from = 0;
    for (_, span) in parsed
        .names()
        .into_iter()
        .filter(|&(found, _)| found == name)
    {
        replaced.push_str(&text[from..span.start]);
        replaced.push_str(by);
        from = span.end;
    }
    replaced.push_str(&text[from..]);
    replaced
}
