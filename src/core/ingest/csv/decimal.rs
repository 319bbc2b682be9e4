//! Whether the numbers of a CSV file have decimal points or decimal commas.

use crate::flight::Fault;

use super::super::{
    cell::{Decimal, unquote},
    code,
    fault::of_file,
    lines::Line,
    text::quoted,
};

/// Looks at every number of the rows: one that can be read in one way only decides for all.
///
/// # Errors
/// Points and commas are mixed, or every comma may separate thousands: `1,234`.
pub(super) fn of_rows<'a>(
    rows: impl Iterator<Item = Line<'a>>,
    delimiter: char,
) -> Result<Decimal, Fault> {
    if delimiter == ',' {
        return Ok(Decimal::Point);
    }
    let mut found = Found::default();
    for line in rows {
        // most files have no comma at all: they are passed over fast
        if found.point.is_some() && !line.text.contains(',') {
            continue;
        }
        for (column, cell) in line.text.split(delimiter).enumerate() {
            let cell = Cell {
                line: line.number,
                column: column + 1,
                text: unquote(cell),
            };
            found.look_at(cell)?;
        }
    }
    found.verdict()
}

/// A cell and its place, both counted from 1.
#[derive(Clone, Copy)]
struct Cell<'a> {
    line: usize,
    column: usize,
    text: &'a str,
}

impl Cell<'_> {
    fn fault(self, why: &str) -> Fault {
        let Self { line, column, text } = self;
        let message = format!("line {line}, column {column}: {}", quoted(text) + why);
        of_file(code::AMBIGUOUS_NUMBER, message)
    }
}

#[derive(Default)]
struct Found<'a> {
    /// The first number with a point.
    point: Option<Cell<'a>>,
    /// The first number with a comma.
    comma: Option<Cell<'a>>,
    /// A comma was met that can only be a decimal one.
    is_comma_decimal: bool,
}

impl<'a> Found<'a> {
    fn look_at(&mut self, cell: Cell<'a>) -> Result<(), Fault> {
        let (mut points, mut commas) = (0, 0);
        for byte in cell.text.bytes() {
            match byte {
                b'.' => points += 1,
                b',' => commas += 1,
                b'0'..=b'9' | b'+' | b'-' | b'e' | b'E' => {}
                // a word or a time
                _ => return Ok(()),
            }
        }
        match (points, commas) {
            (0, 0) => return Ok(()),
            (1, 0) => {
                self.point.get_or_insert(cell);
            }
            (0, 1) => {
                self.comma.get_or_insert(cell);
                self.is_comma_decimal |= !may_be_thousands(cell.text);
            }
            // 21.11.2026 is no number at all
            (_, 0) => return Ok(()),
            _ => {
                return Err(cell.fault(
                    " has more than one separator; write numbers without thousands separators",
                ));
            }
        }
        if let (Some(point), Some(comma)) = (self.point, self.comma) {
            let other = if std::ptr::eq(cell.text, comma.text) {
                point
            } else {
                comma
            };
            let why = format!(
                " and {} in line {} cannot both have a decimal mark; write all numbers with points, or all with commas",
                quoted(other.text),
                other.line
            );
            return Err(cell.fault(&why));
        }
        Ok(())
    }

    fn verdict(self) -> Result<Decimal, Fault> {
        match self.comma {
            None => Ok(Decimal::Point),
            Some(_) if self.is_comma_decimal => Ok(Decimal::Comma),
            Some(cell) => Err(cell.fault(
                " may have a decimal comma or a thousands separator, and no other number tells which; write decimal points",
            )),
        }
    }
}

/// `12,345`, and not `0,345`, `1234,567` or `1,2345`.
fn may_be_thousands(number: &str) -> bool {
    let unsigned = number.trim_start_matches(['+', '-']);
    let (whole, thousand) = unsigned.split_once(',').unwrap_or((unsigned, ""));
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    digits(whole)
        && digits(thousand)
        && whole.len() <= 3
        && thousand.len() == 3
        && !whole.starts_with('0')
}

#[cfg(test)]
mod tests {
    use super::super::super::lines::Lines;
    use super::*;

    fn of(text: &str) -> Result<Decimal, String> {
        of_rows(Lines::of(text), ';').map_err(|fault| fault.message)
    }

    #[test]
    fn one_clear_number_decides() {
        assert_eq!(of("0;1.5;nan"), Ok(Decimal::Point));
        assert_eq!(of("0;1\n1;2"), Ok(Decimal::Point));
        assert_eq!(of("1;1,5\n2;2"), Ok(Decimal::Comma));
        assert_eq!(of("1;1,234\n2;0,040"), Ok(Decimal::Comma));
        assert_eq!(of("1;\"1,234e3\""), Ok(Decimal::Comma));
        assert_eq!(
            of("12:00:00.5;1,5\n21.11.2026;x.y"),
            Ok(Decimal::Comma),
            "a time is no number"
        );
    }

    #[test]
    fn what_can_be_read_in_two_ways_is_refused_with_its_place() {
        let refused = |text: &str, expected: &str| {
            let message = of(text).unwrap_err();
            assert!(message.starts_with(expected), "{message}");
        };
        refused("1;2\n2;1,234", "line 2, column 2: '1,234' may have");
        refused(
            "1;1.5\n2;1,5",
            "line 2, column 2: '1,5' and '1.5' in line 1",
        );
        refused(
            "1;1,5\n2;1.5",
            "line 2, column 2: '1.5' and '1,5' in line 1",
        );
        refused(
            "1;1.234,5",
            "line 1, column 2: '1.234,5' has more than one mark",
        );
        refused(
            "1;1,234,567",
            "line 1, column 2: '1,234,567' has more than one mark",
        );
    }
}
