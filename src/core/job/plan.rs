//! What a job comes to before it runs.

use super::event::Prepared;
use super::strict::Strict;
use super::term_search::TermSearch;
use crate::diagnose::Case;
use crate::estimate::{Problem, Validation};
use crate::model::ModelDocument;

/// A job whose model is compiled and whose data are resolved: nothing left that bad input could break.
pub struct Plan {
    /// The job in names and numbers, to be told before it runs.
    pub prepared: Prepared,
    /// The model as estimated: the declared one with the job's edits and parameter overrides in it.
    pub model: ModelDocument,
    /// Model, data and unknowns of the estimation.
    pub problem: Problem,
    /// By segment of the problem: the place of its maneuver in the spec.
    pub from: Vec<usize>,
    /// What is predicted with the estimate.
    pub validation: Vec<Validation>,
    /// Of a diagnosis: all that it is made from.
    pub case: Option<Case>,
    /// Of a structure determination: what terms are chosen from.
    pub terms: Option<TermSearch>,
    /// Which findings refuse the result.
    pub strict: Strict,
}
