//! Why an edit cannot be made.

use crate::model::expression::SyntaxError;

#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum EditError {
    #[error("\"{field}\" has {length} bytes, at most {most} are allowed")]
    TooLong {
        field: &'static str,
        length: usize,
        most: usize,
    },
    #[error("the model has no {wanted} '{target}'; it has {}", list(known))]
    NoTarget {
        wanted: &'static str,
        target: String,
        known: Vec<String>,
    },
    #[error("the name '{name}' is taken; give the edit another \"parameter\"")]
    NameTaken { name: String },
    #[error("{kind} needs its \"term\": {wanted}")]
    NoTerm {
        kind: &'static str,
        wanted: &'static str,
    },
    #[error("the term '{term:.80}': {message}")]
    BadTerm { term: String, message: String },
    #[error("the term '{term:.80}': {source}")]
    Syntax { term: String, source: SyntaxError },
    #[error("the term '{term:.80}': {message}")]
    Units { term: String, message: String },
    /// The document has the target, but not what the effect acts through.
    #[error("{kind} of '{target}': {message}")]
    Unfit {
        kind: &'static str,
        target: String,
        message: String,
    },
}

impl EditError {
    /// The stable word for it.
    pub fn code(&self) -> &'static str {
        match self {
            Self::TooLong { .. } => "too_long",
            Self::NoTarget { .. } => "unknown_target",
            Self::NameTaken { .. } => "duplicate_name",
            Self::NoTerm { .. } => "missing_term_absent",
            Self::BadTerm { .. } => "bad_term",
            Self::Syntax { .. } => "syntax_error",
            Self::Units { .. } => "unit_mismatch",
            Self::Unfit { .. } => "unfit_target",
        }
    }
}

fn list(names: &[String]) -> String {
    if names.is_empty() {
        "none".to_string()
    } else {
        names.join(", ")
    }
}
