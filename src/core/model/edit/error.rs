//! Why an edit cannot be made.

use crate::model::expression::SyntaxError;

/// Why an edit does not fit a document.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum EditError {
    /// A field of the edit is too long.
    #[error("\"{field}\" has {length} bytes, at most {most} are allowed")]
    TooLong {
        /// Its name.
        field: &'static str,
        /// Its length, bytes.
        length: usize,
        /// The most that is allowed, bytes.
        most: usize,
    },
    /// The model has nothing of the target's name that the kind can act on.
    #[error("the model has no {wanted} '{target}'; it has {}", list(known))]
    NoTarget {
        /// What the kind acts on: an output, an input, ...
        wanted: &'static str,
        /// The name.
        target: String,
        /// What the model has of the kind wanted.
        known: Vec<String>,
    },
    /// The parameter, state or input to be added has a name that the model uses.
    #[error("the name '{name}' is taken; give the edit another \"parameter\"")]
    NameTaken {
        /// The name.
        name: String,
    },
    /// The kind needs a term, and the edit has none.
    #[error("{kind} needs its \"term\": {wanted}")]
    NoTerm {
        /// The kind's name.
        kind: &'static str,
        /// What the term must be.
        wanted: &'static str,
    },
    /// The term is none that the kind knows, or the model has not what it names.
    #[error("the term '{term:.80}': {message}")]
    BadTerm {
        /// The term.
        term: String,
        /// What is wrong with it.
        message: String,
    },
    /// The term is no expression.
    #[error("the term '{term:.80}': {source}")]
    Syntax {
        /// The term.
        term: String,
        /// What is wrong, and where.
        source: SyntaxError,
    },
    /// The units in the term do not agree.
    #[error("the term '{term:.80}': {message}")]
    Units {
        /// The term.
        term: String,
        /// Which units they are.
        message: String,
    },
    /// The document has the target, but not what the effect acts through.
    #[error("{kind} of '{target}': {message}")]
    Unfit {
        /// The kind's name.
        kind: &'static str,
        /// The target.
        target: String,
        /// What is lacking.
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
