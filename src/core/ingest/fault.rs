//! What is wrong with a recording: the place, a stable word, and a message with the remedy.

use std::fmt;

use crate::flight::Fault;

/// Faults of cells and rows are listed up to this many; behind them reading stops.
pub(super) const CELLS_LISTED: usize = 20;

/// A fault of the file as a whole.
pub(super) fn of_file(code: &'static str, message: impl Into<String>) -> Fault {
    Fault::new("", code, message)
}

/// Why a recording was refused: one fault or more.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct IngestError {
    faults: Vec<Fault>,
    draft: Option<String>,
}

impl IngestError {
    /// Never empty.
    pub fn faults(&self) -> &[Fault] {
        &self.faults
    }

    /// The faults themselves; never none.
    pub fn into_faults(self) -> Vec<Fault> {
        self.faults
    }

    /// The draft of a mapping for this file, JSON: in it the choices can be made that the file leaves open, `?` where one
    /// must be.
    pub fn draft(&self) -> Option<&str> {
        self.draft.as_deref()
    }

    pub(super) fn with_draft(self, draft: String) -> Self {
        Self {
            draft: Some(draft),
            ..self
        }
    }

    /// The same with every fault as `with` makes it.
    pub(super) fn map(self, with: impl FnMut(Fault) -> Fault) -> Self {
        Self {
            faults: self.faults.into_iter().map(with).collect(),
            ..self
        }
    }

    /// Refuses if there is a fault.
    pub(super) fn refuse(faults: Vec<Fault>) -> Result<(), Self> {
        if faults.is_empty() {
            Ok(())
        } else {
            Err(Self {
                faults,
                draft: None,
            })
        }
    }
}

impl From<Fault> for IngestError {
    fn from(fault: Fault) -> Self {
        Self {
            faults: vec![fault],
            draft: None,
        }
    }
}

impl fmt::Display for IngestError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, fault) in self.faults.iter().enumerate() {
            let separator = if i == 0 { "" } else { "\n" };
            let at = if fault.pointer.is_empty() { "" } else { ": " };
            write!(f, "{separator}{}{at}{}", fault.pointer, fault.message)?;
        }
        Ok(())
    }
}

impl std::error::Error for IngestError {}

/// A JSON pointer (RFC 6901) of the segments given.
pub(super) fn pointer<S: AsRef<str>>(segments: impl IntoIterator<Item = S>) -> String {
    segments.into_iter().fold(String::new(), |path, segment| {
        let escaped = segment.as_ref().replace('~', "~0").replace('/', "~1");
        path + "/" + &escaped
    })
}

