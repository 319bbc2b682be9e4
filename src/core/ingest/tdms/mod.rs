//! TDMS files of LabVIEW and DIAdem: groups of channels, which say units and times themselves.
//!
//! The format is described in National Instruments' "TDMS File Format Internal Structure". The crates `tdms` and `tdms-rs`
//! were weighed: both read a file by its path, and make room for a text as long as the file says it is, up to 4 GB, before they
//! look whether it is there. A file that breaks off is read up to there.
//!
//! A channel has the times that its waveform properties say (`wf_increment`, `wf_start_offset`, `wf_start_time`), else those
//! of the channel of its group that is called time or has time stamps. Values of DAQmx are scaled as the file says.

mod damage;
mod groups;
mod layout;
mod object;
mod property;
mod samples;
mod scale;
mod scan;
mod stamp;

use super::{IngestError, Limits, groups::read as read_groups, mapping::Mapping, reading::Reading};

/// Reads all channels; or those that a mapping names, as it says.
///
/// # Errors
/// It is damaged, or does not have what the mapping names.
pub(super) fn read(
    bytes: &[u8],
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    let file = scan::scan(bytes, limits)?;
    read_groups(groups::of(file), mapping, limits)
}
