//! Where a text has its table: what separates cells, which lines are the header, and where the rows begin.

use crate::flight::Fault;

use super::super::{cell::unquote, code, fault::of_file, lines::{Line, Lines}};
use super::{
    delimiter::Delimiter,
    sample::{self, Held, Kind, Looked},
};

/// What a mapping, or nobody, says of the layout.
#[derive(Default, Clone, Copy)]
pub(super) struct Said {
    /// Lines before the table.
    pub(super) skip: usize,
    /// The number of the line of names.
    pub(super) header: Option<usize>,
    pub(super) delimiter: Option<Delimiter>,
}

/// A table in a text.
pub(super) struct Layout<'a> {
    pub(super) delimiter: Delimiter,
    /// Cells of a row.
    pub(super) width: usize,
    /// The lines above the rows with as many cells, from the top: names, units, descriptions, in whatever order.
    pub(super) above: Vec<(Line<'a>, Vec<&'a str>)>,
    /// A line above the rows that has another number of cells, where none has as many.
    pub(super) misfit: Option<(Line<'a>, usize)>,
    /// The rows, and the number of the line before them.
    pub(super) rows: Lines<'a>,
    /// The first rows that have as many cells.
    pub(super) first: Vec<Vec<&'a str>>,
}

/// The most lines of a header.
const HEADER_LINES: usize = 8;
/// The first rows, by which columns are judged.
const FIRST_ROWS: usize = 100;

/// Finds the table of a text.
///
/// # Errors
/// There are no rows of numbers.
pub(super) fn find<'a>(text: &'a str, said: Said) -> Result<Layout<'a>, Fault> {
    let mut lines = sample::lines(text, said.skip);
    let mut delimiter = said.delimiter;
    if let Some(at) = lines.iter().position(Looked::is_plain)
        && let Some(declared) = Delimiter::declared(lines[at].line)
    {
        delimiter = delimiter.or(Some(declared));
        lines.drain(..=at);
    }
    if !lines.iter().any(Looked::is_plain) {
        return Err(of_file(
            code::EMPTY_BODY,
            "the file has comments only; a header and rows should follow",
        ));
    }
    let candidates: Vec<Delimiter> = delimiter.map_or(Delimiter::ALL.to_vec(), |only| vec![only]);
    let best = candidates
        .into_iter()
        .filter_map(|delimiter| Block::of(&lines, delimiter))
        .reduce(|best, other| if other.score > best.score { other } else { best });
    match best {
        Some(block) => Ok(block.layout(&lines, said)),
        None => header_only(&lines, delimiter),
    }
}

/// A header without rows, as far as one can tell.
fn header_only<'a>(lines: &[Looked<'a>], delimiter: Option<Delimiter>) -> Result<Layout<'a>, Fault> {
    let first = lines.iter().find(|looked| looked.is_plain());
    let Some(first) = first.or(lines.first()) else {
        return Err(of_file(code::EMPTY_BODY, "the file has no lines"));
    };
    let delimiter = delimiter.or_else(|| {
        Delimiter::ALL.into_iter().find(|delimiter| delimiter.cells(first.line.text).len() > 1)
    });
    let delimiter = delimiter.unwrap_or(Delimiter::Byte(b','));
    let cells = delimiter.cells(first.line.text);
    Ok(Layout {
        delimiter,
        width: cells.len(),
        above: vec![(first.line, cells)],
        misfit: None,
        rows: first.behind.clone(),
        first: Vec::new(),
    })
}

/// The lines of one number of cells that hold the most values.
struct Block {
    delimiter: Delimiter,
    /// Cells of a line, an empty one behind a delimiter at its end included.
    count: usize,
    score: f64,
}

impl Block {
    /// The block of a delimiter; `None` where no line has a value.
    fn of(lines: &[Looked], delimiter: Delimiter) -> Option<Self> {
        // by number of cells, in the order in which they are met: lines with a value, values, texts
        let mut groups: Vec<(usize, [usize; 3])> = Vec::new();
        for looked in lines.iter().filter(|looked| looked.is_plain()) {
            let cells = delimiter.cells(looked.line.text);
            let (mut values, mut texts) = (0, 0);
            for held in cells.iter().map(|cell| Held::by(cell)) {
                values += usize::from(held == Held::Value);
                texts += usize::from(held == Held::Text);
            }
            if values == 0 {
                continue;
            }
            let counts = [1, values, texts];
            match groups.iter_mut().find(|(of, _)| *of == cells.len()) {
                Some((_, sums)) => (0..3).for_each(|at| sums[at] += counts[at]),
                None => groups.push((cells.len(), counts)),
            }
        }
        let more = |best: (usize, [usize; 3]), other: (usize, [usize; 3])| {
            if other.1[0] > best.1[0] { other } else { best }
        };
        let (count, [_, values, texts]) = groups.into_iter().reduce(more)?;
        let values = values as f64;
        Some(Self {
            delimiter,
            count,
            score: values * values / (values + texts as f64),
        })
    }

