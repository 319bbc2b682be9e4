//! Answers as CSV, with `name[unit]` headers as the uploads have them.

use std::fmt::Write;

use crate::http::problem::Problem;

/// Cells in rows; an empty cell is a missing value.
pub(crate) struct Csv {
    writer: csv::Writer<Vec<u8>>,
    number: String,
}

impl Csv {
    pub(crate) fn with_header<S: AsRef<[u8]>>(
        names: impl IntoIterator<Item = S>,
    ) -> csv::Result<Self> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(names)?;
        Ok(Self {
            writer,
            number: String::new(),
        })
    }

    pub(crate) fn text(&mut self, cell: &str) -> csv::Result<()> {
        self.writer.write_field(cell)
    }

    /// The shortest text that reads back to the same number; a missing one is empty.
    pub(crate) fn number(&mut self, value: Option<f64>) -> csv::Result<()> {
        self.number.clear();
        if let Some(value) = value.filter(|value| !value.is_nan()) {
            // writing to a string does not fail
            let _ = write!(self.number, "{value:?}");
        }
        self.writer.write_field(&self.number)
    }

    pub(crate) fn end_row(&mut self) -> csv::Result<()> {
        self.writer.write_record(None::<&[u8]>)
    }

    pub(crate) fn into_bytes(self) -> csv::Result<Vec<u8>> {
        self.writer
            .into_inner()
            .map_err(|error| csv::Error::from(error.into_error()))
    }
}

/// `name[unit]`; a pure number has no unit.
pub(crate) fn header(name: &str, unit: &str) -> String {
    match unit {
        "" | "-" => name.to_string(),
        unit => format!("{name}[{unit}]"),
    }
}

impl From<csv::Error> for Problem {
    fn from(error: csv::Error) -> Self {
        tracing::error!(%error, "csv");
        Self::internal()
    }
}

impl From<serde_json::Error> for Problem {
    /// Of *writing* JSON; what is wrong with JSON that was read is said by `json`.
    fn from(error: serde_json::Error) -> Self {
        tracing::error!(%error, "json");
        Self::internal()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_quoted_where_they_must_be() {
        let mut csv = Csv::with_header([header("alpha", "rad"), header("mach", "-")]).unwrap();
        for row in [[Some(0.1), Some(f64::NAN)], [Some(1e-300), None]] {
            for cell in row {
                csv.number(cell).unwrap();
            }
            csv.end_row().unwrap();
        }
        csv.text("a,b").unwrap();
        csv.text("\"c\"").unwrap();
        csv.end_row().unwrap();
        let text = String::from_utf8(csv.into_bytes().unwrap()).unwrap();
        assert_eq!(
            text,
            "alpha[rad],mach\n0.1,\n1e-300,\n\"a,b\",\"\"\"c\"\"\"\n"
        );
    }
}
