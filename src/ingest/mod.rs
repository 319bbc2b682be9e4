//! Files to maneuvers: the bytes of a recording in, a [`Maneuver`] or a list of all its faults out.
//!
//! A recording comes from a stranger. Whatever its bytes are, [`read`] answers with a maneuver or with
//! [`IngestError`], whose faults each name the place (a column, a row, a JSON pointer) and the remedy.
//! Its memory is bounded by [`Limits`] *before* it is used: both formats are surveyed in one cheap pass
//! before anything is built from them.
//!
//! What is readable may still be poor: [`quality`] finds gaps, missing values, stuck sensors and spikes,
//! and [`summary`] is what a user sees of a maneuver without downloading it.

mod axis;
mod cell;
mod csv;
mod export;
mod fault;
mod header;
mod json;
mod label;
mod limits;
mod lines;
mod name;
mod quality;
mod recording;
mod stamp;
mod summary;
mod text;
mod units;

pub use export::{to_csv, to_csv_as_recorded, to_json};
pub use fault::{IngestError, code};
pub use limits::Limits;
pub use quality::quality;
pub use recording::Recording;
pub use summary::{ChannelSummary, Summary, summary};

use crate::flight::Maneuver;

/// What a recording is written in.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Format {
    Csv,
    Json,
}

impl Format {
    /// The media types of [`Format::from_content_type`], for a message that says what is accepted.
    pub const CONTENT_TYPES: [&str; 2] = ["text/csv", "application/json"];

    /// Reads a `Content-Type`; its parameters (`charset=...`) are ignored.
    pub fn from_content_type(content_type: &str) -> Option<Self> {
        let essence = content_type.split(';').next().unwrap_or_default().trim();
        match essence.to_ascii_lowercase().as_str() {
            "text/csv" | "application/csv" => Some(Self::Csv),
            "application/json" | "text/json" => Some(Self::Json),
            _ => None,
        }
    }
}

/// Reads a recording.
///
/// # Errors
/// All faults that can be found at once: every fault of a header, the first 20 of
/// the cells.
pub fn read(bytes: &[u8], format: Format, limits: &Limits) -> Result<Maneuver, IngestError> {
    match format {
        Format::Csv => csv::read(bytes, limits),
        Format::Json => json::read(bytes, limits),
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
        assert_eq!(format("application/x-matlab-data"), None);
        assert_eq!(format(""), None);
        for accepted in Format::CONTENT_TYPES {
            assert!(format(accepted).is_some(), "{accepted}");
        }
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
