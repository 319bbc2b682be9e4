//! The models that come with Trimtab, each one a document with its source cited.

use super::ModelDocument;

/// Looks a catalog model up by its name.
pub fn find(name: &str) -> Option<ModelDocument> {
    all().into_iter().find(|document| document.name == name)
}

/// All catalog models, in the order of the list.
pub fn all() -> Vec<ModelDocument> {
    Vec::new()
}
