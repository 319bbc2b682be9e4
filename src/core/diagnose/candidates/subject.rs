//! What candidates are made from: the model, what its quantities are, and what was recorded beside it.

use indexmap::IndexMap;

use super::recorded::{Channel, Movement, channels, movement};
use crate::diagnose::case::Case;
use crate::diagnose::effect::Effect;
use crate::model::expression::{self, Expression};
use crate::model::{Edit, Input, ModelDocument, Quantities};

pub(super) struct Subject<'c> {
    pub case: &'c Case,
    pub document: &'c ModelDocument,
    pub quantities: Quantities,
    /// Recorded channels that the model does not use.
    pub channels: Vec<Channel>,
}

impl<'c> Subject<'c> {
    pub(super) fn new(case: &'c Case, document: &'c ModelDocument) -> Self {
        let quantities = Quantities::of(document);
        Self {
            case,
            document,
            channels: channels(case, document, &quantities),
            quantities,
        }
    }

    /// Inputs that a sensor records of the motion: they come through no actuator.
    pub(super) fn measured_inputs(&self) -> Vec<&'c String> {
        let inputs = self.document.inputs.keys();
        inputs.filter(|name| self.is_measured(name)).collect()
    }

    pub(super) fn is_measured(&self, input: &str) -> bool {
        (self.quantities.get(input)).is_some_and(|quantity| quantity.is_motion())
    }

    /// All recorded channels as inputs of the model.
    pub(super) fn channel_inputs(&self) -> IndexMap<String, Input> {
        let all = self.channels.iter();
        all.map(|channel| (channel.name.clone(), channel.input.clone()))
            .collect()
    }

    /// The effect of an edit that the document takes, with the channels that it uses and no others.
    pub(super) fn fit(&self, mut edit: Edit) -> Option<Effect> {
        let edited = edit.apply(self.document).ok()?;
        edit.channels.retain(|name, _| edited.inputs.contains(name));
        Some(Effect::of(edit))
    }

    /// How a name in the model's equations moves, as far as it is recorded: as an input, by an output, or beside the model.
    pub(super) fn movement(&self, name: &str) -> Option<Movement> {
        if self.document.inputs.contains_key(name) {
            return movement(self.case, name);
        }
        let quantity = self.quantities.get(name)?;
        let output = self.quantities.outputs_of(quantity).next();
        let channel = || {
            let mut channels = self.channels.iter();
            channels.find(|channel| channel.quantity == quantity)
        };
        match output {
            Some(output) => movement(self.case, output),
            None => movement(self.case, name).or_else(|| channel().map(|c| c.movement)),
        }
    }

    /// Whether an expression keeps its value along a maneuver.
    pub(super) fn is_held(&self, expression: &Expression) -> bool {
        !expression
            .names()
            .iter()
            .any(|(name, _)| self.varies(name) || *name == "t")
    }

    pub(super) fn varies(&self, name: &str) -> bool {
        let document = self.document;
        document.inputs.contains_key(name)
            || document.states.contains_key(name)
            || document.definitions.contains_key(name)
    }

    /// Whether an equation would feed on itself with a name in it: a definition through others, a state by its own rate.
    pub(super) fn closes_a_circle(&self, name: &str, target: &str) -> bool {
        match self.document.definitions.contains_key(target) {
            true => self.depends(name, target),
            false => name == format!("{target}dot"),
        }
    }

    /// Whether a name depends on another, through definitions.
    pub(super) fn depends(&self, name: &str, on: &str) -> bool {
        let mut pending = vec![name.to_string()];
        let mut seen: Vec<String> = Vec::new();
        while let Some(found) = pending.pop() {
            if found == on {
                return true;
            }
            if seen.contains(&found) {
                continue;
            }
            if let Some(definition) = self.document.definitions.get(&found)
                && let Ok(parsed) = expression::parse(&definition.equation)
            {
                pending.extend(parsed.names().into_iter().map(|(name, _)| name.to_string()));
            }
            seen.push(found);
        }
        false
    }
}