/// Constants for the words, each documented by its meaning, and the list of both.
macro_rules! codes {
    ($($name:ident = $word:literal, $meaning:literal;)*) => {
        $(#[doc = $meaning] pub const $name: &str = $word;)*

        /// Every code with its meaning, for the documentation.
        pub const ALL: &[(&str, &str)] = &[$(($name, $meaning)),*];
    };
}

/// The words that [`Fault::code`] can be. They never change their meaning.
pub mod code {
    codes! {
        EMPTY_BODY = "empty_body", "There are no bytes, or only blanks.";
        NOT_UTF8 = "not_utf8", "The file is not UTF-8 text.";
        WRONG_DELIMITER = "wrong_delimiter", "It is not clear what separates the cells: commas, semicolons or tabs.";
        AMBIGUOUS_NUMBER = "ambiguous_number", "A comma or a point in a number can be read in two ways.";
        INVALID_JSON = "invalid_json", "The body is not JSON.";
        WRONG_SHAPE = "wrong_shape", "The body is JSON, but not in the shape of a recording.";
        TOO_MANY_COLUMNS = "too_many_columns", "The limit of columns is exceeded.";
        TOO_MANY_SAMPLES = "too_many_samples", "The limit of samples is exceeded.";
        TOO_MANY_VALUES = "too_many_values", "The limit of values is exceeded.";
        TOO_FEW_SAMPLES = "too_few_samples", "A maneuver needs at least two samples.";
        NO_CHANNELS = "no_channels", "There is no channel besides time.";
        EMPTY_NAME = "empty_name", "A channel has no name.";
        INVALID_NAME = "invalid_name", "A channel's name is not an identifier, or is reserved.";
        NAME_TOO_LONG = "name_too_long", "A channel's name is too long.";
        DUPLICATE_CHANNEL = "duplicate_channel", "Two channels have the same name.";
        UNKNOWN_UNIT = "unknown_unit", "A unit is unknown or cannot be read.";
        UNIT_CONFLICT = "unit_conflict", "The header and the row of units below it disagree.";
        NO_TIME_COLUMN = "no_time_column", "No column is named t or time.";
        TIME_UNIT = "time_unit", "The unit of time is not a time.";
        TIME_MISSING = "time_missing", "A sample has no time.";
        TIME_NOT_INCREASING = "time_not_increasing", "Time does not increase.";
        TIME_RANGE = "time_range", "Time goes on in steps too short, or for too long, to be that of a flight.";
        NOT_A_NUMBER = "not_a_number", "A cell holds neither a number nor a sign for a missing value.";
        ROW_LENGTH = "row_length", "A row does not have as many cells as the header.";
        LENGTH_MISMATCH = "length_mismatch", "A channel does not have as many values as the time axis.";
        MAPPING_NEEDED = "mapping_needed", "The file has no names and units; a mapping must say them.";
        MAPPING_NOT_USED = "mapping_not_used", "The file says names and units itself, in a format for which there is no mapping.";
        INVALID_MAPPING = "invalid_mapping", "The mapping is unknown, or is not a mapping.";
        UNKNOWN_SOURCE = "unknown_source", "The file does not have what the mapping names.";
        UNREADABLE_SOURCE = "unreadable_source", "What the mapping names is not a matrix of real numbers.";
        NOT_A_MAT_FILE = "not_a_mat_file", "The body is not a MAT file.";
        MAT_VERSION = "mat_version", "The MAT file is of a version that is not read.";
        FORMAT_NOT_READ = "format_not_read", "The file is of a format that is not read; the message says which and how to convert it.";
        UNPACKED_TOO_LARGE = "unpacked_too_large", "A packed file unpacks to more than the longest body that is taken.";
        SEVERAL_FILES = "several_files", "An archive has no file in it, or more than one.";
        OTHER_CLOCK = "other_clock", "Files that are to be one recording are told by different clocks, or have no time in common.";
        DAMAGED_FILE = "damaged_file", "The file contradicts itself or is cut off.";
    }
}

/// `code pointer` of each fault of a recording that must be refused.
#[cfg(test)]
pub(super) fn places<T>(result: Result<T, IngestError>) -> Vec<String> {
    let error = result.err().unwrap_or_else(|| panic!("it was accepted"));
    let place = |fault: &Fault| format!("{} {}", fault.code, fault.pointer);
    error.faults().iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pointers_escape_what_rfc_6901_says() {
        assert_eq!(pointer(["channels", "a/b~c"]), "/channels/a~1b~0c");
        assert_eq!(pointer::<&str>([]), "");
    }

    #[test]
    fn an_error_prints_each_fault_with_its_place() {
        let faults = vec![
            Fault::new("/rows/1", code::ROW_LENGTH, "one"),
            of_file(code::NOT_UTF8, "two"),
        ];
        let error = IngestError::refuse(faults).unwrap_err();
        assert_eq!(error.to_string(), "/rows/1: one\ntwo");
        assert_eq!(IngestError::refuse(Vec::new()), Ok(()));
    }

    #[test]
    fn codes_are_distinct() {
        let mut words: Vec<_> = code::ALL.iter().map(|(word, _)| word).collect();
        words.sort_unstable();
        words.dedup();
        assert_eq!(words.len(), code::ALL.len());
    }
}
