//! What is wrong with a request, said so that it can be put right.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// One fault: where, a stable word, and a sentence with the remedy.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Fault {
    /// JSON pointer into the request.
    #[schema(example = "/model/states/q/derivative")]
    pub pointer: String,
    #[schema(example = "unit_mismatch")]
    pub code: String,
    #[schema(example = "column 9: cannot add rad/s and rad")]
    pub message: String,
}

impl Fault {
    pub fn new(pointer: impl Into<String>, code: &str, message: impl Into<String>) -> Self {
        Self {
            pointer: pointer.into(),
            code: code.to_string(),
            message: message.into(),
        }
    }

    /// The same fault in a document that stands at `prefix` of another.
    #[must_use]
    pub fn under(mut self, prefix: &str) -> Self {
        self.pointer.insert_str(0, prefix);
        self
    }
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.pointer.is_empty() {
            write!(f, "{}", self.message)
        } else {
            write!(f, "{}: {}", self.pointer, self.message)
        }
    }
}
