//! Files that a command reads, and what a recording is written in.

use std::path::Path;

use super::Failure;
use crate::ingest::Format;

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
