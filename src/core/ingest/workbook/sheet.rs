//! A sheet as CSV: a line for each row, a cell for each column from the first that is used to the last.

use std::ops::RangeInclusive;

use super::super::{Limits, code, fault::of_file};
use super::damage::damaged;
use super::stamp::stamp;
use super::strings::Strings;
use super::styles::{Shows, Styles};
use super::xml::{Event, Events, attribute, text};
use crate::flight::Fault;

/// What cells refer to.
pub(super) struct Look {
    pub(super) strings: Strings,
    pub(super) styles: Styles,
    pub(super) has_dates_from_1904: bool,
}

/// Columns that a sheet can have.
const MOST_COLUMNS: usize = 16_384;
/// Rows that a sheet can have.
const MOST_ROWS: usize = 1_048_576;
/// Empty rows that are written, so that lines have the numbers of rows.
const MOST_EMPTY: usize = 1000;

/// The sheet; `None` where it has no table, that is fewer than three rows of two cells and more.
///
/// # Errors
/// The text becomes longer than `max_bytes`.
pub(super) fn to_csv(part: &str, look: &Look, limits: &Limits) -> Result<Option<String>, Fault> {
    let mut used: Option<RangeInclusive<usize>> = None;
    let mut rows = 0;
    cells(part, look, limits, |row| {
        let columns = row
            .cells
            .iter()
            .filter(|(_, cell)| !cell.is_empty())
            .map(|&(column, _)| column);
        let count = columns.clone().count();
        rows += usize::from(count >= 2);
        if let (Some(first), Some(last)) = (columns.clone().min(), columns.max()) {
            let (start, end) = used
                .clone()
                .map_or((first, last), RangeInclusive::into_inner);
            used = Some(start.min(first)..=end.max(last));
        }
        Ok(())
    })?;
    let Some(used) = used.filter(|_| rows >= 3) else {
        return Ok(None);
    };
    let mut csv = String::new();
    let mut line = 1;
    cells(part, look, limits, |row| {
        // rows in wrong order have no number that lines could have
        if row.number > line {
            let empty = row.number - line;
            (0..empty.min(MOST_EMPTY)).for_each(|_| csv.push('\n'));
        }
        line = line.max(row.number) + 1;
        let mut next = *used.start();
        for (column, cell) in &row.cells {
            if !used.contains(column) || *column < next {
                continue;
            }
            (next..*column).for_each(|_| csv.push(','));
            next = *column;
            csv.push_str(cell);
        }
        (next..*used.end()).for_each(|_| csv.push(','));
        csv.push('\n');
        if csv.len() > limits.max_bytes {
            return Err(too_long(limits));
        }
        Ok(())
    })?;
    Ok(Some(csv))
}

fn too_long(limits: &Limits) -> Fault {
    let message = format!(
        "the sheet is longer than {} bytes as CSV, the longest body that is taken; send fewer rows or columns",
        limits.max_bytes
    );
    of_file(code::UNPACKED_TOO_LARGE, message)
}

/// A row with its cells as CSV writes them, by column from 0.
struct Row {
    /// From 1.
    number: usize,
    cells: Vec<(usize, String)>,
}

/// Goes through the rows of a sheet.
///
/// # Errors
/// Those of `each`; the cells are longer than `max_bytes`, or more in a row than a sheet has columns.
fn cells(
    part: &str,
    look: &Look,
    limits: &Limits,
    mut each: impl FnMut(&Row) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let mut row = Row {
        number: 0,
        cells: Vec::new(),
    };
    let mut cell = Cell::default();
    let mut length = 0;
    let mut take = |row: &mut Row, cell: &Cell| {
        if cell.column >= MOST_COLUMNS {
            return Ok(());
        }
        if row.cells.len() == MOST_COLUMNS {
            let message = format!("row {} has more than {MOST_COLUMNS} cells", row.number);
            return Err(damaged(&message));
        }
        let csv = cell.csv(look);
        length += csv.len();
        if length > limits.max_bytes {
            return Err(too_long(limits));
        }
        row.cells.push((cell.column, csv));
        Ok(())
    };
    for event in Events::of(part) {
        match event {
            Event::Open {
                name: "row",
                attributes,
                is_empty,
            } => {
                let number = attribute(attributes, "r").and_then(|number| number.parse().ok());
                let number = number.filter(|&number| number <= MOST_ROWS);
                row.number = number.unwrap_or(row.number + 1);
                row.cells.clear();
                if is_empty {
                    continue;
                }
            }
            Event::Close("row") => each(&row)?,
            Event::Open {
                name: "c",
                attributes,
                is_empty,
            } => {
                let next = row.cells.last().map_or(0, |(column, _)| column + 1);
                let place = attribute(attributes, "r").and_then(column);
                cell = Cell {
                    column: place.unwrap_or(next),
                    kind: attribute(attributes, "t").unwrap_or("n"),
                    style: attribute(attributes, "s"),
                    value: String::new(),
                    is_value: false,
                };
                if is_empty {
                    take(&mut row, &cell)?;
                }
            }
            Event::Open {
                name: "v" | "t",
                is_empty,
                ..
            } => cell.is_value = !is_empty,
            Event::Close("v" | "t") => cell.is_value = false,
            Event::Text(written) if cell.is_value => cell.value.push_str(&text(written)),
            Event::Plain(plain) if cell.is_value => cell.value.push_str(plain),
            Event::Close("c") => take(&mut row, &cell)?,
            _ => {}
        }
    }
    Ok(())
}

#[derive(Default)]
struct Cell<'a> {
    column: usize,
    kind: &'a str,
    style: Option<&'a str>,
    value: String,
    is_value: bool,
}

impl Cell<'_> {
    fn csv(&self, look: &Look) -> String {
        let value = self.value.trim();
        match self.kind {
            "s" => {
                let at = value.parse().ok();
                quoted(at.and_then(|at| look.strings.get(at)).unwrap_or_default())
            }
            // an error, as #N/A
            "e" => String::new(),
            "n" | "" => match (value.parse::<f64>(), look.styles.shows(self.style)) {
                (Ok(days), shows @ (Shows::Date | Shows::Time)) => {
                    let stamp = stamp(days, shows, look.has_dates_from_1904);
                    stamp.unwrap_or_else(|| value.to_string())
                }
                _ => quoted(value),
            },
            _ => quoted(value),
        }
    }
}

/// The column of a place such as `BC7`, from 0.
fn column(place: &str) -> Option<usize> {
    let letters = place.bytes().take_while(u8::is_ascii_alphabetic);
    let number = letters.take(4).fold(0, |number, letter| {
        26 * number + usize::from(letter.to_ascii_uppercase() - b'A') + 1
    });
    number.checked_sub(1)
}

/// A text as CSV has it (RFC 4180), on one line.
fn quoted(text: &str) -> String {
    let line = text.replace(['\r', '\n'], " ");
    if line.contains([',', ';', '"', '\t']) {
        format!("\"{}\"", line.replace('"', "\"\""))
    } else {
        line
    }
}
