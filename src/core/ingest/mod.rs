//! Files to maneuvers: the bytes of a recording in, a [`Maneuver`] or a list of all its faults out.
//!
//! A recording comes from a stranger. Whatever its bytes are, [`read`] answers with a maneuver or with
//! [`IngestError`], whose faults each name the place (a column, a row, a JSON pointer) and the remedy.
//! Its memory is bounded by [`Limits`] *before* it is used: every format is surveyed in one cheap pass
//! before anything is built from it.
//!
//! CSV, JSON and workbooks say names and units themselves. MAT files and ASCII matrices do not: a [`Mapping`] says them. It
//! can do so for CSV, too, where what the file says is not what is meant. Logs of PX4 and ArduPilot come with mappings of
//! the quantities that most of them have.
//!
//! Whatever a sender says that a file is, its first bytes are looked at first. What is packed with gzip or zip is unpacked.
//!
//! What is readable may still be poor: [`quality()`] finds gaps, missing values, stuck sensors and spikes,
//! and [`summary()`] is what a user sees of a maneuver without downloading it.
//!
//! Invariant: no bytes panic, and none use more memory than [`Limits`] allow.

mod ascii;
mod assemble;
mod axis;
pub mod bundled;
mod cell;
mod csv;
mod csv_writer;
mod dataflash;
mod export;
mod fault;
mod header;
mod json;
mod label;
mod limits;
mod lines;
mod mapping;
mod mat;
mod matrix;
mod messages;
mod name;
mod packed;
mod quality;
mod recognition;
mod recording;
mod stamp;
mod summary;
mod text;
mod ulog;
mod union;
mod units;
mod workbook;

pub use csv_writer::CsvWriter;
pub use export::{to_csv, to_csv_as_recorded, to_json};
pub use fault::{IngestError, code};
pub use limits::Limits;
pub use mapping::Mapping;
pub use quality::quality;
pub use recording::Recording;
pub use summary::{ChannelSummary, Summary, summary};

use crate::flight::Maneuver;
use recognition::Kind;

/// What a recording is written in.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Format {
    /// Text with a header of `name[unit]`, a row for each sample.
    Csv,
    /// One time axis and a list of values for each channel.
    Json,
    /// A MAT file of version 4 or 5.
    Mat,
    /// A matrix of numbers as text.
    Ascii,
    /// Not said: the first bytes tell what it is, and text that is not JSON is CSV.
    Unstated,
}

impl Format {
    /// The media types of [`Format::from_content_type`], for a message that says what is accepted.
    pub const CONTENT_TYPES: [&str; 5] = [
        "text/csv",
        "application/json",
        "application/x-matlab-data",
        "text/plain",
        "application/octet-stream",
    ];

    /// The media type of an upload.
    pub fn content_type(self) -> &'static str {
        match self {
            Self::Csv => "text/csv",
            Self::Json => "application/json",
            Self::Mat => "application/x-matlab-data",
            Self::Ascii => "text/plain",
            Self::Unstated => "application/octet-stream",
        }
    }

    /// By the end of a file's name, without the dot; `None` if it says nothing.
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "csv" => Some(Self::Csv),
            "json" => Some(Self::Json),
            "mat" => Some(Self::Mat),
            "asc" => Some(Self::Ascii),
            "gz" | "zip" | "xlsx" | "xlsm" | "ulg" | "ulog" | "bin" => Some(Self::Unstated),
            _ => None,
        }
    }

    /// Reads a `Content-Type`; its parameters (`charset=...`) are ignored.
    pub fn from_content_type(content_type: &str) -> Option<Self> {
        let essence = content_type.split(';').next().unwrap_or_default().trim();
        match essence.to_ascii_lowercase().as_str() {
            "text/csv" | "application/csv" => Some(Self::Csv),
            "application/json" | "text/json" => Some(Self::Json),
            "application/x-matlab-data" | "application/matlab-mat" => Some(Self::Mat),
            "text/plain" => Some(Self::Ascii),
            "application/octet-stream"
            | "application/gzip"
            | "application/x-gzip"
            | "application/zip"
            | "application/x-zip-compressed"
            | "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
            | "application/vnd.ms-excel.sheet.macroenabled.12" => Some(Self::Unstated),
            _ => None,
        }
    }
}

