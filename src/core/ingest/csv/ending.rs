//! What is at the end of a recording, or between its parts, and is no sample.

use super::super::{cell::unquote, lines::Line, note::note, text::quoted};
use super::delimiter::Delimiter;
use crate::flight::{Finding, FindingCode};

/// More lines than that behind the last sample are no footer.
pub(super) const LONGEST_FOOTER: usize = 200;

/// Whether there is nothing but delimiters and blanks.
pub(super) fn is_empty(text: &str, delimiter: Delimiter) -> bool {
    delimiter
        .cells(text)
        .iter()
        .all(|cell| cell.trim().is_empty())
}

pub(super) fn incomplete(line: usize) -> Finding {
    note(
        FindingCode::IncompleteLine,
        format!("the file ends within line {line}: this line is left out"),
        "end the file with a line's end where the line is complete",
    )
}

/// Whether the last number of a text has fewer digits behind its point than those of the lines before it all have.
pub(super) fn has_fewer_digits(text: &str, delimiter: Delimiter) -> bool {
    let lines = text
        .rsplit(['\n', '\r'])
        .filter(|line| !line.trim().is_empty());
    let digits = lines.take(11).map(|line| {
        let cells = delimiter.cells(line);
        let last = cells.last().map_or("", |cell| cell.trim());
        last.split_once(['.', ','])
            .map_or(0, |(_, digits)| digits.len())
    });
    let digits: Vec<usize> = digits.collect();
    match digits.split_first() {
        Some((last, before)) if before.len() >= 3 => before
            .iter()
            .all(|count| *count == before[0] && count > last),
        _ => false,
    }
}

/// What stands behind the last sample.
pub(super) fn footer(lines: &[Line]) -> Option<Finding> {
    let first = lines.first()?;
    let message = format!(
        "the table ends before line {}: {} line(s) behind it are left out, the first {}",
        first.number,
        lines.len(),
        quoted(first.text.trim())
    );
    let remedy = "where they are samples, write them as the rows above";
    Some(note(FindingCode::Footer, message, remedy))
}

pub(super) fn repeated_header(lines: &[usize]) -> Option<Finding> {
    let first = lines.first()?;
    let message = format!(
        "the header stands again in {} line(s), first in line {first}: it is passed over",
        lines.len()
    );
    let remedy = "the recording began anew there; look for a gap";
    Some(note(FindingCode::RepeatedHeader, message, remedy))
}

pub(super) fn no_time_yet(rows: usize) -> Option<Finding> {
    let message = format!("the first {rows} row(s) have no time: they are left out");
    let remedy = "nothing needs to be done where the logger's clock was not set yet";
    (rows > 0).then(|| note(FindingCode::NoTimeYet, message, remedy))
}

/// Whether the text that a row begins with, where its time should be, is a word: it is no row then.
pub(super) fn begins_with_word(cell: &str) -> bool {
    let first = unquote(cell).trim_start_matches(['-', '+']).chars().next();
    first.is_some_and(|first| !first.is_ascii_digit() && first != '.')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_that_was_cut_off_is_known_by_its_digits() {
        let comma = Delimiter::Byte(b',');
        assert!(has_fewer_digits("0,1.50\n1,1.25\n2,1.75\n3,1.5", comma));
        assert!(has_fewer_digits("0,1.50\n1,1.25\n2,1.75\n3,", comma));
        assert!(!has_fewer_digits("0,1.50\n1,1.25\n2,1.75\n3,1.50", comma));
        assert!(!has_fewer_digits("0,1.5\n1,1.25\n2,1.75\n3,1.5", comma));
        assert!(!has_fewer_digits("0,1\n1,2\n2,3\n3,4", comma));
        assert!(begins_with_word("End of file") && begins_with_word("# x"));
        assert!(!begins_with_word("12:00") && !begins_with_word("-1") && !begins_with_word(""));
    }
}
