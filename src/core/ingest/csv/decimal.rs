//! How the numbers of a table are written: decimal points or commas, marks between thousands.

use crate::flight::Fault;

use super::super::{
    cell::{Decimal, Marks, unquote, without_thousands},
    code,
    fault::of_file,
    lines::Lines,
    text::quoted,
};
use super::delimiter::Delimiter;

/// Looks at every number of the rows: one that can be read in one way only decides for all.
///
/// # Errors
/// Points and commas are mixed, or every comma may separate thousands: `1,234`.
pub(super) fn of_rows(rows: &Lines, delimiter: Delimiter) -> Result<Marks, Fault> {
    let is_comma = delimiter == Delimiter::Byte(b',');
    // in quotes only, where commas separate cells
    let may_be_other = if is_comma { b'"' } else { b',' };
    let text = rows.rest().as_bytes();
    if memchr::memchr(may_be_other, text).is_none() && (is_comma || !has_grouped_points(text)) {
        return Ok(Marks::POINT);
    }
    let mut found = Found::default();
    for line in rows.clone() {
        // most lines have no comma at all: they are passed over fast
        let is_plain = !line.text.as_bytes().contains(&may_be_other);
        let has_point = found.point.or(found.point_or_thousands).is_some();
        if is_plain && has_point && (is_comma || !has_grouped_points(line.text.as_bytes())) {
            continue;
        }
        // where commas are decimal, only a point can contradict
        if found.comma.is_some() && memchr::memchr(b'.', line.text.as_bytes()).is_none() {
            continue;
        }
        for (column, cell) in delimiter.cells(line.text).into_iter().enumerate() {
            found.look_at(Cell {
                line: line.number,
                column: column + 1,
                text: unquote(cell),
            });
        }
        if let Some(fault) = found.contradiction() {
            return Err(fault);
        }
    }
    found.verdict()
}

/// Whether something like `1.234.567` is in the bytes.
fn has_grouped_points(bytes: &[u8]) -> bool {
    let is_grouped = |at: usize| {
        bytes.get(at + 4) == Some(&b'.') && bytes[at + 1..at + 4].iter().all(u8::is_ascii_digit)
    };
    memchr::memchr_iter(b'.', bytes).any(is_grouped)
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

/// The first number of each kind.
#[derive(Default)]
struct Found<'a> {
    /// `1.5`, and not `1.234`
    point: Option<Cell<'a>>,
    /// `1.234`
    point_or_thousands: Option<Cell<'a>>,
    /// `1,5`
    comma: Option<Cell<'a>>,
    /// `1,234`
    comma_or_thousands: Option<Cell<'a>>,
    /// `12,345.5` or `1,234,567`
    thousands_by_comma: Option<Cell<'a>>,
    /// `12.345,5` or `1.234.567`
    thousands_by_point: Option<Cell<'a>>,
    /// `1,2,3`
    neither: Option<Cell<'a>>,
    last: Option<Cell<'a>>,
}

impl<'a> Found<'a> {
    fn look_at(&mut self, cell: Cell<'a>) {
        let (mut points, mut commas) = (0, 0);
        for byte in cell.text.bytes() {
            match byte {
                b'.' => points += 1,
                b',' => commas += 1,
                b'0'..=b'9' | b'+' | b'-' | b'e' | b'E' | b'd' | b'D' => {}
                // a word or a time
                _ => return,
            }
        }
        let is_parted = |mark, decimal| without_thousands(cell.text, mark, decimal).is_some();
        let kind = match (points, commas) {
            (0, 0) => return,
            (1, 0) if is_parted('.', Decimal::Comma) && !cell.text.starts_with('0') => {
                &mut self.point_or_thousands
            }
            (1, 0) => &mut self.point,
            (0, 1) if may_be_thousands(cell.text) => &mut self.comma_or_thousands,
            (0, 1) => &mut self.comma,
            (0 | 1, _) if is_parted(',', Decimal::Point) => &mut self.thousands_by_comma,
            (_, 0 | 1) if is_parted('.', Decimal::Comma) => &mut self.thousands_by_point,
            // 21.11.2026 is no number at all
            (_, 0) => return,
            _ => &mut self.neither,
        };
        if kind.is_none() {
            *kind = Some(cell);
            self.last = Some(cell);
        }
    }