    fn layout<'a>(&self, lines: &[Looked<'a>], said: Said) -> Layout<'a> {
        let Self { delimiter, count, .. } = *self;
        let header = said.header.and_then(|number| lines.iter().position(|looked| looked.line.number == number));
        let rows = SampleRows::of(lines, delimiter, count);
        let start = match header {
            Some(at) => at + 1 + rows.start(&lines[at + 1..]),
            None => rows.start(lines),
        };
        let (above, misfit) = match header {
            Some(at) => (vec![(lines[at].line, delimiter.cells(lines[at].said()))], None),
            None => header_lines(&lines[..start], &rows),
        };
        let width = match above.iter().map(|(_, cells)| width(cells)).max() {
            Some(width) => width,
            None if rows.ends_empty => count - 1,
            None => count,
        };
        let mut first: Vec<_> = rows.rows(&lines[start..]).take(FIRST_ROWS).collect();
        first.iter_mut().for_each(|cells| cells.resize(width, ""));
        let above = above.into_iter().map(|(line, mut cells)| {
            cells.resize(width, "");
            (line, cells)
        });
        Layout {
            delimiter,
            width,
            above: above.collect(),
            misfit,
            rows: lines[start..].first().map_or(lines[lines.len() - 1].behind.clone(), |looked| looked.from.clone()),
            first,
        }
    }
}

/// The number of cells, an empty one behind the last delimiter left out.
fn width(cells: &[&str]) -> usize {
    match cells {
        [_, .., last] if last.trim().is_empty() => cells.len() - 1,
        _ => cells.len(),
    }
}

/// The rows of a sample: lines of one number of cells, with numbers where most rows have them.
struct SampleRows {
    delimiter: Delimiter,
    count: usize,
    is_numeric: Vec<bool>,
    /// All of them end with a delimiter.
    ends_empty: bool,
}

impl SampleRows {
    fn of(lines: &[Looked], delimiter: Delimiter, count: usize) -> Self {
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
    fn rows<'a, 'l>(&self, lines: &'l [Looked<'a>]) -> impl Iterator<Item = Vec<&'a str>> + use<'a, 'l> {
        let (delimiter, count) = (self.delimiter, self.count);
        let plain = lines.iter().filter(|looked| looked.is_plain());
        plain.map(move |looked| delimiter.cells(looked.line.text)).filter(move |cells| cells.len() == count)
    }

    /// Values, and texts where there should be some.
    fn held(&self, looked: &Looked) -> Option<(usize, usize)> {
        let cells = self.delimiter.cells(looked.line.text);
        if !looked.is_plain() || cells.len() != self.count {
            return None;
        }
        let (mut values, mut texts) = (0, 0);
        for (cell, _) in cells.iter().zip(&self.is_numeric).filter(|(_, is_numeric)| **is_numeric) {
            match Held::by(cell) {
                Held::Value => values += 1,
                Held::Text => texts += 1,
                Held::Nothing => {}
            }
        }
        Some((values, texts))
    }

    /// Words and ones: `1` is the unit of a pure number.
    fn has_units_only(&self, looked: &Looked) -> bool {
        let cells = self.delimiter.cells(looked.line.text);
        let held = |wanted: Held| move |cell: &&&str| Held::by(cell) == wanted;
        cells.iter().any(|cell| held(Held::Text)(&cell)) && cells.iter().filter(held(Held::Value)).all(|cell| unquote(cell) == "1")
    }

    /// Where the rows begin: at the first line of values that no line of texts of the same length follows soon. A line
    /// of numbers above the titles is one of channel numbers.
    fn start(&self, lines: &[Looked]) -> usize {
        let is_row = |at: usize| {
            let enough = |(values, texts): (usize, usize)| values > 0 && texts * 3 <= values;
            self.held(&lines[at]).is_some_and(enough) && !self.has_units_only(&lines[at])
        };
        let is_title = |at: usize| self.held(&lines[at]).is_some_and(|(values, texts)| values == 0 && texts > 0);
        let any_row = (0..lines.len()).find(|&at| is_row(at));
        let Some(mut start) = any_row.or_else(|| (0..lines.len()).find(|&at| self.held(&lines[at]).is_some_and(|(values, _)| values > 0))) else {
            return lines.len();
        };
        let titles: Vec<&str> = (0..start).filter(|&at| is_title(at)).map(|at| lines[at].line.text.trim()).collect();
        // a few lines on, and not where the logger began anew with the same header
        let soon = start..(start + 4).min(lines.len());
        if let Some(title) = soon.rev().find(|&at| is_title(at) && !titles.contains(&lines[at].line.text.trim()))
            && let Some(next) = (title..lines.len()).find(|&at| is_row(at))
        {
            start = next;
        }
        start
    }
}

type Above<'a> = Vec<(Line<'a>, Vec<&'a str>)>;

