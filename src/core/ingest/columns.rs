//! A table whose cells are numbers, times or words already, column by column.

use std::borrow::Cow;

use jiff::Timestamp;

/// Columns of one length.
#[derive(Debug, Default)]
pub(super) struct Columns {
    pub(super) list: Vec<Column>,
    pub(super) rows: usize,
    /// Titles of columns that are none of a table, and why.
    pub(super) left_out: Vec<(String, String)>,
}

#[derive(Debug)]
pub(super) struct Column {
    pub(super) title: String,
    /// Empty where the file says none beside the title.
    pub(super) unit: &'static str,
    pub(super) cells: Cells,
}

/// The cells of a column, one for each row.
#[derive(Debug)]
pub(super) enum Cells {
    /// NaN where there is no value.
    Doubles(Vec<f64>),
    /// [`NONE`] where there is no value.
    Integers(Vec<i64>),
    /// Nanoseconds since 1970; [`NONE`] where there is no value.
    Instants(Vec<i64>),
    Texts(Texts),
}

/// No value. pandas writes it so, too, where there is no time.
pub(super) const NONE: i64 = i64::MIN;

/// Texts one behind the other.
#[derive(Debug, Default)]
pub(super) struct Texts {
    text: String,
    ends: Vec<usize>,
}

impl Texts {
    /// A text with what is no UTF-8 in it replaced.
    pub(super) fn push(&mut self, bytes: &[u8]) {
        self.text.push_str(&String::from_utf8_lossy(bytes));
        self.ends.push(self.text.len());
    }

    pub(super) fn get(&self, at: usize) -> &str {
        let start = at.checked_sub(1).and_then(|before| self.ends.get(before));
        let start = start.copied().unwrap_or(0);
        let text = self.ends.get(at).and_then(|&end| self.text.get(start..end));
        text.unwrap_or_default()
    }

    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }
}

impl Cells {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Doubles(values) => values.len(),
            Self::Integers(values) | Self::Instants(values) => values.len(),
            Self::Texts(texts) => texts.len(),
        }
    }

    /// A cell as a table of text would have it; empty where there is no value.
    pub(super) fn text(&self, row: usize) -> Cow<'_, str> {
        let text = match self {
            Self::Doubles(values) => values.get(row).map(|&value| double(value)),
            Self::Integers(values) => known(values, row).map(|value| value.to_string()),
            Self::Instants(values) => known(values, row).map(instant),
            Self::Texts(texts) => return Cow::Borrowed(texts.get(row)),
        };
        Cow::Owned(text.unwrap_or_default())
    }
}

fn known(values: &[i64], row: usize) -> Option<i64> {
    values.get(row).copied().filter(|&value| value != NONE)
}

fn double(value: f64) -> String {
    let size = value.abs();
    match value.is_finite() {
        false => String::new(),
        true if size == 0.0 || (1e-5..1e16).contains(&size) => value.to_string(),
        true => format!("{value:e}"),
    }
}

fn instant(nanoseconds: i64) -> String {
    let stamp = Timestamp::from_nanosecond(nanoseconds.into());
    stamp.map_or(String::new(), |stamp| stamp.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_written_as_a_table_of_text_has_them() {
        let doubles = Cells::Doubles(vec![0.04, -1e-9, f64::NAN, 1e300]);
        let texts: Vec<_> = (0..5).map(|row| doubles.text(row)).collect();
        assert_eq!(texts, ["0.04", "-1e-9", "", "1e300", ""]);
        let integers = Cells::Integers(vec![1_795_255_200_123_456_789, NONE]);
        assert_eq!(integers.text(0), "1795255200123456789");
        assert_eq!(integers.text(1), "");
        let instants = Cells::Instants(vec![1_795_255_200_040_000_000, NONE]);
        assert_eq!(instants.text(0), "2026-11-21T10:00:00.04Z");
        let mut texts = Texts::default();
        for text in [&b"a"[..], b"", b"b\xff"] {
            texts.push(text);
        }
        assert_eq!(
            [texts.get(0), texts.get(1), texts.get(2)],
            ["a", "", "b\u{fffd}"]
        );
        assert_eq!((texts.get(9), texts.len()), ("", 3));
    }
}
