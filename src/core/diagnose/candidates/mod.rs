//! The catalogue: every candidate that makes sense for a model and what was recorded with it.
//!
//! What a candidate is made for is told by what quantities are, not by what they are called.

mod aerodynamics;
mod clocks;
mod disturbances;
mod fixed;
mod inputs;
mod knowledge;
mod monomials;
mod plausible;
mod recorded;
mod sensors;
mod terms;
#[cfg(test)]
mod tests;
mod variables;

pub use knowledge::{Knowledge, KnownSize};
pub use plausible::Plausible;
pub use recorded::TakenFor;
pub(super) use recorded::taken_for;

use super::case::Case;
use super::effect::Effect;
use crate::model::{Model, ModelDocument, Quantities};
use recorded::Channel;

/// What candidates are made from.
struct Subject<'c> {
    case: &'c Case,
    document: &'c ModelDocument,
    quantities: Quantities,
    /// Recorded channels that the model does not use.
    channels: Vec<Channel>,
}

/// Candidates for a model, in the order of the catalogue: what the model holds fixed, instruments, then aerodynamics.
pub fn candidates(case: &Case, model: &Model) -> Vec<Effect> {
    let document = &model.document;
    let quantities = Quantities::of(document);
    let subject = Subject {
        case,
        document,
        channels: recorded::channels(case, document, &quantities),
        quantities,
    };
    let mut effects = fixed::candidates(&subject);
    effects.extend(sensors::candidates(&subject));
    effects.extend(clocks::candidates(&subject));
    effects.extend(inputs::candidates(&subject));
    effects.extend(terms::candidates(&subject));
    effects.extend(aerodynamics::candidates(&subject));
    effects.extend(disturbances::candidates(&subject));
    plausible::bound(&subject, &mut effects);
    case.knowledge.apply(&mut effects);
    effects.extend(case.candidates.iter().cloned());
    effects
}
