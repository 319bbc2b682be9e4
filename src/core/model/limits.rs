//! Bounds on a model document: a document from the network is hostile until proven otherwise.

use super::ModelDocument;
use crate::flight::Fault;

const MOST_STATES: usize = 64;
pub(crate) const MOST_INPUTS: usize = 64;
const MOST_OUTPUTS: usize = 64;
const MOST_PARAMETERS: usize = 512;
const MOST_DEFINITIONS: usize = 256;
const MOST_CONSTANTS: usize = 256;

pub(super) fn check(document: &ModelDocument) -> Vec<Fault> {
    let counts = [
        ("states", document.states.len(), MOST_STATES),
        ("inputs", document.inputs.len(), MOST_INPUTS),
        ("outputs", document.outputs.len(), MOST_OUTPUTS),
        ("parameters", document.parameters.len(), MOST_PARAMETERS),
        ("definitions", document.definitions.len(), MOST_DEFINITIONS),
        ("constants", document.constants.len(), MOST_CONSTANTS),
    ];
    let too_many = counts
        .into_iter()
        .filter(|&(_, count, most)| count > most)
        .map(|(what, count, most)| {
            let message = format!("{count} {what}; at most {most} are allowed");
            Fault::new(format!("/{what}"), "model_too_large", message)
        });
    too_many.collect()
}