/// The lines above the rows with as many cells as they, from the top; or where there is none, the one above them.
fn header_lines<'a>(lines: &[Looked<'a>], rows: &SampleRows) -> (Above<'a>, Option<(Line<'a>, usize)>) {
    let mut above = Above::new();
    let mut misfit = None;
    for looked in lines.iter().rev() {
        match looked.kind {
            Kind::Blank if !above.is_empty() => break,
            Kind::Blank | Kind::Rule => continue,
            Kind::Comment | Kind::Plain => {}
        }
        let mut cells = rows.delimiter.cells(looked.said());
        if rows.delimiter == Delimiter::Blanks && cells.len() != rows.count {
            cells = by_wide_blanks(looked.said());
        }
        let is_as_wide = cells.len() == rows.count
            || (rows.ends_empty && cells.len() + 1 == rows.count)
            || (cells.len() == rows.count + 1 && width(&cells) == rows.count);
        if is_as_wide {
            above.push((looked.line, cells));
            if above.len() == HEADER_LINES {
                break;
            }
        } else if looked.is_plain() {
            misfit = Some((looked.line, cells.len())).filter(|_| above.is_empty());
            break;
        }
    }
    above.reverse();
    (above, misfit)
}

/// Titles with blanks in them stand two blanks apart.
fn by_wide_blanks(line: &str) -> Vec<&str> {
    let cells = line.split("  ").map(str::trim);
    cells.filter(|cell| !cell.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Delimiter, titles from the top, and the first row.
    fn found(text: &str) -> (Delimiter, Vec<String>, String) {
        let layout = find(text, Said::default()).unwrap_or_else(|fault| panic!("{text}: {fault}"));
        let above = layout.above.iter().map(|(_, cells)| cells.join("#"));
        let first = layout.rows.clone().next().map_or("", |line| line.text);
        (layout.delimiter, above.collect(), first.to_string())
    }

    #[test]
    fn the_delimiter_is_the_one_that_parts_most_numbers() {
        for (delimiter, text) in [
            (Delimiter::Byte(b','), "t,a\n0,1\n1,2\n"),
            (Delimiter::Byte(b';'), "t;a\n0,0;1,5\n0,1;2,5\n"),
            (Delimiter::Byte(b'\t'), "t\ta b\n0,0\t1,5\n0,1\t2,5\n"),
            (Delimiter::Bars, "| t | a |\n|---|---|\n| 0 | 1 |\n| 1 | 2 |\n"),
            (Delimiter::Blanks, "   t    a\n 0.0  1.5\n 0.1  2.5\n"),
            (Delimiter::Byte(b','), "t,mode\n2026-11-21 10:00:00,x y\n2026-11-21 10:00:01,x y\n"),
        ] {
            assert_eq!(found(text).0, delimiter, "{text}");
        }
    }

    #[test]
    fn the_header_is_what_stands_above_and_fits() {
        for (text, above, first) in [
            ("Test: 42\nRecorder,A\n\nt,a,b\ns,m,m\n0,1,2\n1,2,3\n", vec!["t#a#b", "s#m#m"], "0,1,2"),
            ("# run 7\n# t,a\n# an event\n0,1\n1,2\n", vec!["t#a"], "0,1"),
            ("1,2,3\nt,a,b\n0,1,2\n1,2,3\n2,3,4\n", vec!["1#2#3", "t#a#b"], "0,1,2"),
            ("0,1\n1,2\n", vec![], "0,1"),
            ("t,a,\n0,1,\n1,2,\n", vec!["t#a"], "0,1,"),
            ("t,a\n0,1,\n1,2,\n", vec!["t#a"], "0,1,"),
            ("t,a,\n0,1\n1,2\n", vec!["t#a"], "0,1"),
            ("t,a,b\n0,1,\n1,2,\n", vec!["t#a#b"], "0,1,"),
            ("Time  Angle of attack  q\n 0.0  1.5  2\n 0.1  2.5  3\n", vec!["Time#Angle of attack#q"], " 0.0  1.5  2"),
            ("t,a\n0,1\n\nx,2\n1,y\n2\n1,3\n", vec!["t#a"], "0,1"),
        ] {
            let (_, found_above, found_first) = found(text);
            assert_eq!((found_above, found_first.as_str()), (above.into_iter().map(str::to_string).collect(), first), "{text}");
        }
        let layout = find("t,a,b\n0,1\n1,2\n", Said::default()).unwrap();
        assert_eq!(layout.misfit.map(|(line, cells)| (line.number, cells)), Some((1, 3)));
    }

    #[test]
    fn what_is_said_holds() {
        let said = Said { skip: 2, header: Some(4), delimiter: None };
        let layout = find("1,2\n3,4\nnames,follow\nt,a\ns,m\n0,1\n1,2\n", said).unwrap();
        assert_eq!(layout.above[0].1, ["t", "a"]);
        assert_eq!(layout.rows.clone().next().unwrap().text, "0,1");
    }
}
