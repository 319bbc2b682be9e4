//! Files to maneuvers: the bytes of a recording in, a [`Maneuver`] or a list of all its faults out.
//!
//! A recording comes from a stranger. Whatever its bytes are, [`read`] answers with a maneuver or with
//! [`IngestError`], whose faults each name the place (a column, a row, a JSON pointer) and the remedy.
//! Its memory is bounded by [`Limits`] *before* it is used: every format is surveyed in one cheap pass
//! before anything is built from it.
//!
//! Tables of text, workbooks, Parquet files and JSON say names and units themselves. MAT files and ASCII matrices do not: a [`Mapping`] says
//! them. It can do so for any table, too, where what the file says is not what is meant. [`inspect`] looks at one, and drafts
//! a mapping. Logs of PX4 and ArduPilot come with mappings of the quantities that most of them have. TDMS
//! and MDF say names, units and the times of every group of channels.
//!
//! Whatever a sender says that a file is, its first bytes are looked at first. What is packed with gzip or zip is unpacked.
//!
//! What is readable may still be poor: [`quality()`] finds gaps, missing values, stuck sensors and spikes,
//! and [`summary()`] is what a user sees of a maneuver without downloading it.
//!
//! Invariant: no bytes panic, and none use more memory than [`Limits`] allow.

mod ames;
mod ascii;
mod assemble;
mod axis;
pub mod bundled;
mod cell;
mod columns;
mod contents;
mod csv;
mod csv_writer;
mod cursor;
mod dataflash;
mod encoding;
mod export;
mod fault;
mod flysight;
mod format;
mod groups;
mod hdf5;
mod join;
mod json;
mod label;
mod limits;
mod lines;
mod mapping;
mod mat;
mod matrix;
mod mdf4;
mod messages;
mod name;
mod note;
mod octave;
mod origin;
mod packed;
mod parquet;
mod quick;
mod reading;
mod recognition;
mod recording;
mod stamp;
mod stored;
mod summary;
mod tdms;
mod text;
mod time_range;
mod ulog;
mod union;
mod units;
mod workbook;

pub use crate::flight::quality;
pub use csv::{InspectedColumn, Inspection};
pub use csv_writer::CsvWriter;
pub use export::{to_csv, to_csv_as_recorded, to_json};
pub use fault::{IngestError, code};
pub use format::Format;
pub use join::{Part, check_together, join};
pub use limits::Limits;
pub use mapping::Mapping;
pub use origin::Origin;
pub use reading::Reading;
pub use recording::Recording;
pub use summary::{ChannelSummary, Summary, summary};

use crate::flight::Maneuver;
use contents::{Contents, Opened};
use recognition::Kind;

/// Whether a file is packed, so that it needs more memory than its own.
pub fn is_packed(bytes: &[u8]) -> bool {
    matches!(
        Kind::of(bytes),
        Some(Kind::Gzip | Kind::Zip | Kind::Parquet | Kind::Hdf5 | Kind::Mdf4)
    )
}

/// Reads a recording that says names and units itself.
///
/// # Errors
/// As [`read_mapped`].
pub fn read(bytes: &[u8], format: Format, limits: &Limits) -> Result<Maneuver, IngestError> {
    read_mapped(bytes, format, None, limits)
}

