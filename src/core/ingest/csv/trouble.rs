//! Rows that are no samples, and how the table is written that they do not fit.

use super::super::{cell::Marks, code, fault::pointer, lines::Line, text::quoted};
use super::delimiter::Delimiter;
use crate::flight::Fault;

/// How a table is written.
pub(super) struct Written<'a> {
    pub(super) delimiter: Delimiter,
    pub(super) marks: Marks,
    pub(super) width: usize,
    /// Lines that are no rows wherever they stand again: those of the header.
    pub(super) header: Vec<&'a str>,
    /// What the column of time is called.
    pub(super) time: String,
    /// The text does not end with a line's end.
    pub(super) is_cut_off: bool,
}

/// Why a line is no sample.
pub(super) enum Trouble {
    Length(usize),
    NoTime,
    Time(String, String),
    /// Nothing but delimiters.
    Empty,
}

impl Trouble {
    /// The fault of a row.
    pub(super) fn fault(&self, row: usize, line: &Line, written: &Written) -> Fault {
        let number = line.number;
        let name = &written.time;
        let in_row = || pointer(["rows", &row.to_string()]);
        let in_cell = || pointer(["rows", &row.to_string(), name]);
        match self {
            Trouble::Length(found) => {
                let width = written.width;
                let with_decimal_commas =
                    if written.delimiter == Delimiter::Byte(b',') && *found > width {
                        "; where numbers have decimal commas, separate cells by semicolons"
                    } else {
                        ""
                    };
                let message = format!(
                    "line {number}: row {row} has {found} cell(s) where the header has {width} columns; write one cell for each, empty where there is no value{with_decimal_commas}; if the table ends here, cut the file there"
                );
                Fault::new(in_row(), code::ROW_LENGTH, message)
            }
            Trouble::NoTime | Trouble::Empty => {
                let message = format!(
                    "line {number}: time is missing or not a number in row {row}; every row needs a time"
                );
                Fault::new(in_cell(), code::TIME_MISSING, message)
            }
            Trouble::Time(cell, why) => {
                let message = format!("line {number}: {} in column '{name}' {why}", quoted(cell));
                Fault::new(in_cell(), code::NOT_A_NUMBER, message)
            }
        }
    }
}
