//! The catalogue: every candidate that makes sense for a model and what was recorded with it.
//!
//! What a candidate is made for is told by what quantities are, not by what they are called.

mod aerodynamics;
mod axes;
mod clocks;
mod disturbances;
mod fixed;
mod ingredients;
mod inputs;
mod monomials;
mod ranges;
mod recorded;
mod sensors;
mod subject;
mod taken;
mod terms;
#[cfg(test)]
mod tests;
mod variables;

pub(super) use ingredients::{Draft, Ingredients};
pub use taken::TakenFor;
pub(super) use taken::taken_for;

use super::case::Case;
use super::effect::Effect;
use crate::model::Model;
use subject::Subject;

/// Candidates for a model, in the order of the catalogue: what the model holds fixed, instruments, then aerodynamics.
pub fn candidates(case: &Case, model: &Model) -> Vec<Effect> {
    let subject = Subject::new(case, &model.document);
    let mut effects = fixed::candidates(&subject);
    effects.extend(sensors::candidates(&subject));
    effects.extend(axes::candidates(&subject));
    effects.extend(clocks::candidates(&subject));
    effects.extend(inputs::candidates(&subject));
    effects.extend(terms::candidates(&subject));
    effects.extend(aerodynamics::candidates(&subject));
    effects.extend(disturbances::candidates(&subject));
    ranges::bound(&subject, &mut effects);
    case.knowledge.apply(&mut effects);
    effects.extend(case.candidates.iter().cloned());
    effects
}
