//! Where a text has its table: what separates cells, which lines are the header, and where the rows begin.

use crate::flight::Fault;

use super::super::{
    code,
    fault::of_file,
    lines::{Line, Lines},
};
use super::{
    delimiter::Delimiter,
    elsewhere,
    head::share_of_units,
    labview::units_of_labview,
    sample::{self, Held, Kind, Looked},
    sample_rows::{SampleRows, by_wide_blanks, width},
    stated::{self, Announced},
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
    /// The step between samples that the lines above say.
    pub(super) announced: Option<Announced>,
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
        .reduce(|best, other| {
            if other.score > best.score {
                other
            } else {
                best
            }
        });
    match best {
        Some(block) => Ok(block.layout(&lines, said)),
        None => header_only(&lines, delimiter),
    }
}

/// A header without rows, as far as one can tell.
fn header_only<'a>(
    lines: &[Looked<'a>],
    delimiter: Option<Delimiter>,
) -> Result<Layout<'a>, Fault> {
    let first = lines.iter().find(|looked| looked.is_plain());
    let Some(first) = first.or(lines.first()) else {
        return Err(of_file(code::EMPTY_BODY, "the file has no lines"));
    };
    let delimiter = delimiter.or_else(|| {
        Delimiter::ALL
            .into_iter()
            .find(|delimiter| delimiter.cells(first.line.text).len() > 1)
    });
    let delimiter = delimiter.unwrap_or(Delimiter::Byte(b','));
    let cells = delimiter.cells(first.line.text);
    Ok(Layout {
        delimiter,
        width: cells.len(),
        above: vec![(first.line, cells)],
        misfit: None,
        rows: first.behind.clone(),
        announced: None,
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

/// How much lines look like samples.
struct Weight {
    /// The lines, each by the square of its share of values.
    lines: f64,
    /// The values, by half where there is one in a line.
    score: f64,
    values: f64,
    texts: f64,
}

/// The cells of a line that are looked at.
const CELLS: usize = 4000;

impl Weight {
    fn of(cells: &[&str]) -> Self {
        let (mut values, mut texts) = (0.0, 0.0);
        for held in cells.iter().take(CELLS).map(|cell| Held::by(cell)) {
            values += f64::from(u8::from(held == Held::Value));
            texts += f64::from(u8::from(held == Held::Text));
        }
        let share: f64 = if values > 0.0 {
            values / (values + texts)
        } else {
            0.0
        };
        // a single number is hardly a sample
        let one = if cells.len() == 1 { 0.5 } else { 1.0 };
        Self {
            lines: one * share * share,
            score: one * values,
            values,
            texts,
        }
    }

    fn add(&mut self, other: &Self) {
        self.lines += other.lines;
        self.score += other.score;
        self.values += other.values;
        self.texts += other.texts;
    }
}

impl Block {
    /// The block of a delimiter; `None` where no line has a value.
    fn of(lines: &[Looked], delimiter: Delimiter) -> Option<Self> {
        // by number of cells, in the order in which they are met
        let mut groups: Vec<(usize, Weight)> = Vec::new();
        for looked in lines.iter().filter(|looked| looked.is_plain()) {
            let cells = delimiter.cells(looked.line.text);
            let weight = Weight::of(&cells);
            if weight.values == 0.0 {
                continue;
            }
            match groups.iter_mut().find(|(count, _)| *count == cells.len()) {
                Some((_, sum)) => sum.add(&weight),
                None => groups.push((cells.len(), weight)),
            }
        }
        let more = |best: (usize, Weight), other: (usize, Weight)| {
            if other.1.lines > best.1.lines {
                other
            } else {
                best
            }
        };
        let (count, weight) = groups.into_iter().reduce(more)?;
        // blanks part whatever another delimiter parts, and more: they must be clearly better
        let preference = if delimiter == Delimiter::Blanks {
            0.6
        } else {
            1.0
        };
        Some(Self {
            delimiter,
            count,
            score: preference * weight.score * weight.values / (weight.values + weight.texts),
        })
    }

    fn layout<'a>(&self, lines: &[Looked<'a>], said: Said) -> Layout<'a> {
        let Self {
            delimiter, count, ..
        } = *self;
        let header = said
            .header
            .and_then(|number| lines.iter().position(|looked| looked.line.number == number));
        let rows = SampleRows::of(lines, delimiter, count);
        let start = match header {
            Some(at) => at + 1 + rows.start(&lines[at + 1..]),
            None => rows.start(lines),
        };
        let (mut above, mut misfit) = match header {
            Some(at) => (
                vec![(lines[at].line, delimiter.cells(lines[at].said()))],
                None,
            ),
            None => header_lines(&lines[..start], &rows),
        };
        if header.is_none() {
            let elsewhere = elsewhere::names(&lines[..start], count);
            let elsewhere = elsewhere.or_else(|| rows.behind_row_names(lines, start, misfit));
            if let Some(names) = elsewhere {
                (above, misfit) = (vec![names], None);
            }
        }
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
            announced: stated::step(&lines[..start]),
            rows: lines[start..]
                .first()
                .map_or(lines[lines.len() - 1].behind.clone(), |looked| {
                    looked.from.clone()
                }),
            first,
        }
    }
}

