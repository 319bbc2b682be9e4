//! What was taken for what.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::recorded::channels;
use crate::diagnose::case::Case;
use crate::flight::PhysicalQuantity;
use crate::model::{Quantities, Source};

/// What a quantity of the model, or a recorded channel, was taken for.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct TakenFor {
    /// An input, state, definition or output, or a recorded channel.
    #[schema(example = "AoA")]
    pub name: String,
    /// What it was taken for.
    pub quantity: PhysicalQuantity,
    /// How that is known.
    pub from: Source,
    /// Why, in words.
    #[schema(example = "by its name and unit")]
    pub reason: String,
}

/// What everything in the model and beside it was taken for.
pub(in crate::diagnose) fn taken_for(case: &Case) -> Vec<TakenFor> {
    let quantities = Quantities::of(&case.document);
    let mut all: Vec<TakenFor> = Vec::new();
    for (name, taken) in quantities.taken() {
        let said = TakenFor {
            name: name.to_string(),
            quantity: taken.quantity,
            from: taken.from,
            reason: taken.reason.clone(),
        };
        // a state and the output that measures it are often called alike
        if !all
            .iter()
            .any(|a| a.name == said.name && a.quantity == said.quantity)
        {
            all.push(said);
        }
    }
    for channel in channels(case, &case.document, &quantities) {
        let told = case.knowledge.quantities.contains_key(&channel.name);
        let (from, reason) = match told {
            true => (Source::Declared, "the job says so"),
            false => (Source::Guessed, "by its name and unit"),
        };
        all.push(TakenFor {
            name: channel.name,
            quantity: channel.quantity,
            from,
            reason: reason.to_string(),
        });
    }
    all
}
