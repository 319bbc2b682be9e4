//! A document while it is edited: free names, what a name measures, what a quantity is called.

use super::edited::{Added, AddedRole};
use super::error::EditError;
use super::text::{names, replace};
use super::written::Edit;
use crate::flight::{Dimension, PhysicalQuantity, Unit};
use crate::model::document::{ModelDocument, Parameter, Per, Start, State};
use crate::model::expression::{self, Function};
use crate::model::names::Names;

pub(super) struct Sheet<'a> {
    pub edit: &'a Edit,
    pub document: ModelDocument,
    /// Parameters and inputs that the document did not have.
    pub added: Vec<Added>,
    pub inputs: Vec<String>,
}

impl<'a> Sheet<'a> {
    pub(super) fn new(edit: &'a Edit, document: &ModelDocument) -> Self {
        Self {
            edit,
            document: document.clone(),
            added: Vec::new(),
            inputs: Vec::new(),
        }
    }

    pub(super) fn target(&self) -> &'a str {
        &self.edit.target
    }

    /// The target as a part of names: `alpha+q` as `alpha_q`.
    pub(super) fn stem(&self) -> String {
        self.edit.target.replace('+', "_").replace(' ', "")
    }

    /// The name of the first parameter: what the edit says, or the base, numbered where it is taken.
    pub(super) fn name(&self, base: &str) -> Result<String, EditError> {
        match &self.edit.parameter {
            Some(name) if self.is_taken(name) => Err(EditError::NameTaken { name: name.clone() }),
            Some(name) => Ok(name.clone()),
            None => Ok(self.free(base)),
        }
    }

    /// A name that nothing has yet.
    pub(super) fn free(&self, base: &str) -> String {
        let numbered = (2..).map(|n| format!("{base}_{n}"));
        std::iter::once(base.to_string())
            .chain(numbered)
            .find(|name| !self.is_taken(name) && !self.document.outputs.contains_key(name))
            .unwrap_or_else(|| base.to_string())
    }

    pub(super) fn is_taken(&self, name: &str) -> bool {
        let document = &self.document;
        document.parameters.contains_key(name)
            || document.constants.contains_key(name)
            || document.inputs.contains_key(name)
            || document.states.contains_key(name)
            || document.definitions.contains_key(name)
            || name == "t"
            || name == "pi"
            || Function::find(name).is_some()
    }

    pub(super) fn add(&mut self, name: &str, role: AddedRole, parameter: Parameter) {
        self.document.parameters.insert(name.to_string(), parameter);
        self.note(name, role);
    }

    /// A parameter that is free now and was not.
    pub(super) fn note(&mut self, name: &str, role: AddedRole) {
        self.added.push(Added {
            name: name.to_string(),
            role,
        });
    }

    pub(super) fn add_state(
        &mut self,
        name: &str,
        unit: &str,
        initial: String,
        derivative: String,
        description: String,
    ) {
        let state = State {
            unit: unit.to_string(),
            initial,
            derivative,
            quantity: Some(PhysicalQuantity::Other),
            description,
        };
        self.document.states.insert(name.to_string(), state);
    }

    pub(super) fn no_target<'n>(
        &self,
        wanted: &'static str,
        target: &str,
        known: impl Iterator<Item = &'n String>,
    ) -> EditError {
        EditError::NoTarget {
            wanted,
            target: target.to_string(),
            known: known.cloned().collect(),
        }
    }

    pub(super) fn unfit(&self, message: impl Into<String>) -> EditError {
        EditError::Unfit {
            kind: self.edit.kind.name(),
            target: self.edit.target.clone(),
            message: message.into(),
        }
    }

    /// The equation of a state (its derivative) or of a definition, and what it measures.
    pub(super) fn law(&mut self, target: &str) -> Result<(&mut String, Dimension), EditError> {
        let known = (self.document.states.keys()).chain(self.document.definitions.keys());
        let missing = self.no_target("state or definition", target, known);
        let document = &mut self.document;
        if let Some(state) = document.states.get_mut(target) {
            let rate = dimension(&state.unit).over(Dimension::SECOND);
            Ok((&mut state.derivative, rate))
        } else if let Some(definition) = document.definitions.get_mut(target) {
            Ok((&mut definition.equation, dimension(&definition.unit)))
        } else {
            Err(missing)
        }
    }

    /// As [`Self::law`], or the equation of an output.
    pub(super) fn equation(&mut self, target: &str) -> Result<(&mut String, Dimension), EditError> {
        let document = &self.document;
        let is_law =
            document.states.contains_key(target) || document.definitions.contains_key(target);
        if is_law || !document.outputs.contains_key(target) {
            let known = (document.states.keys())
                .chain(document.definitions.keys())
                .chain(document.outputs.keys());
            let missing = self.no_target("state, definition or output", target, known);
            return self.law(target).map_err(|_| missing);
        }
        let output = &mut self.document.outputs[target];
        Ok((&mut output.equation, dimension(&output.unit)))
    }

    /// The unit of an input, state or definition.
    pub(super) fn unit_of(&self, name: &str) -> Option<String> {
        let document = &self.document;
        let unit = (document.inputs.get(name).map(|input| &input.unit))
            .or_else(|| document.states.get(name).map(|state| &state.unit))
            .or_else(|| document.definitions.get(name).map(|x| &x.unit));
        unit.cloned()
    }

    /// The unit of an input.
    pub(super) fn input(&self, target: &str) -> Result<String, EditError> {
        match self.document.inputs.get(target) {
            Some(input) => Ok(input.unit.clone()),
            None => Err(self.no_target("input", target, self.document.inputs.keys())),
        }
    }

    /// The dimension of a name that an equation may use.
    pub(super) fn measures(&self, name: &str) -> Option<Dimension> {
        Names::collect(&self.document, &mut Vec::new()).dimension(name)
    }

    /// An expression at the start of a segment, in parameters and constants: states are replaced by their
    /// initial values, definitions written out, inputs replaced by fixed parameters that read their first sample.
    /// Where that is too long, a free parameter of each maneuver that starts at the first sample of `channel`.
    pub(super) fn at_start(&mut self, text: &str, unit: &str, channel: &str) -> String {
        let mut firsts = Vec::new();
        let expanded = self.expanded(text, 0, &mut firsts);
        if let Some(expanded) = expanded.filter(|text| expression::parse(text).is_ok()) {
            for input in firsts {
                self.first_of(&input);
            }
            return expanded;
        }
        let name = self.free(&format!("{channel}_first"));
        let start = Start::FromData(format!("first({channel})"));
        let unknown = Parameter {
            start,
            per: Per::Maneuver,
            ..unknown(unit, 0.0, None, format!("{channel} at the start"))
        };
        self.add(&name, AddedRole::Reference, unknown);
        name
    }

    fn expanded(&self, text: &str, depth: usize, firsts: &mut Vec<String>) -> Option<String> {
        if depth > 24 {
            return None;
        }
        let mut by = Vec::new();
        for name in names(text) {
            let document = &self.document;
            let put = if name == "t" {
                "0".to_string()
            } else if let Some(state) = document.states.get(&name) {
                format!("({})", state.initial)
            } else if let Some(definition) = document.definitions.get(&name) {
                format!(
                    "({})",
                    self.expanded(&definition.equation, depth + 1, firsts)?
                )
            } else if document.inputs.contains_key(&name) {
                if !firsts.contains(&name) {
                    firsts.push(name.clone());
                }
                self.name_of_first(&name)
            } else {
                continue;
            };
            by.push((name, put));
        }
        let put = |name: &str| {
            let found = by.iter().find(|(replaced, _)| replaced == name);
            found.map(|(_, put)| put.clone())
        };
        let expanded = replace(text, put);
        (expanded.len() < expression::LONGEST / 2).then_some(expanded)
    }

    /// The fixed parameter that is an input's first sample, in each maneuver.
    pub(super) fn first_of(&mut self, input: &str) -> String {
        let name = self.name_of_first(input);
        if !self.document.parameters.contains_key(&name) {
            let unit = (self.document.inputs.get(input)).map_or("", |input| &input.unit);
            let parameter = Parameter {
                start: Start::FromData(format!("first({input})")),
                fixed: true,
                per: Per::Maneuver,
                ..unknown(unit, 0.0, None, format!("{input} at the start"))
            };
            self.add(&name, AddedRole::Reference, parameter);
        }
        name
    }

    fn name_of_first(&self, input: &str) -> String {
        let start = Start::FromData(format!("first({input})"));
        let mut parameters = self.document.parameters.iter();
        let there = parameters.find(|(_, p)| p.start == start && p.fixed && p.per == Per::Maneuver);
        there.map_or_else(
            || self.free(&format!("{input}_first")),
            |(name, _)| name.clone(),
        )
    }
}

/// A free parameter.
pub(super) fn unknown(
    unit: impl Into<String>,
    start: f64,
    bounds: Option<(f64, f64)>,
    description: String,
) -> Parameter {
    Parameter {
        unit: unit.into(),
        start: Start::Value(start),
        lower: bounds.map(|(lower, _)| lower),
        upper: bounds.map(|(_, upper)| upper),
        fixed: false,
        per: Per::Job,
        only_in: Vec::new(),
        prior: None,
        quantity: None,
        description,
    }
}

pub(super) fn dimension(unit: &str) -> Dimension {
    Unit::parse(unit).map_or(Dimension::NONE, |unit| unit.dimension)
}

/// The unit of a difference: a temperature in degC differs by kelvins.
pub(super) fn of_a_difference(unit: &str) -> String {
    match Unit::parse(unit) {
        Ok(parsed) if parsed.offset != 0.0 => parsed.dimension.to_string(),
        _ => unit.to_string(),
    }
}

pub(super) fn per_second(unit: &str) -> String {
    dimension(unit).over(Dimension::SECOND).to_string()
}
