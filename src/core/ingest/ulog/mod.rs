//! Logs of PX4 (ULog, `.ulg`): topics with a time of their own each.
//!
//! The format is described at docs.px4.io, "ULog File Format". Crates that read it were weighed: none of them bounds its
//! memory by what the file has, and each is one author's work of few releases. A log that breaks off in a message, as at
//! the end of power, is read up to there; behind damage reading goes on at the next synchronisation message.

mod definition;
mod scan;

use super::{IngestError, Limits, mapping::Mapping, messages::Log, reading::Reading};

/// Reads a log as the mapping says, else as the bundled mapping `px4` does.
///
/// # Errors
/// It is damaged, or does not have what the mapping names.
pub(super) fn read(
    bytes: &[u8],
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    let tables = scan::tables(bytes, limits)?;
    Log::of(bytes, tables, limits).read(mapping, "px4")
}

#[cfg(test)]
mod tests;
