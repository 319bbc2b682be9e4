//! The rows of a CSV file: one a sample, each cell a number, a time stamp, or nothing.

use indexmap::IndexMap;

use crate::flight::{Fault, Maneuver};

use super::super::{
    IngestError,
    axis::{TimeAxis, code_of},
    cell::{is_missing, number, unquote},
    code,
    fault::{CELLS_LISTED, of_file, pointer},
    header::{Column, Header},
    lines::{Line, Lines},
    stamp::{Stamp, Stopwatch},
    text::quoted,
};
use super::dialect::Dialect;

/// Reads all rows; `capacity` is about how many there are.
///
/// # Errors
/// The first [`CELLS_LISTED`] faults of rows and cells.
pub(super) fn read(
    rows: Lines,
    dialect: &Dialect,
    header: &Header,
    capacity: usize,
) -> Result<Maneuver, IngestError> {
    let columns = header.columns.iter();
    let Some(time) = header.columns.get(header.time).and_then(Option::as_ref) else {
        return Err(of_file(code::NO_TIME_COLUMN, "there is no column of time").into());
    };
    let mut table = Table {
        dialect,
        header,
        axis: TimeAxis::new(time.unit.unit(), capacity),
        watch: Stopwatch::default(),
        time,
        values: columns
            .map(|column| Vec::with_capacity(column.as_ref().map_or(0, |_| capacity)))
            .collect(),
        faults: Vec::new(),
    };
    for (row, line) in rows.enumerate() {
        table.push(row + 1, line);
        if table.faults.len() >= CELLS_LISTED {
            table.faults.truncate(CELLS_LISTED);
            break;
        }
    }
    table.maneuver()
}

struct Table<'a> {
    dialect: &'a Dialect,
    header: &'a Header,
    time: &'a Column,
    axis: TimeAxis,
    watch: Stopwatch,
    /// One list a column; that of time stays empty, and so do those that are left out.
    values: Vec<Vec<f64>>,
    faults: Vec<Fault>,
}

impl Table<'_> {
    fn push(&mut self, row: usize, line: Line) {
        let (found, expected) = (self.dialect.count(line.text), self.header.columns.len());
        if found != expected {
            self.faults.push(self.row_length(row, line, found));
            self.axis.skip();
            return;
        }
        for (at, cell) in self.dialect.cells(line.text).enumerate() {
            if at == self.header.time {
                self.push_time(row, line, cell);
                continue;
            }
            let Some(column) = &self.header.columns[at] else {
                continue;
            };
            let value = number(cell, self.dialect.decimal);
            self.values[at].push(value.unwrap_or(f64::NAN));
            if value.is_none() {
                self.faults.push(not_a_number(row, line, column, cell));
            }
        }
    }

    fn push_time(&mut self, row: usize, line: Line, cell: &str) {
        let column = self.time;
        let time = if self.header.has_stamps {
            self.stamp(cell)
        } else {
            number(cell, self.dialect.decimal).ok_or_else(|| NOT_A_NUMBER.to_string())
        };
        let fault = match time {
            Ok(time) => {
                let pushed = self.axis.push(time);
                pushed.map_err(|error| {
                    let message = format!("line {}: {error}", line.number);
                    Fault::new(cell_pointer(row, column), code_of(&error), message)
                })
            }
            Err(why) => {
                self.axis.skip();
                Err(not_readable(row, line, column, cell, &why))
            }
        };
        self.faults.extend(fault.err());
    }

    /// Seconds since the first time stamp; NaN where the cell is empty.
    fn stamp(&mut self, cell: &str) -> Result<f64, String> {
        if is_missing(unquote(cell)) {
            return Ok(f64::NAN);
        }
        let stamp = Stamp::parse(cell).ok_or("is not a time stamp like that of the first row; write all alike, as in 2026-11-21T12:00:00.123Z or 12:00:00.123")?;
        self.watch
            .seconds(stamp)
            .map_err(|why| format!("does not fit: {why}"))
    }

    fn maneuver(self) -> Result<Maneuver, IngestError> {
        IngestError::refuse(self.faults)?;
        let mut channels = IndexMap::with_capacity(self.values.len());
        for (at, (column, values)) in self.header.columns.iter().zip(self.values).enumerate() {
            if let Some(column) = column
                && at != self.header.time
            {
                channels.insert(column.name.clone(), column.unit.channel(values));
            }
        }
        Maneuver::new(self.axis.into_seconds(), channels)
            .map_err(|error| of_file(code_of(&error), error.to_string()).into())
    }

    fn row_length(&self, row: usize, line: Line, found: usize) -> Fault {
        let expected = self.header.columns.len();
        let with_decimal_commas = if self.dialect.delimiter == ',' && found > expected {
            "; where numbers have decimal commas, separate cells by semicolons"
        } else {
            ""
        };
        let message = format!(
            "line {}: row {row} has {found} cell(s) where the header has {expected} columns; write one cell for each, empty where there is no value{with_decimal_commas}",
            line.number
        );
        Fault::new(
            pointer(["rows", &row.to_string()]),
            code::ROW_LENGTH,
            message,
        )
    }
}

const NOT_A_NUMBER: &str =
    "is not a number; write it like -1.5e-3, or leave the cell empty where there is no value";

fn not_a_number(row: usize, line: Line, column: &Column, cell: &str) -> Fault {
    not_readable(row, line, column, cell, NOT_A_NUMBER)
}

fn not_readable(row: usize, line: Line, column: &Column, cell: &str, why: &str) -> Fault {
    let (number, cell, name) = (line.number, quoted(cell.trim()), &column.name);
    let message = format!("line {number}: {cell} in column '{name}' {why}");
    Fault::new(cell_pointer(row, column), code::NOT_A_NUMBER, message)
}

fn cell_pointer(row: usize, column: &Column) -> String {
    pointer(["rows", &row.to_string(), &column.name])
}
