//! How a file is written.

use super::super::{
    cell::{Decimal, unquote},
    lines::Lines,
};

/// What separates cells, and what the digits of a number.
pub(super) struct Dialect {
    pub delimiter: char,
    /// The header has a delimiter behind its last cell: so may rows.
    pub ends_with_delimiter: bool,
    pub decimal: Decimal,
}

impl Dialect {
    pub(super) fn cells<'a>(&self, line: &'a str) -> impl Iterator<Item = &'a str> {
        self.without_end(line).split(self.delimiter)
    }

    fn without_end<'a>(&self, line: &'a str) -> &'a str {
        let shorter = line.trim_end_matches(' ').strip_suffix(self.delimiter);
        shorter.filter(|_| self.ends_with_delimiter).unwrap_or(line)
    }

    /// The cells of the first row, if there are as many as the header has.
    pub(super) fn first_row<'a>(&self, mut rows: Lines<'a>, width: usize) -> Vec<&'a str> {
        let row = rows.next().filter(|row| self.count(row.text) == width);
        row.map_or(Vec::new(), |row| {
            self.cells(row.text).map(unquote).collect()
        })
    }

    pub(super) fn count(&self, line: &str) -> usize {
        // all delimiters are of one byte, and these are counted fast
        let is_delimiter = |&byte: &u8| char::from(byte) == self.delimiter;
        let bytes = self.without_end(line).bytes();
        1 + bytes.filter(is_delimiter).count()
    }
}
