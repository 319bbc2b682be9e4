//! The model that a command names: a document in a file, or one of the catalog.

use std::path::{Path, PathBuf};

use super::Failure;
use super::recording::read_text;
use crate::model::{ModelDocument, catalog};

/// The document of a file (.toml, .json), a relative one in `directory`, or else of the catalog.
pub(super) fn document(name: &str, directory: Option<&Path>) -> Result<ModelDocument, Failure> {
    let in_directory = |directory: &Path| directory.join(name);
    let file = directory.map_or_else(|| PathBuf::from(name), in_directory);
    match in_file(&file)? {
        Some(document) => Ok(document),
        None => catalog::find(name).ok_or_else(|| unknown(name)),
    }
}

/// The document of a file; none where its name does not end as that of one.
pub(super) fn in_file(file: &Path) -> Result<Option<ModelDocument>, Failure> {
    let unread = |why: String| Failure::new(format!("{}: {why}", file.display()));
    match file.extension().and_then(|extension| extension.to_str()) {
        Some("toml") => toml::from_str(&read_text(file)?).map_err(|e| unread(e.to_string())),
        Some("json") => serde_json::from_str(&read_text(file)?).map_err(|e| unread(e.to_string())),
        _ => Ok(None),
    }
}

fn unknown(name: &str) -> Failure {
    let known: Vec<String> = catalog::all()
        .into_iter()
        .map(|document| document.name)
        .collect();
    Failure::new(format!(
        "there is no catalog model '{name}'; the catalog has {}; or give a model document (.toml, .json)",
        known.join(", ")
    ))
}
