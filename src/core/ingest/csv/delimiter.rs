//! What separates the cells of a CSV file: commas, semicolons or tabs.

use crate::flight::Fault;

use super::super::{code, fault::of_file, lines::Line, text::quoted};

const DELIMITERS: [(char, &str); 3] = [(',', "commas"), (';', "semicolons"), ('\t', "tabs")];

/// The delimiter of a header. No name and no unit holds one, so a header has one kind only.
///
/// # Errors
/// The header has several kinds, or another.
pub(super) fn of_header(header: Line) -> Result<char, Fault> {
    let known = || DELIMITERS.map(|(delimiter, _)| delimiter);
    let is_clean = |cell: &str, own: char| !cell.trim().contains(known().as_slice()) || own == ' ';
    let splits = |&delimiter: &char| {
        let has_it = header.text.contains(delimiter);
        has_it
            && header
                .text
                .split(delimiter)
                .all(|cell| is_clean(cell, delimiter))
    };
    if let Some(delimiter) = known().into_iter().find(splits) {
        return Ok(delimiter);
    }
    let found = DELIMITERS
        .iter()
        .filter(|(delimiter, _)| header.text.contains(*delimiter));
    let found: Vec<&str> = found.map(|&(_, name)| name).collect();
    let number = header.number;
    let message = if !found.is_empty() {
        let found = found.join(" and ");
        format!("line {number}: the header has {found}; separate its cells by one of them only")
    } else if header.text.contains('|') {
        format!(
            "line {number}: the header's cells are separated by vertical bars; separate them by commas, semicolons or tabs"
        )
    } else if header.text.split_whitespace().count() > 1 {
        let header = quoted(header.text.trim());
        format!(
            "line {number}: the header {header} has no comma, semicolon or tab; separate its cells by one of them"
        )
    } else {
        return Ok(',');
    };
    Err(of_file(code::WRONG_DELIMITER, message))
}

/// The delimiter that a line `sep=;` declares, as spreadsheets write it before the header.
pub(super) fn declared(line: Line) -> Option<char> {
    let (key, value) = line.text.split_once('=')?;
    let mut delimiters = DELIMITERS.iter().map(|&(delimiter, _)| delimiter);
    let is_sep = key
        .trim()
        .trim_start_matches('"')
        .eq_ignore_ascii_case("sep");
    delimiters.find(|delimiter| {
        is_sep
            && value
                .trim_end_matches([' ', '"'])
                .eq(delimiter.to_string().as_str())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<char, String> {
        of_header(Line { number: 3, text }).map_err(|fault| fault.message)
    }

    #[test]
    fn the_only_kind_of_the_header_is_it() {
        assert_eq!(of("t[s],alpha [deg], q(deg/s)"), Ok(','));
        assert_eq!(of("t[s];alpha [deg]"), Ok(';'));
        assert_eq!(of("t[s]\talpha [deg]"), Ok('\t'));
        assert_eq!(of("t[s],\talpha[deg],\tq"), Ok(','), "padded with tabs");
        assert_eq!(of("t[s]"), Ok(','));
    }

    #[test]
    fn several_kinds_or_another_are_refused() {
        assert!(
            of("t[s],alpha;q")
                .unwrap_err()
                .contains("line 3: the header has commas and semicolons")
        );
        assert!(of("t[s]|alpha|q").unwrap_err().contains("vertical bars"));
        assert!(
            of("t[s] alpha[deg]")
                .unwrap_err()
                .contains("no comma, semicolon or tab")
        );
    }

    #[test]
    fn a_spreadsheet_may_declare_it() {
        let declared = |text| declared(Line { number: 1, text });
        assert_eq!(declared("sep=;"), Some(';'));
        assert_eq!(declared("\"SEP=,\""), Some(','));
        assert_eq!(declared("sep=\t"), Some('\t'));
        assert_eq!(declared("sep=x"), None);
        assert_eq!(declared("t=;"), None);
    }
}
