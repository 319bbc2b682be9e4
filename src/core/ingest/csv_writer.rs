//! CSV as it is written here: a line of names, then rows of numbers and words.

use std::fmt::Write;

/// A CSV file that grows cell by cell.
#[derive(Default)]
pub struct CsvWriter {
    text: String,
    is_in_row: bool,
}

impl CsvWriter {
    /// Begins with a row of names.
    pub fn with_header<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> Self {
        let mut csv = Self::default();
        for name in names {
            csv.text(name.as_ref());
        }
        csv.end_row();
        csv
    }

    /// A cell of text, quoted where it must be. What a spreadsheet would take for a formula has a `'` before it.
    pub fn text(&mut self, cell: &str) {
        self.begin_cell();
        let escaped = is_formula(cell).then(|| format!("'{cell}"));
        let cell = escaped.as_deref().unwrap_or(cell);
        if cell.contains(['"', ',', '\n', '\r']) {
            // writing to a string does not fail
            let _ = write!(self.text, "\"{}\"", cell.replace('"', "\"\""));
        } else {
            self.text.push_str(cell);
        }
    }

    /// The shortest text that reads back to the same double; an empty cell for a missing one.
    pub fn number(&mut self, value: impl Into<Option<f64>>) {
        self.begin_cell();
        if let Some(value) = value.into().filter(|value| !value.is_nan()) {
            // Debug writes 1e-300 with an exponent, where Display writes 300 zeros
            let _ = write!(self.text, "{value:?}");
        }
    }

    /// Ends the row; what follows begins the next.
    pub fn end_row(&mut self) {
        self.text.push('\n');
        self.is_in_row = false;
    }

    /// The whole file.
    #[must_use]
    pub fn finish(self) -> String {
        self.text
    }

    fn begin_cell(&mut self) {
        if self.is_in_row {
            self.text.push(',');
        }
        self.is_in_row = true;
    }
}

/// Whether a spreadsheet would work out a cell rather than show it: labels are anybody's, and formulas can send what the
/// sheet has elsewhere. A number with its sign is a number.
fn is_formula(cell: &str) -> bool {
    match cell.bytes().next() {
        Some(b'=' | b'@' | b'\t' | b'\r') => true,
        Some(b'+' | b'-') => cell.len() > 1 && cell.parse::<f64>().is_err(),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_cell_is_a_formula() {
        let cells = [
            "=1+1", "+1+1", "-1+1", "@SUM(A1)", "\t=1", "\r=1", "-1.5", "+2e3", "-", "a=b", "",
        ];
        let mut csv = CsvWriter::default();
        for cell in cells {
            csv.text(cell);
        }
        csv.number(-1.0);
        assert_eq!(
            csv.finish(),
            "'=1+1,'+1+1,'-1+1,'@SUM(A1),'\t=1,\"'\r=1\",-1.5,+2e3,-,a=b,,-1.0"
        );
    }

    #[test]
    fn cells_are_quoted_where_they_must_be() {
        let mut csv = CsvWriter::with_header(["alpha[rad]", "mach"]);
        for row in [[Some(0.1), Some(f64::NAN)], [Some(1e-300), None]] {
            for cell in row {
                csv.number(cell);
            }
            csv.end_row();
        }
        csv.text("a,b");
        csv.text("\"c\"");
        csv.end_row();
        assert_eq!(
            csv.finish(),
            "alpha[rad],mach\n0.1,\n1e-300,\n\"a,b\",\"\"\"c\"\"\"\n"
        );
    }
}