/// Whether a file is packed with gzip or zip, so that it needs more memory than its own.
pub fn is_packed(bytes: &[u8]) -> bool {
    matches!(Kind::of(bytes), Some(Kind::Gzip | Kind::Zip))
}

/// Reads a recording that says names and units itself.
///
/// # Errors
/// As [`read_mapped`].
pub fn read(bytes: &[u8], format: Format, limits: &Limits) -> Result<Maneuver, IngestError> {
    read_mapped(bytes, format, None, limits)
}

/// Reads a recording, with a mapping where its format has no names and units, or a CSV file has the wrong ones.
///
/// # Errors
/// All faults that can be found at once: every fault of a header or a mapping, the first 20 of
/// the cells. A mapping that is missing, or that is there where the file says names and units itself.
pub fn read_mapped(
    bytes: &[u8],
    format: Format,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Maneuver, IngestError> {
    let packed::Unpacked { bytes, name } = packed::unpack(bytes, limits)?;
    let bytes: &[u8] = &bytes;
    match Kind::of(bytes) {
        Some(Kind::Ulog) => return ulog::read(bytes, mapping, limits),
        Some(Kind::DataFlash) => return dataflash::read(bytes, mapping, limits),
        Some(Kind::Mat) => return mat::read(bytes, mapping, limits),
        None if mat::is_version_4(bytes) => return mat::read(bytes, mapping, limits),
        Some(Kind::Zip) => return workbook::read(bytes, mapping, limits),
        // it is told how MATLAB writes another one
        Some(Kind::Foreign(_)) if format == Format::Mat && mat::is_hdf5(bytes) => {}
        Some(Kind::Foreign(foreign)) => return Err(foreign.fault().into()),
        Some(Kind::Gzip) | None => {}
    }
    let extension = name.as_deref().and_then(|name| name.rsplit_once('.'));
    let of_name = extension.and_then(|(_, extension)| Format::from_extension(extension));
    match (of_name.unwrap_or(format), mapping) {
        (Format::Unstated, _) if bytes.trim_ascii_start().starts_with(b"{") => {
            read_mapped(bytes, Format::Json, mapping, limits)
        }
        (Format::Csv | Format::Unstated, _) => csv::read(bytes, mapping, limits),
        (Format::Json, None) => json::read(bytes, limits),
        (Format::Mat, _) => mat::read(bytes, mapping, limits),
        (Format::Ascii, _) => ascii::read(bytes, mapping, limits),
        (Format::Json, Some(_)) => {
            let message = "this format says names and units itself; leave the mapping out";
            Err(fault::of_file(code::MAPPING_NOT_USED, message).into())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_types_are_read_without_their_parameters() {
        let format = Format::from_content_type;
        assert_eq!(format("text/csv; charset=utf-8"), Some(Format::Csv));
        assert_eq!(format("Application/JSON"), Some(Format::Json));
        assert_eq!(format("application/x-hdf5"), None);
        assert_eq!(format("application/gzip"), Some(Format::Unstated));
        assert_eq!(format(""), None);
        for accepted in Format::CONTENT_TYPES {
            assert_eq!(format(accepted).map(Format::content_type), Some(accepted));
        }
    }

    #[test]
    fn a_mapping_is_for_files_that_need_one() {
        let mapping = Mapping::named_or_json("sidpac").unwrap();
        let limits = Limits::default();
        let unused = read_mapped(b"{}", Format::Json, Some(&mapping), &limits);
        assert_eq!(fault::places(unused), ["mapping_not_used "]);
        for extension in ["csv", "JSON", "mat", "asc", "gz", "xlsx", "ulg", "bin"] {
            assert!(Format::from_extension(extension).is_some());
        }
        assert_eq!(Format::from_extension("txt"), None);
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
