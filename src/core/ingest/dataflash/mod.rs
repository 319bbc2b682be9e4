//! Logs of ArduPilot (DataFlash, `.bin`, and `.log` as text): kinds of messages, each of which the log defines itself.
//!
//! The format is that of AP_Logger (ardupilot.org, "Onboard Message Log Messages"; its messages FMT, FMTU, UNIT and MULT).
//! No crate was found that is kept, bounded and light. Bytes that are no message are passed over, as other readers do.

mod definition;
mod scan;
mod text;

pub(super) use text::is_text;

use super::{IngestError, Limits, mapping::Mapping, messages::Log, reading::Reading};

/// Reads a log as the mapping says, else as the bundled mapping `ardupilot` does.
///
/// # Errors
/// It is damaged, or does not have what the mapping names.
pub(super) fn read(
    bytes: &[u8],
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    if !text::is_text(bytes) {
        let tables = scan::tables(bytes)?;
        return Log::of(bytes, tables, limits).read(mapping, "ardupilot");
    }
    let (bytes, mut findings) = text::binary(bytes, limits)?;
    let tables = scan::tables(&bytes).map_err(|_| text::has_nothing())?;
    let mut reading = Log::of(&bytes, tables, limits).read(mapping, "ardupilot")?;
    reading.findings.append(&mut findings);
    Ok(reading)
}

#[cfg(test)]
mod tests;
