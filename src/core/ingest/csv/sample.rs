//! The first lines of a file, by which its table is found.

use super::super::{
    cell::{Decimal, Marks, is_missing, number, unquote},
    lines::{Line, Lines, is_blank, is_comment, said_in_comment},
    stamp::Stamp,
};

/// So many lines, or bytes, are looked at.
const LINES: usize = 400;
const BYTES: usize = 1 << 18;

/// What a cell holds.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Held {
    /// A number, a time stamp or a date.
    Value,
    Nothing,
    Text,
}

impl Held {
    pub(super) fn by(cell: &str) -> Self {
        let text = unquote(cell);
        if is_missing(text) || text.eq_ignore_ascii_case("nan") || text.eq_ignore_ascii_case("inf")
        {
            return Self::Nothing;
        }
        if is_number(text) || Stamp::parse(text).is_some() || Stamp::is_date(text) {
            Self::Value
        } else {
            Self::Text
        }
    }
}

/// Whether it is a number in any of the ways in which numbers are written, be it with blanks between thousands.
fn is_number(text: &str) -> bool {
    let ways = [
        (Decimal::Point, false),
        (Decimal::Comma, false),
        (Decimal::Point, true),
        (Decimal::Comma, true),
    ];
    ways.into_iter().any(|(decimal, has_thousands)| {
        let marks = Marks {
            decimal,
            has_thousands,
        };
        number(text, marks).is_some_and(f64::is_finite)
    })
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Blank,
    /// Lines of dashes and the like between a header and its rows.
    Rule,
    Comment,
    Plain,
}

/// A line of the sample.
#[derive(Clone)]
pub(super) struct Looked<'a> {
    pub(super) line: Line<'a>,
    pub(super) kind: Kind,
    /// The text from this line on, and from the next.
    pub(super) from: Lines<'a>,
    pub(super) behind: Lines<'a>,
}

impl<'a> Looked<'a> {
    /// What is to be parted into cells: of a comment, what it says.
    pub(super) fn said(&self) -> &'a str {
        match self.kind {
            Kind::Comment if is_comment_of_a_program(self.line.text) => {
                self.line.text.trim_start_matches(marks_a_comment)
            }
            Kind::Comment => said_in_comment(self.line.text),
            _ => self.line.text,
        }
    }

    pub(super) fn is_plain(&self) -> bool {
        matches!(self.kind, Kind::Plain)
    }
}

/// The first lines of a text, all but the first `skip`.
pub(super) fn lines<'a>(text: &'a str, skip: usize) -> Vec<Looked<'a>> {
    let mut rest = Lines::of(text);
    for _ in 0..skip {
        if rest.any_line().is_none() {
            break;
        }
    }
    let mut looked = Vec::new();
    let mut bytes = 0;
    while looked.len() < LINES && bytes < BYTES {
        let from = rest.clone();
        let Some(line) = rest.any_line() else {
            break;
        };
        bytes += line.text.len();
        looked.push(Looked {
            line,
            kind: kind(line.text),
            from,
            behind: rest.clone(),
        });
    }
    looked
}

fn marks_a_comment(c: char) -> bool {
    matches!(c, '/' | '!' | ';' | ' ')
}

/// `// alpha`, `! alpha`, and `; alpha` where no semicolon parts cells.
fn is_comment_of_a_program(line: &str) -> bool {
    line.starts_with("//")
        || line.starts_with("! ")
        || (line.starts_with("; ") && !line[1..].contains(';'))
}

fn kind(line: &str) -> Kind {
    if is_blank(line) {
        Kind::Blank
    } else if is_comment(line) || is_comment_of_a_program(line) {
        Kind::Comment
    } else if line.trim_end() == "$DATA"
        || line.len() > 2 && line.bytes().all(|byte| b"-+=_|: \t".contains(&byte))
    {
        Kind::Rule
    } else {
        Kind::Plain
    }
}
