//! What was odd about the writing of a file that was read all the same.

use super::text;
use crate::flight::{Finding, FindingCode};

/// A finding about the file as a whole.
pub(super) fn note(code: FindingCode, message: String, remedy: impl Into<String>) -> Finding {
    Finding {
        count: 1,
        ..Finding::new(code, message, remedy)
    }
}

/// A finding about samples, counted from 1.
pub(super) fn note_of_rows(
    code: FindingCode,
    rows: &[usize],
    message: String,
    remedy: impl Into<String>,
) -> Finding {
    Finding {
        rows: rows.iter().copied().take(Finding::ROWS_LISTED).collect(),
        count: rows.len(),
        ..note(code, message, remedy)
    }
}

/// Names or sentences are listed up to this many.
const LISTED: usize = 12;

/// The first of several names or sentences, and how many more there are.
pub(super) fn listed(names: impl Iterator<Item = String>) -> String {
    text::listed(names, LISTED)
}

/// That a file does not have channels of a mapping which it need not have.
pub(super) fn absent(names: &[String]) -> Option<Finding> {
    let message = format!(
        "the file does not have {}, which the mapping names",
        listed(names.iter().cloned())
    );
    let remedy = "nothing needs to be done where the model does not need them";
    (!names.is_empty()).then(|| note(FindingCode::Absent, message, remedy))
}
