//! What was odd about the writing of a file that was read all the same.

use crate::flight::{Finding, Severity};

/// A finding about the file as a whole.
pub(super) fn note(
    code: &str,
    severity: Severity,
    message: String,
    remedy: impl Into<String>,
) -> Finding {
    Finding {
        code: code.to_string(),
        severity,
        channel: None,
        rows: Vec::new(),
        count: 1,
        message,
        remedy: remedy.into(),
    }
}

/// A finding about samples, counted from 1.
pub(super) fn note_of_rows(
    code: &str,
    severity: Severity,
    rows: &[usize],
    message: String,
    remedy: impl Into<String>,
) -> Finding {
    Finding {
        rows: rows.iter().copied().take(Finding::ROWS_LISTED).collect(),
        count: rows.len(),
        ..note(code, severity, message, remedy)
    }
}
