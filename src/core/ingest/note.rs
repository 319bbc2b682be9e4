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

/// Columns that could have been channels, each as it is to be written, and why they are none.
pub(super) fn left_out(columns: &[(String, String)], remedy: &str) -> Option<Finding> {
    let why = |(title, why): &(String, String)| {
        let why = why.split(';').next().unwrap_or(why);
        format!("{title} ({why})")
    };
    let message = format!(
        "{} column(s) are left out: {}",
        columns.len(),
        listed(columns.iter().map(why))
    );
    let finding = Finding {
        count: columns.len(),
        ..note(FindingCode::LeftOut, message, remedy)
    };
    (!columns.is_empty()).then_some(finding)
}

/// Titles with the names that their channels have.
pub(super) fn renamed(titles: &[(String, String)]) -> Option<Finding> {
    let pairs = titles
        .iter()
        .map(|(title, name)| format!("{} is {name}", text::quoted(title)));
    let message = format!(
        "{} title(s) are no names for equations: {}",
        titles.len(),
        listed(pairs)
    );
    let remedy = "other names can be given in a mapping";
    (!titles.is_empty()).then(|| note(FindingCode::Renamed, message, remedy))
}

/// Channels whose unit is said nowhere.
pub(super) fn without_unit(names: &[String]) -> Option<Finding> {
    let message = format!(
        "no unit is said of {}: they are read as pure numbers, angles as radians",
        listed(names.iter().cloned())
    );
    let remedy =
        "say the unit in the header, as alpha[deg], or in a mapping; [-] is that of a pure number";
    (!names.is_empty()).then(|| note(FindingCode::NoUnit, message, remedy))
}
