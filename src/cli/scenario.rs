//! What the file of a scenario names beside itself: a model, and recordings of its inputs.

use std::path::{Path, PathBuf};

use super::Failure;
use super::document::document;
use crate::ingest::{self, Format, Limits};
use crate::model::ModelDocument;
use crate::simulate::Scenario;

/// The model that takes the place of the scenario's, or the scenario's, which may be a document beside its file.
pub(super) fn model_of(
    scenario: &Scenario,
    file: &Path,
    instead: Option<&str>,
) -> Result<ModelDocument, Failure> {
    match instead {
        Some(name) => document(name, None),
        None => document(&scenario.model, file.parent()),
    }
}

/// Reads the inputs that are recorded in files beside that of the scenario.
pub(super) fn read_inputs(scenario: &mut Scenario, file: &Path) -> Result<(), Failure> {
    let beside = file.parent();
    let read = |named: &str| {
        let in_directory = |directory: &Path| directory.join(named);
        let recording = beside.map_or_else(|| PathBuf::from(named), in_directory);
        let unread = |why: String| format!("{}: {why}", recording.display());
        let bytes = std::fs::read(&recording).map_err(|e| unread(e.to_string()))?;
        ingest::read(&bytes, Format::Csv, &Limits::default()).map_err(|e| unread(e.to_string()))
    };
    let unfit = |error: crate::simulate::ScenarioError| {
        Failure::new(format!("{}: {error}", file.display()))
    };
    scenario.read_recorded(read).map_err(unfit)
}
