//! What a file is written from.

use crate::model::Model;

/// A model, its parameters as numbers, and what stands at the head of the file.
pub(super) struct Written<'m> {
    pub model: &'m Model,
    /// SI
    pub parameters: &'m [f64],
    /// A line each.
    pub notes: Vec<String>,
}