    /// Two numbers that cannot be written in the same way.
    fn contradiction(&self) -> Option<Fault> {
        if let Some(cell) = self.neither {
            return Some(cell.fault(
                " has more than one separator; write numbers without thousands separators",
            ));
        }
        let pairs = [
            (self.comma, self.point),
            (self.comma, self.thousands_by_comma),
            (self.point, self.thousands_by_point),
            (self.thousands_by_comma, self.thousands_by_point),
            // 1,5 and 1.234 would be 1.5 and 1234, where nothing else has marks between thousands
            (
                self.comma,
                self.point_or_thousands
                    .filter(|_| self.thousands_by_point.is_none()),
            ),
        ];
        let (one, other) = pairs
            .into_iter()
            .find_map(|(one, other)| Some((one?, other?)))?;
        let is_last = self
            .last
            .is_some_and(|last| std::ptr::eq(last.text, one.text));
        let (later, earlier) = if is_last { (one, other) } else { (other, one) };
        let why = format!(
            " and {} in line {} cannot both have a decimal mark; write all numbers with points, or all with commas",
            quoted(earlier.text),
            earlier.line
        );
        Some(later.fault(&why))
    }

    fn verdict(self) -> Result<Marks, Fault> {
        let marks = |decimal, has_thousands| {
            Ok(Marks {
                decimal,
                has_thousands,
            })
        };
        if self.thousands_by_point.is_some() {
            return marks(Decimal::Comma, true);
        }
        if self.comma.is_some() {
            return marks(Decimal::Comma, false);
        }
        match self.comma_or_thousands {
            None => marks(Decimal::Point, self.thousands_by_comma.is_some()),
            Some(_) if self.point.is_some() || self.thousands_by_comma.is_some() => marks(Decimal::Point, true),
            Some(cell) => Err(cell.fault(
                " may have a decimal comma or a thousands separator, and no other number tells which; write decimal points, or say decimal = \",\" in a mapping",
            )),
        }
    }
}

/// `12,345`, and not `0,345`, `1234,567` or `1,2345`.
fn may_be_thousands(number: &str) -> bool {
    let unsigned = number.trim_start_matches(['+', '-']);
    !unsigned.starts_with('0') && without_thousands(number, ',', Decimal::Point).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<(Decimal, bool), String> {
        let marks =
            of_rows(&Lines::of(text), Delimiter::Byte(b';')).map_err(|fault| fault.message)?;
        Ok((marks.decimal, marks.has_thousands))
    }

    #[test]
    fn one_clear_number_decides() {
        const POINT: Result<(Decimal, bool), String> = Ok((Decimal::Point, false));
        const COMMA: Result<(Decimal, bool), String> = Ok((Decimal::Comma, false));
        assert_eq!(of("0;1.5;nan"), POINT);
        assert_eq!(of("0;1\n1;2"), POINT);
        assert_eq!(of("0;1.234\n1;2.345"), POINT);
        assert_eq!(of("1;1,5\n2;2"), COMMA);
        assert_eq!(of("1;1,234\n2;0,040"), COMMA);
        assert_eq!(of("1;\"1,234e3\""), COMMA);
        assert_eq!(
            of("12:00:00.5;1,5\n21.11.2026;x.y"),
            COMMA,
            "a time is no number"
        );
    }

    #[test]
    fn marks_between_thousands_are_known_by_a_second_mark() {
        assert_eq!(of("1;1,234,567\n2;1,234"), Ok((Decimal::Point, true)));
        assert_eq!(of("1;12,345.5"), Ok((Decimal::Point, true)));
        assert_eq!(of("1;1.5\n2;1,234"), Ok((Decimal::Point, true)));
        assert_eq!(of("1;1.234,5\n2;1.234"), Ok((Decimal::Comma, true)));
        assert_eq!(of("1;1.234.567"), Ok((Decimal::Comma, true)));
        let quoted = of_rows(&Lines::of("0,\"12,345.5\"\n"), Delimiter::Byte(b',')).unwrap();
        assert!(quoted.has_thousands);
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
            "1;1,5\n2;1.234",
            "line 2, column 2: '1.234' and '1,5' in line 1",
        );
        refused(
            "1;1,2,3",
            "line 1, column 2: '1,2,3' has more than one separator",
        );
    }
}
