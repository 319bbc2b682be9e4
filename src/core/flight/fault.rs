//! What is wrong with something sent in, said so that it can be put right.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// One fault of a recording, a model document or a job: where, a stable word, and a sentence with the remedy.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Fault {
    /// Where. In JSON an RFC 6901 pointer; in CSV `/columns/<name, or number from 1>`,
    /// `/rows/<data row from 1>/<column name>` or `/rows/<data row from 1>`. Empty: the whole.
    #[schema(example = "/model/states/q/derivative")]
    pub pointer: String,
    /// A stable word for programs; it never changes its meaning.
    #[schema(example = "unit_mismatch")]
    #[schema(value_type = String)]
    pub code: Cow<'static, str>,
    /// A sentence for people: what is wrong, and what would put it right.
    #[schema(example = "column 9: cannot add rad/s and rad")]
    pub message: String,
}

impl Fault {
    /// A fault at `pointer`, in the words of [`Self::code`] and [`Self::message`].
    pub fn new(pointer: impl Into<String>, code: &'static str, message: impl Into<String>) -> Self {
        Self {
            pointer: pointer.into(),
            code: Cow::Borrowed(code),
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

/// One step of a JSON pointer (RFC 6901).
pub fn escape(name: &str) -> String {
    name.replace('~', "~0").replace('/', "~1")
}
