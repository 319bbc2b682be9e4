//! What a mapping calls a column: its title, or several that it has in different versions of a logger.

use std::fmt;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A title as it stands in the file, with or without its unit, in which `*` stands for anything; or a source such as
/// `(:,2)`. Of several the first that the file has is meant.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub(in super::super) enum Titles {
    One(String),
    AnyOf(Vec<String>),
}

impl Default for Titles {
    fn default() -> Self {
        Self::AnyOf(Vec::new())
    }
}

impl Titles {
    pub(in super::super) fn iter(&self) -> impl Iterator<Item = &str> {
        let all = match self {
            Self::One(title) => std::slice::from_ref(title),
            Self::AnyOf(titles) => titles.as_slice(),
        };
        all.iter().map(String::as_str)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.iter().all(|title| title.trim().is_empty())
    }
}

impl fmt::Display for Titles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all: Vec<&str> = self.iter().collect();
        f.write_str(&all.join(" | "))
    }
}

/// A number or a word that stands for no value.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub(in super::super) enum NoValue {
    Number(f64),
    Word(String),
}
