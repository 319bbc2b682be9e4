//! ASCII matrices (`.asc`, `.dat`, `save -ascii`): numbers separated by blanks, one row a sample, no header.

use crate::flight::Fault;

use super::{
    IngestError, Limits,
    cell::{Marks, number},
    code,
    fault::{CELLS_LISTED, pointer},
    lines::{Line, Lines},
    mapping::{Archive, Mapping},
    matrix::Matrix,
    reading::Reading,
    text::{decode, quoted},
};

/// Whether a text is a matrix of which a mapping names rows or columns: its first line has numbers only, and blanks between
/// them.
pub(super) fn is_matrix(bytes: &[u8], mapping: &Mapping) -> bool {
    let Ok(text) = decode(bytes) else {
        return false;
    };
    let is_number = |cell: &str| number(cell, Marks::POINT).is_some();
    let first = Lines::of(text).next();
    mapping.names_parts_of_one_matrix() && first.is_some_and(|line| cells(line).all(is_number))
}

/// Reads a matrix as the mapping says. Lines that begin with `#` or `%` are comments.
///
/// # Errors
/// The first 20 faults of rows and numbers; what the mapping names and the matrix does not have.
pub(super) fn read(
    bytes: &[u8],
    mapping: &Mapping,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    let text = decode(bytes)?;
    let lines = Lines::of(text);
    let columns = lines.clone().next().map_or(0, |line| cells(line).count());
    let rows = lines.clone().count();
    let too_much = [
        limits.columns(columns),
        limits.samples(rows),
        limits.values(rows.saturating_mul(columns)),
    ];
    IngestError::refuse(too_much.into_iter().flatten().collect())?;
    let mut table = Table {
        columns,
        values: Vec::with_capacity(rows * columns),
        faults: Vec::new(),
    };
    for (row, line) in lines.enumerate() {
        table.push(row + 1, line);
        if table.faults.len() >= CELLS_LISTED {
            break;
        }
    }
    IngestError::refuse(std::mem::take(&mut table.faults))?;
    mapping.apply(&mut table, limits)
}

fn cells(line: Line<'_>) -> impl Iterator<Item = &str> {
    line.text.split_ascii_whitespace()
}

struct Table {
    columns: usize,
    /// Row by row.
    values: Vec<f64>,
    faults: Vec<Fault>,
}

impl Table {
    fn push(&mut self, row: usize, line: Line) {
        let found = cells(line).count();
        if found != self.columns {
            let message = format!(
                "line {}: {found} number(s) where the first row has {}; every row of a matrix has as many",
                line.number, self.columns
            );
            self.faults
                .push(Fault::new(place(row), code::ROW_LENGTH, message));
            return;
        }
        for (at, cell) in cells(line).enumerate() {
            let value = number(cell, Marks::POINT);
            self.values.push(value.unwrap_or(f64::NAN));
            if value.is_none() {
                let message = format!(
                    "line {}, column {}: {} is not a number; a matrix has numbers with decimal points and blanks between them, a table with a header is CSV",
                    line.number,
                    at + 1,
                    quoted(cell)
                );
                self.faults
                    .push(Fault::new(place(row), code::NOT_A_NUMBER, message));
                return;
            }
        }
    }
}

fn place(row: usize) -> String {
    pointer(["rows", &row.to_string()])
}

impl Archive for Table {
    fn matrix(&mut self, _: &[String]) -> Result<Matrix<'_>, (&'static str, String)> {
        // a text has one matrix, whatever the mapping calls it
        Ok(Matrix::of_rows(&self.values, self.columns))
    }
}

#[cfg(test)]
mod tests {
    use super::super::fault::places;
    use super::*;
    use crate::flight::Maneuver;

    const MAPPING: &str = r#"{"time": {"from": "(:,1)", "unit": "s"},
        "channels": {"alpha": {"from": "fdata(:,3)", "unit": "deg"}, "mach": {"from": "(:,2)", "unit": "-"}}}"#;

    fn read_text(text: &str, limits: &Limits) -> Result<Maneuver, IngestError> {
        read(
            text.as_bytes(),
            &Mapping::from_json(MAPPING).unwrap(),
            limits,
        )
        .map(|reading| reading.maneuver)
    }

    #[test]
    fn columns_become_channels() {
        let text = "% saved\n  0.0000000e+00  5.0e-01 1.8e+02\r\n\n 4.0e-02\t5.0e-01  NaN \n";
        let maneuver = read_text(text, &Limits::default()).unwrap();
        assert_eq!(maneuver.time(), [0.0, 0.04]);
        let alpha = &maneuver.channels()["alpha"].values;
        assert!(alpha[0] == std::f64::consts::PI && alpha[1].is_nan());
        assert_eq!(maneuver.channels()["mach"].values, [0.5, 0.5]);
    }

    #[test]
    fn faults_name_line_and_column() {
        let refused = |text: &str| places(read_text(text, &Limits::default()));
        assert_eq!(
            refused("0 1 2\n1 2\n2 3 x\n"),
            ["row_length /rows/2", "not_a_number /rows/3"]
        );
        assert_eq!(refused("0,5 1 2\n"), ["not_a_number /rows/1"]);
        assert_eq!(
            refused("0 1\n1 2\n"),
            ["unknown_source /channels/alpha/from"]
        );
        assert_eq!(refused("0 1 2\n"), ["too_few_samples "]);
        assert_eq!(
            refused("1 1 2\n0 1 2\n"),
            ["time_not_increasing /time/values/1"]
        );
        assert_eq!(refused(" "), ["empty_body "]);
        assert_eq!(refused(&"x\n".repeat(100)).len(), CELLS_LISTED);
        let few = Limits {
            max_values: 5,
            ..Limits::default()
        };
        assert_eq!(
            places(read_text("0 1 2\n1 2 3\n", &few)),
            ["too_many_values "]
        );
    }
}
