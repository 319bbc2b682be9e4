//! What the tests of quality say, in one form.

use crate::flight::{Finding, Severity};

/// A finding at `rows` (indices from 0).
pub(super) fn finding(
    code: &str,
    severity: Severity,
    channel: Option<&str>,
    rows: &[usize],
    message: String,
    remedy: &str,
) -> Finding {
    Finding {
        code: code.to_string(),
        severity,
        channel: channel.map(str::to_string),
        rows: rows
            .iter()
            .take(Finding::ROWS_LISTED)
            .map(|row| row + 1)
            .collect(),
        count: rows.len(),
        message,
        remedy: remedy.to_string(),
    }
}
