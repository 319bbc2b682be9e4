//! Edits: an effect is a function from a model document to a model document with a parameter more,
//! whose zero is the model before.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::ModelDocument;

/// One edit. `kind` and `target` are the words of the effect catalogue.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Edit {
    pub kind: EditKind,
    /// An output for `sensor_*`, an input for `input_*`, a state (its equation) or a definition for `missing_term`.
    #[schema(example = "q")]
    pub target: String,
    /// The term of a `missing_term`, an expression: `alpha^2`, `de*abs(de)`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "alpha^2")]
    pub term: Option<String>,
    /// Name of the parameter that is added; absent: made from kind and target.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parameter: Option<String>,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum EditKind {
    /// y + b
    SensorBias,
    /// (1 + k) y
    SensorScale,
    /// y + d t
    SensorDrift,
    /// u + b
    InputBias,
    /// (1 + k) u
    InputScale,
    /// ψ term, added to an equation.
    MissingTerm,
}

#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum EditError {
    #[error("stub")]
    Stub,
}

impl Edit {
    /// # Errors
    /// The target is not in the model, the term cannot be read, or the parameter's name is taken.
    pub fn apply(&self, document: &ModelDocument) -> Result<ModelDocument, EditError> {
        let _ = document;
        Err(EditError::Stub)
    }
}
