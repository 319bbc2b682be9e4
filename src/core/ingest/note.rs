//! What was odd about the writing of a file that was read all the same.

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
