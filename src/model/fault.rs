//! What is wrong with a model document: where, a stable word, and a sentence with the remedy.

/// A fault in a model document.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{pointer}: {message}")]
pub struct ModelError {
    /// JSON pointer into the document, such as `/states/q/derivative`.
    pub pointer: String,
    /// A stable word, such as `unit_mismatch`.
    pub code: &'static str,
    pub message: String,
}

impl ModelError {
    pub(super) fn new(
        pointer: impl Into<String>,
        code: &'static str,
        message: impl Into<String>,
    ) -> Self {
        Self {
            pointer: pointer.into(),
            code,
            message: message.into(),
        }
    }
}

/// One step of a JSON pointer (RFC 6901).
pub(super) fn escape(name: &str) -> String {
    name.replace('~', "~0").replace('/', "~1")
}
