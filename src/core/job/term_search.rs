//! What a structure is chosen from: terms over the samples of a job, by name and dimension.

use crate::flight::Dimension;
use crate::structure::{Candidates, StructureOptions};

/// The terms of a structure determination, and what they are to explain.
#[derive(Clone, Debug)]
pub struct TermSearch {
    /// As they were asked for.
    pub options: StructureOptions,
    /// Over the samples of all segments that have a value of the output, one after the other.
    pub candidates: Candidates,
    /// By column: what the term measures.
    pub(super) dimensions: Vec<Dimension>,
    /// Terms that are no numbers somewhere, or the same everywhere.
    pub(super) left_out: Vec<String>,
    /// The output, by index.
    pub(super) output: usize,
}
