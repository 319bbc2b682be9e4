//! The lines of a text, with their numbers.

use memchr::{memchr, memchr2};

/// A line of a file and its number, from 1.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Line<'a> {
    pub(super) number: usize,
    pub(super) text: &'a str,
}

/// All lines but blank ones and comments (`#`, `%`). Lines end in `\n`, `\r\n` or `\r`.
#[derive(Clone)]
pub(super) struct Lines<'a> {
    rest: &'a str,
    number: usize,
    has_quotes: bool,
}

/// A quoted cell of more bytes is no cell: its quote was forgotten.
const LONGEST_CELL: usize = 4096;

impl<'a> Lines<'a> {
    pub(super) fn of(text: &'a str) -> Self {
        Self {
            rest: text,
            number: 0,
            has_quotes: memchr(b'"', text.as_bytes()).is_some(),
        }
    }

    /// What is left of the text.
    pub(super) fn rest(&self) -> &'a str {
        self.rest
    }

    /// The next line, whatever it is.
    pub(super) fn any_line(&mut self) -> Option<Line<'a>> {
        if self.rest.is_empty() {
            return None;
        }
        let bytes = self.rest.as_bytes();
        let mut end = memchr2(b'\n', b'\r', bytes).unwrap_or(bytes.len());
        let mut breaks = 0;
        if self.has_quotes {
            (end, breaks) = with_quoted_breaks(bytes, end);
        }
        let (text, behind) = self.rest.split_at(end);
        self.rest = behind
            .strip_prefix("\r\n")
            .or_else(|| behind.get(1..))
            .unwrap_or_default();
        let number = self.number + 1;
        self.number = number + breaks;
        Some(Line { number, text })
    }
}

/// The end of a line whose quoted cells hold line ends, and how many of these there are.
fn with_quoted_breaks(bytes: &[u8], first_end: usize) -> (usize, usize) {
    let mut end = first_end;
    let mut breaks = 0;
    let mut quotes = 0;
    let mut counted = 0;
    loop {
        quotes += memchr::memchr_iter(b'"', &bytes[counted..end]).count();
        counted = end;
        if quotes.is_multiple_of(2) {
            return (end, breaks);
        }
        let look_at = &bytes[end..bytes.len().min(end + LONGEST_CELL)];
        let closes = memchr(b'"', look_at).filter(|&at| {
            let behind = look_at.get(at + 1);
            behind.is_none_or(|byte| b",;\t| \r\n\"".contains(byte))
        });
        let Some(closing) = closes else {
            return (first_end, 0);
        };
        let line_ends = &look_at[..closing];
        breaks += memchr::memchr_iter(b'\n', line_ends)
            .count()
            .max(memchr::memchr_iter(b'\r', line_ends).count());
        let from = end + closing + 1;
        end = memchr2(b'\n', b'\r', &bytes[from..]).map_or(bytes.len(), |at| from + at);
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        loop {
            let line = self.any_line()?;
            if !is_blank(line.text) && !is_comment(line.text) {
                return Some(line);
            }
        }
    }
}

/// Whether a line has nothing but blanks; a look at its first byte tells of most that it has.
pub(super) fn is_blank(line: &str) -> bool {
    !matches!(line.as_bytes().first(), Some(first) if first.is_ascii_graphic())
        && line.trim().is_empty()
}

/// What spreadsheets write into cells: a row that begins with one is no comment.
const SPREADSHEET_WORDS: [&str; 7] = [
    "#n/a", "#num!", "#value!", "#div/0!", "#ref!", "#name?", "#null!",
];

pub(super) fn is_comment(line: &str) -> bool {
    let line = line.trim_start_matches(' ');
    match line.as_bytes().first() {
        Some(b'#') => {
            let begins_with = |word: &&str| {
                let start = line.as_bytes().get(..word.len());
                start.is_some_and(|start| start.eq_ignore_ascii_case(word.as_bytes()))
            };
            !SPREADSHEET_WORDS.iter().any(begins_with)
        }
        Some(b'%') => {
            // a row of units may begin with that of a share
            let behind = line[1..].trim_start_matches(' ');
            !behind.starts_with([',', ';', '\t'])
        }
        _ => false,
    }
}

/// What a comment says, without the signs before it.
pub(super) fn said_in_comment(line: &str) -> &str {
    line.trim_start_matches([' ', '#', '%'])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbered(text: &str) -> Vec<(usize, &str)> {
        Lines::of(text)
            .map(|line| (line.number, line.text))
            .collect()
    }

    #[test]
    fn every_line_ending_counts_once() {
        let expected = [(1, "a"), (3, "b"), (4, " c")];
        for text in [
            "a\n\nb\n c",
            "a\r\n\r\nb\r\n c\r\n",
            "a\r\rb\r c",
            "a\n \r\nb\r c\n\n",
        ] {
            assert_eq!(numbered(text), expected, "{text:?}");
        }
        assert_eq!(numbered(""), []);
    }

    #[test]
    fn comments_are_passed_over_and_spreadsheet_words_are_not() {
        let text = "# a logger\n  % and its remark\na\n#\n#N/A,1\n#div/0!;1\n%;s\n%,s\n% x\n";
        let expected = [
            (3, "a"),
            (5, "#N/A,1"),
            (6, "#div/0!;1"),
            (7, "%;s"),
            (8, "%,s"),
        ];
        assert_eq!(numbered(text), expected);
    }

    #[test]
    fn a_quoted_cell_may_hold_line_ends() {
        let text = "a,\"one\ntwo\",b\nc,\"3\",d\n";
        assert_eq!(numbered(text), [(1, "a,\"one\ntwo\",b"), (3, "c,\"3\",d")]);
        let chain = format!("\"x\n{}y\"\nz\n", "y\",\"x\n".repeat(3));
        assert_eq!(
            numbered(&chain),
            [(1, chain[..chain.len() - 3].trim_end()), (6, "z")]
        );
        let forgotten = "a,\"1\nb,2\nc,3\n";
        assert_eq!(numbered(forgotten).len(), 3);
    }
}
