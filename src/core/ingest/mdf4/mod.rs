//! MDF 4 files (ASAM), as Vector's tools, asammdf and many loggers write them: groups of channels that say their units, each
//! group with its times in a master channel.
//!
//! The layout of the format is described in "ASAM MDF 4.1". The crates `mdf4-rs` and `mf4-rs` were weighed: of 19,000 lines
//! each, most are for buses, writing and other languages, and both make room for a block as long as a file says it is before
//! they look whether it is there.
//!
//! Records are read from where they stand; packed ones are unpacked within the limits. Linear, rational and tabular
//! conversions are applied; a number that stands for a text remains the number.

mod block;
mod conversion;
mod damage;
mod data;
mod field;
mod samples;
mod scan;

use super::{IngestError, Limits, groups, mapping::Mapping, reading::Reading};

/// Reads all channels; or those that a mapping names, as it says.
///
/// # Errors
/// It is damaged, or does not have what the mapping names.
pub(super) fn read(
    bytes: &[u8],
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    groups::read(scan::scan(bytes, limits)?, mapping, limits)
}
