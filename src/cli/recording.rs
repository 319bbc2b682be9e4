//! Files that a command reads, and what a recording is written in.

use std::path::Path;

use super::Failure;
use super::notes;
use crate::flight::{Finding, Maneuver};
use crate::ingest::{self, Format, IngestError, Limits, Mapping};

pub(super) fn read_bytes(file: &Path) -> Result<Vec<u8>, Failure> {
    std::fs::read(file).map_err(|error| Failure::new(format!("{}: {error}", file.display())))
}

pub(super) fn read_text(file: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(file)
        .map_err(|error| Failure::new(format!("{}: {error}", file.display())))
}

/// The format of a recording, by the end of its name; CSV if that says nothing.
pub(super) fn format_of(file: &Path) -> Format {
    let extension = file.extension().and_then(|extension| extension.to_str());
    extension
        .and_then(Format::from_extension)
        .unwrap_or(Format::Csv)
}

/// Reads a recording. What is odd about its file is said on the standard error.
pub(super) fn read_recording(file: &Path, mapping: Option<&Mapping>) -> Result<Maneuver, Failure> {
    let bytes = read_bytes(file)?;
    let read = ingest::read_recording(&bytes, format_of(file), None, mapping, &Limits::default());
    let reading = read.map_err(|error| refused(file, &error))?;
    say(file, &reading.findings);
    Ok(reading.maneuver)
}

fn say(file: &Path, findings: &[Finding]) {
    for line in notes::lines(findings) {
        eprintln!("{}: {line}", file.display());
    }
}

/// The faults of a file, and the draft of a mapping where that can mend them.
pub(super) fn refused(file: &Path, error: &IngestError) -> Failure {
    let faults = Failure::faults(&file.display().to_string(), error.faults());
    let draft = error
        .draft()
        .and_then(|draft| Mapping::from_json(draft).ok());
    match draft {
        None => faults,
        Some(draft) => Failure::new(format!(
            "{faults}\n\nThe draft of a mapping; put what is meant where it says \"?\", leave out what is not needed, save it as mapping.toml, and add --mapping mapping.toml:\n\n{}",
            draft.to_toml()
        )),
    }
}
