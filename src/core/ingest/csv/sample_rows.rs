//! The rows among the first lines of a file: where they begin, and which of their columns have numbers.

use super::super::{cell::unquote, lines::Line};
use super::{
    delimiter::Delimiter,
    sample::{Held, Looked},
};

/// The number of cells, an empty one behind the last delimiter left out.
pub(super) fn width(cells: &[&str]) -> usize {
    match cells {
        [_, .., last] if last.trim().is_empty() => cells.len() - 1,
        _ => cells.len(),
    }
}

/// The rows of a sample: lines of one number of cells, with numbers where most rows have them.
pub(super) struct SampleRows {
    pub(super) delimiter: Delimiter,
    pub(super) count: usize,
    is_numeric: Vec<bool>,
    /// All of them end with a delimiter.
    pub(super) ends_empty: bool,
}

impl SampleRows {
    pub(super) fn of(lines: &[Looked], delimiter: Delimiter, count: usize) -> Self {
        let mut rows = Self {
            delimiter,
            count,
            is_numeric: Vec::new(),
            ends_empty: false,
        };
        let all: Vec<Vec<&str>> = rows.rows(lines).collect();
        // what is above the rows is not in the second half of all lines of their length
        let later = &all[all.len() / 2..];
        let is_numeric = |at: usize| {
            let held = later.iter().map(|cells| Held::by(cells[at]));
            let values = held.clone().filter(|&held| held == Held::Value).count();
            let texts = held.filter(|&held| held == Held::Text).count();
            values > 0 && values >= texts
        };
        rows.is_numeric = (0..count).map(is_numeric).collect();
        rows.ends_empty = count > 1
            && delimiter != Delimiter::Blanks
            && later.iter().all(|cells| cells[count - 1].trim().is_empty());
        rows
    }

    /// The cells of the lines that have as many.
    pub(super) fn rows<'a, 'l>(
        &self,
        lines: &'l [Looked<'a>],
    ) -> impl Iterator<Item = Vec<&'a str>> + use<'a, 'l> {
        let (delimiter, count) = (self.delimiter, self.count);
        let plain = lines.iter().filter(|looked| looked.is_plain());
        plain
            .map(move |looked| delimiter.cells(looked.line.text))
            .filter(move |cells| cells.len() == count)
    }

    /// The cells of a line as the rows have them. Rows without a remark have no cell for it: its title does not count, nor does a
    /// remark.
    pub(super) fn titles<'a>(&self, looked: &Looked<'a>) -> Vec<&'a str> {
        let said = looked.said();
        // FlySight 2 says with a word of its own which line of the header is which
        let said = ["$COL,", "$UNIT,"]
            .iter()
            .find_map(|word| said.strip_prefix(word))
            .unwrap_or(said);
        let mut cells = self.delimiter.cells(said);
        if cells.len() == self.count + 1 && cells.last().is_some_and(|last| is_remark(last)) {
            cells.pop();
        }
        cells
    }

    /// The titles in the line above the rows, where these begin with a name or a number of their own that has no title, as R and
    /// pandas write them.
    pub(super) fn behind_row_names<'a>(
        &self,
        lines: &[Looked<'a>],
        start: usize,
        misfit: Option<(Line<'a>, usize)>,
    ) -> Option<(Line<'a>, Vec<&'a str>)> {
        let (line, _) = misfit?;
        let cells = self.delimiter.cells(line.text);
        if cells.len() + 1 != self.count {
            return None;
        }
        let rows: Vec<Vec<&str>> = self.rows(&lines[start..]).take(50).collect();
        let number = |row: &Vec<&str>| unquote(row[0]).parse::<i64>().ok();
        let numbers: Option<Vec<i64>> = rows.iter().map(number).collect();
        let numbers = numbers.filter(|numbers| numbers.len() > 1 && numbers[0] <= 1)?;
        let are_counted = numbers.windows(2).all(|pair| pair[1] == pair[0] + 1);
        let mut titles = vec![""];
        titles.extend(cells);
        are_counted.then_some((line, titles))
    }

    /// What the columns of numbers hold in a line.
    fn held(&self, looked: &Looked) -> Option<Vec<Held>> {
        let cells = self.titles(looked);
        if !looked.is_plain() || cells.len() != self.count {
            return None;
        }
        let numeric = cells.iter().zip(&self.is_numeric);
        let numeric = numeric.filter(|(_, is_numeric)| **is_numeric);
        Some(numeric.map(|(cell, _)| Held::by(cell)).collect())
    }

    /// Where the rows begin: at the first line of values that no line of texts of the same length follows soon. A line
    /// of numbers above the titles is one of channel numbers.
    pub(super) fn start(&self, lines: &[Looked]) -> usize {
        let is_row = |at: usize| {
            let Some(held) = self.held(&lines[at]) else {
                return false;
            };
            // a sample begins with its time; `1` may be the unit of a pure number
            match held.first() {
                Some(Held::Value) => true,
                Some(Held::Nothing) => held.contains(&Held::Value) && !held.contains(&Held::Text),
                _ => false,
            }
        };
        let is_title = |at: usize| {
            let held = self.held(&lines[at]);
            held.is_some_and(|held| held.contains(&Held::Text) && !held.contains(&Held::Value))
        };
        let Some(mut start) = (0..lines.len()).find(|&at| is_row(at)) else {
            return lines.len();
        };
        let titles: Vec<&str> = (0..start)
            .filter(|&at| is_title(at))
            .map(|at| lines[at].line.text.trim())
            .collect();
        loop {
            // a few lines on, and not where the logger began anew with the same header
            let mut soon = start..(start + 4).min(lines.len());
            let title =
                soon.rfind(|&at| is_title(at) && !titles.contains(&lines[at].line.text.trim()));
            match title.and_then(|title| (title..lines.len()).find(|&at| is_row(at))) {
                Some(next) => start = next,
                None => return start,
            }
        }
    }
}

fn is_remark(title: &str) -> bool {
    let title = unquote(title).to_ascii_lowercase();
    let words = [
        "comment", "comments", "remark", "remarks", "note", "notes", "message",
    ];
    title.starts_with('#') || words.contains(&title.as_str())
}

/// Titles with blanks in them stand two blanks apart.
pub(super) fn by_wide_blanks(line: &str) -> Vec<&str> {
    let cells = line.split("  ").map(str::trim);
    cells.filter(|cell| !cell.is_empty()).collect()
}