/// Reads a recording, with a mapping where its format has no names and units, or a table has the wrong ones.
///
/// # Errors
/// As [`read_recording`].
pub fn read_mapped(
    bytes: &[u8],
    format: Format,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Maneuver, IngestError> {
    read_recording(bytes, format, None, mapping, limits).map(|reading| reading.maneuver)
}

/// Reads a recording, and tells what was odd about its file. The charset of a text may be said; it is found out where it is
/// not.
///
/// # Errors
/// All faults that can be found at once: every fault of a header or a mapping, the first 20 of
/// the cells. A mapping that is missing, or that is there where the file says names and units itself.
pub fn read_recording(
    bytes: &[u8],
    format: Format,
    charset: Option<&str>,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    let reading = read_contents(bytes, format, charset, mapping, limits)?;
    time_range::check(reading.maneuver.time())?;
    Ok(reading)
}

fn read_contents(
    bytes: &[u8],
    format: Format,
    charset: Option<&str>,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    let Opened { bytes, contents } = contents::open(bytes, format, limits)?;
    let bytes: &[u8] = &bytes;
    match (contents, mapping) {
        (Contents::Ulog, _) => ulog::read(bytes, mapping, limits),
        (Contents::DataFlash, _) => dataflash::read(bytes, mapping, limits),
        (Contents::Mat, _) => mat::read(bytes, mapping, limits),
        (Contents::Workbook, _) => {
            let table = workbook::table(bytes, limits)?;
            csv::read(table.as_bytes(), Some(workbook::CHARSET), mapping, limits)
        }
        (Contents::Parquet, _) => {
            let mut columns = parquet::columns(bytes, limits)?;
            csv::read_columns(&mut columns, mapping, limits)
        }
        (Contents::FlySight, _) => flysight::read(bytes, mapping, limits),
        (Contents::Ames, _) => ames::read(bytes, charset, mapping, limits),
        (Contents::Octave, _) => octave::read(bytes, mapping, limits),
        (Contents::Tdms, _) => tdms::read(bytes, mapping, limits),
        (Contents::Mdf4, _) => mdf4::read(bytes, mapping, limits),
        (Contents::Hdf5, _) => match hdf5::open(bytes, limits)? {
            hdf5::Opened::Table(mut columns) => csv::read_columns(&mut columns, mapping, limits),
            hdf5::Opened::Datasets(datasets) => hdf5::read(*datasets, mapping, limits),
        },
        (Contents::TableOrMatrix, Some(mapping)) if ascii::is_matrix(bytes, mapping) => {
            ascii::read(bytes, mapping, limits)
        }
        (Contents::Table | Contents::TableOrMatrix, _) => {
            csv::read(bytes, charset, mapping, limits)
        }
        (Contents::Json, None) => json::read(bytes, limits).map(Reading::from),
        (Contents::Json, Some(_)) => {
            let message = "this format says names and units itself; leave the mapping out";
            Err(fault::of_file(code::MAPPING_NOT_USED, message).into())
        }
    }
}

/// Looks at a table of text, a workbook or a Parquet file: how it is written, what its columns are, the draft of a mapping for it. `None`
/// where the file is another.
///
/// # Errors
/// There is no table in it; or it cannot be unpacked, or is of a format that is not read.
pub fn inspect(
    bytes: &[u8],
    format: Format,
    charset: Option<&str>,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Option<Inspection>, IngestError> {
    let Opened { bytes, contents } = contents::open(bytes, format, limits)?;
    let inspected = match contents {
        Contents::Table | Contents::TableOrMatrix => {
            csv::inspect(&bytes, charset, mapping, limits)?
        }
        Contents::Ames => ames::inspect(&bytes, charset, mapping, limits)?,
        Contents::Workbook => {
            let table = workbook::table(&bytes, limits)?;
            csv::inspect(table.as_bytes(), Some(workbook::CHARSET), mapping, limits)?
        }
        Contents::Parquet => {
            let mut columns = parquet::columns(&bytes, limits)?;
            csv::inspect_columns("Parquet", &mut columns, mapping, limits)?
        }
        Contents::Hdf5 => match hdf5::open(&bytes, limits)? {
            hdf5::Opened::Table(mut columns) => {
                csv::inspect_columns("HDF5", &mut columns, mapping, limits)?
            }
            hdf5::Opened::Datasets(_) => return Ok(None),
        },
        _ => return Ok(None),
    };
    Ok(Some(inspected))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mapping_is_for_files_that_need_one() {
        let mapping = Mapping::named_or_json("sidpac").unwrap();
        let limits = Limits::default();
        let unused = read_mapped(b"{}", Format::Json, Some(&mapping), &limits);
        assert_eq!(fault::places(unused), ["mapping_not_used "]);
    }

    /// Cuts and byte changes of a good file must be answered, never panic.
    #[test]
    fn no_damage_to_a_file_panics() {
        let good: [(&[u8], Format); 2] = [
            (
                b"\xef\xbb\xbft[s],\"alpha[deg]\",q\r\n0,1.5,nan\r\n0.1,2,3\r\n",
                Format::Csv,
            ),
            (
                br#"{"time":{"unit":"s","start":0,"step":0.1},"channels":{"q":{"unit":"deg/s","values":[1,null]}}}"#,
                Format::Json,
            ),
        ];
        for (bytes, format) in good {
            read(bytes, format, &Limits::default()).expect("the undamaged file is good");
            for at in 0..bytes.len() {
                let _ = read(&bytes[..at], format, &Limits::default());
                for with in [0, b'"', b',', b'\n', b'[', b'{', b'9', b'e', 0xff] {
                    let mut damaged = bytes.to_vec();
                    damaged[at] = with;
                    if let Err(error) = read(&damaged, format, &Limits::default()) {
                        assert!(!error.faults().is_empty());
                    }
                }
            }
        }
    }
}