type Above<'a> = Vec<(Line<'a>, Vec<&'a str>)>;

/// The lines above the rows with as many cells as they, from the top; or where there is none, the one above them.
fn header_lines<'a>(
    lines: &[Looked<'a>],
    rows: &SampleRows,
) -> (Above<'a>, Option<(Line<'a>, usize)>) {
    let mut above = Above::new();
    let mut misfit = None;
    for looked in lines.iter().rev() {
        match looked.kind {
            // names may stand apart from their units
            Kind::Blank if above.iter().any(|(_, cells)| share_of_units(cells) < 0.6) => break,
            Kind::Blank | Kind::Rule => continue,
            Kind::Comment | Kind::Plain => {}
        }
        let mut cells = rows.titles(looked);
        if looked.is_plain() && rows.count > 2 && is_heading(&cells) {
            above.extend(units_of_labview(lines, rows));
            break;
        }
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

/// Whether only the first cell says something, and no unit: it parts what is above from the table.
fn is_heading(cells: &[&str]) -> bool {
    let says = |cell: &&str| !cell.trim().is_empty();
    match cells.split_first() {
        Some((first, others)) => {
            says(first) && !others.iter().any(says) && share_of_units(&[first]) < 1.0
        }
        None => false,
    }
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
            (
                Delimiter::Bars,
                "| t | a |\n|---|---|\n| 0 | 1 |\n| 1 | 2 |\n",
            ),
            (Delimiter::Blanks, "   t    a\n 0.0  1.5\n 0.1  2.5\n"),
            (
                Delimiter::Byte(b','),
                "t,mode\n2026-11-21 10:00:00,x y\n2026-11-21 10:00:01,x y\n",
            ),
        ] {
            assert_eq!(found(text).0, delimiter, "{text}");
        }
    }

    #[test]
    fn the_header_is_what_stands_above_and_fits() {
        for (text, above, first) in [
            (
                "Test: 42\nRecorder,A\n\nt,a,b\ns,m,m\n0,1,2\n1,2,3\n",
                vec!["t#a#b", "s#m#m"],
                "0,1,2",
            ),
            ("# run 7\n# t,a\n# an event\n0,1\n1,2\n", vec!["t#a"], "0,1"),
            (
                "1,2,3\nt,a,b\n0,1,2\n1,2,3\n2,3,4\n",
                vec!["1#2#3", "t#a#b"],
                "0,1,2",
            ),
            ("0,1\n1,2\n", vec![], "0,1"),
            ("t,a,\n0,1,\n1,2,\n", vec!["t#a"], "0,1,"),
            ("t,a\n0,1,\n1,2,\n", vec!["t#a"], "0,1,"),
            ("t,a,\n0,1\n1,2\n", vec!["t#a"], "0,1"),
            ("t,a,b\n0,1,\n1,2,\n", vec!["t#a#b"], "0,1,"),
            (
                "Time  Angle of attack  q\n 0.0  1.5  2\n 0.1  2.5  3\n",
                vec!["Time#Angle of attack#q"],
                " 0.0  1.5  2",
            ),
            ("t,a\n0,1\n\nx,2\n1,y\n2\n1,3\n", vec!["t#a"], "0,1"),
            (
                "Samples,1,1,1\nkind,T,T,T\nX0,0,0,0\nX,a,b,c,Comment\n0,1,2,3\n1,2,3,4\n",
                vec!["Samples#1#1#1", "kind#T#T#T", "X0#0#0#0", "X#a#b#c"],
                "0,1,2,3",
            ),
        ] {
            let (_, found_above, found_first) = found(text);
            assert_eq!(
                (found_above, found_first.as_str()),
                (above.into_iter().map(str::to_string).collect(), first),
                "{text}"
            );
        }
        let layout = find("t,a,b\n0,1\n1,2\n", Said::default()).unwrap();
        assert_eq!(
            layout.misfit.map(|(line, cells)| (line.number, cells)),
            Some((1, 3))
        );
    }

    #[test]
    fn what_is_said_holds() {
        let said = Said {
            skip: 2,
            header: Some(4),
            delimiter: None,
        };
        let layout = find("1,2\n3,4\nnames,follow\nt,a\ns,m\n0,1\n1,2\n", said).unwrap();
        assert_eq!(layout.above[0].1, ["t", "a"]);
        assert_eq!(layout.rows.clone().next().unwrap().text, "0,1");
    }
}
