//! What is known of the quantities of a document.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::flight::PhysicalQuantity;

/// How it is known what a quantity is.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// The model document or the job says so.
    Declared,
    /// By its name and unit, or by the equations.
    Guessed,
}

/// What something was taken for.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Taken {
    /// Which quantity it is.
    pub quantity: PhysicalQuantity,
    /// Whether it is declared or guessed.
    pub from: Source,
    /// Why, in words.
    #[schema(example = "alpha is recorded as it")]
    pub reason: String,
}

/// What each name of a document is, as far as it is known.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Quantities {
    /// Inputs, states, definitions, and of parameters and constants the winds and steady values.
    pub(super) named: IndexMap<String, Taken>,
    pub(super) outputs: IndexMap<String, Taken>,
}

impl Quantities {
    /// What a name in equations is.
    pub fn get(&self, name: &str) -> Option<PhysicalQuantity> {
        self.named.get(name).map(|taken| taken.quantity)
    }

    /// What an output measures.
    pub fn output(&self, name: &str) -> Option<PhysicalQuantity> {
        self.outputs.get(name).map(|taken| taken.quantity)
    }

    /// Names in equations that are a quantity, in the order of the document: inputs, states, definitions, then what is held.
    pub fn all_of(&self, quantity: PhysicalQuantity) -> impl Iterator<Item = &str> {
        let is = move |(_, taken): &(&String, &Taken)| taken.quantity == quantity;
        self.named.iter().filter(is).map(|(name, _)| name.as_str())
    }

    /// Outputs that record a quantity.
    pub fn outputs_of(&self, quantity: PhysicalQuantity) -> impl Iterator<Item = &str> {
        let is = move |(_, taken): &(&String, &Taken)| taken.quantity == quantity;
        (self.outputs.iter().filter(is)).map(|(name, _)| name.as_str())
    }

    /// Everything that was taken for something, names in equations before outputs.
    pub fn taken(&self) -> impl Iterator<Item = (&str, &Taken)> {
        let all = self.named.iter().chain(&self.outputs);
        all.map(|(name, taken)| (name.as_str(), taken))
    }

    /// A guess by the name does not stand against the equation of a mode.
    pub(super) fn note_elastic(&mut self, name: &str) {
        if (self.named.get(name)).is_some_and(|taken| taken.from == Source::Guessed) {
            self.named.shift_remove(name);
        }
        self.note(name, PhysicalQuantity::Structural, || {
            "its equation is that of a mode of the structure".to_string()
        });
    }

    /// What is known already stays.
    pub(super) fn note(
        &mut self,
        name: &str,
        quantity: PhysicalQuantity,
        reason: impl FnOnce() -> String,
    ) {
        if !self.named.contains_key(name) {
            self.named
                .insert(name.to_string(), guess(quantity, reason()));
        }
    }

    pub(super) fn note_output(
        &mut self,
        name: &str,
        quantity: PhysicalQuantity,
        reason: impl FnOnce() -> String,
    ) {
        if !self.outputs.contains_key(name) {
            self.outputs
                .insert(name.to_string(), guess(quantity, reason()));
        }
    }
}

fn guess(quantity: PhysicalQuantity, reason: String) -> Taken {
    Taken {
        quantity,
        from: Source::Guessed,
        reason,
    }
}
