//! Files to maneuvers: the bytes of a recording in, a [`Maneuver`] or a list of all its faults out.
//!
//! A recording comes from a stranger. Whatever its bytes are, [`read`] answers with a maneuver or with
//! [`IngestError`], whose faults each name the place (a column, a row, a JSON pointer) and the remedy.
//! Its memory is bounded by [`Limits`] *before* it is used: every format is surveyed in one cheap pass
//! before anything is built from it.
//!
//! Tables of text and JSON say names and units themselves. MAT files and ASCII matrices do not: a [`Mapping`] says them. It
//! can do so for any table of text, too, where what the file says is not what is meant. [`inspect`] looks at one, and
//! drafts a mapping.
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
mod encoding;
mod export;
mod fault;
mod json;
mod label;
mod limits;
mod lines;
mod mapping;
mod mat;
mod matrix;
mod name;
mod note;
mod quick;
mod reading;
mod recording;
mod stamp;
mod summary;
mod text;
mod units;

pub use crate::flight::quality;
pub use csv::{InspectedColumn, Inspection};
pub use csv_writer::CsvWriter;
pub use export::{to_csv, to_csv_as_recorded, to_json};
pub use fault::{IngestError, code};
pub use limits::Limits;
pub use mapping::Mapping;
pub use reading::Reading;
pub use recording::Recording;
pub use summary::{ChannelSummary, Summary, summary};

use crate::flight::Maneuver;

/// What a recording is written in.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Format {
    /// A table of text with a header of `name[unit]`, a row for each sample.
    Csv,
    /// One time axis and a list of values for each channel.
    Json,
    /// A MAT file of version 5.
    Mat,
    /// A matrix of numbers as text, or any other table of text.
    Ascii,
}

impl Format {
    /// The media types of [`Format::from_content_type`], for a message that says what is accepted.
    pub const CONTENT_TYPES: [&str; 4] = [
        "text/csv",
        "application/json",
        "application/x-matlab-data",
        "text/plain",
    ];

    /// The media type of an upload.
    pub fn content_type(self) -> &'static str {
        match self {
            Self::Csv => "text/csv",
            Self::Json => "application/json",
            Self::Mat => "application/x-matlab-data",
            Self::Ascii => "text/plain",
        }
    }

    /// By the end of a file's name, without the dot; `None` if it says nothing.
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "csv" => Some(Self::Csv),
            "json" => Some(Self::Json),
            "mat" => Some(Self::Mat),
            "asc" => Some(Self::Ascii),
            _ => None,
        }
    }

    /// The charset that a `Content-Type` says.
    pub fn charset(content_type: &str) -> Option<&str> {
        let mut parameters = content_type.split(';').skip(1);
        parameters.find_map(|parameter| {
            let (name, value) = parameter.split_once('=')?;
            let is_charset = name.trim().eq_ignore_ascii_case("charset");
            is_charset.then(|| value.trim().trim_matches('"'))
        })
    }

    /// Reads a `Content-Type`; its parameters (`charset=...`) are ignored.
    pub fn from_content_type(content_type: &str) -> Option<Self> {
        let essence = content_type.split(';').next().unwrap_or_default().trim();
        match essence.to_ascii_lowercase().as_str() {
            "text/csv" | "application/csv" => Some(Self::Csv),
            "application/json" | "text/json" => Some(Self::Json),
            "application/x-matlab-data" | "application/matlab-mat" => Some(Self::Mat),
            "text/plain" => Some(Self::Ascii),
            _ => None,
        }
    }
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
    match (format, mapping) {
        (Format::Csv, _) => csv::read(bytes, charset, mapping, limits),
        (Format::Json, None) => json::read(bytes, limits).map(Reading::from),
        (Format::Mat, _) => mat::read(bytes, mapping, limits).map(Reading::from),
        (Format::Ascii, Some(mapping)) if ascii::is_matrix(bytes, mapping) => {
            ascii::read(bytes, mapping, limits).map(Reading::from)
        }
        (Format::Ascii, _) => csv::read(bytes, charset, mapping, limits),
        (_, Some(_)) => {
            let message = "this format says names and units itself; leave the mapping out";
            Err(fault::of_file(code::MAPPING_NOT_USED, message).into())
        }
    }
}

/// Looks at a table of text: how it is written, what its columns are, the draft of a mapping for it.
///
/// # Errors
/// There is no table in it.
pub fn inspect(
    bytes: &[u8],
    charset: Option<&str>,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Inspection, IngestError> {
    csv::inspect(bytes, charset, mapping, limits)
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
        for extension in ["csv", "JSON", "mat", "asc"] {
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
