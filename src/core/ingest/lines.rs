//! The lines of a text that say something, with their numbers.

use memchr::memchr2;

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
}

impl<'a> Lines<'a> {
    pub(super) fn of(text: &'a str) -> Self {
        Self {
            rest: text,
            number: 0,
        }
    }

    fn any_line(&mut self) -> Option<Line<'a>> {
        if self.rest.is_empty() {
            return None;
        }
        let end = memchr2(b'\n', b'\r', self.rest.as_bytes()).unwrap_or(self.rest.len());
        let (text, behind) = self.rest.split_at(end);
        self.rest = behind
            .strip_prefix("\r\n")
            .or_else(|| behind.get(1..))
            .unwrap_or_default();
        self.number += 1;
        Some(Line {
            number: self.number,
            text,
        })
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        loop {
            let line = self.any_line()?;
            if !line.text.trim().is_empty() && !is_comment(line.text) {
                return Some(line);
            }
        }
    }
}

/// What spreadsheets write into cells: a row that begins with one is no comment.
const SPREADSHEET_WORDS: [&str; 7] = [
    "#n/a", "#num!", "#value!", "#div/0!", "#ref!", "#name?", "#null!",
];

fn is_comment(line: &str) -> bool {
    let line = line.trim_start_matches(' ');
    let begins_with = |word: &&str| {
        let start = line.as_bytes().get(..word.len());
        start.is_some_and(|start| start.eq_ignore_ascii_case(word.as_bytes()))
    };
    if let Some(behind) = line.strip_prefix('%') {
        // a row of units may begin with that of a share
        let behind = behind.trim_start_matches(' ');
        return !behind.starts_with([',', ';', '\t']);
    }
    line.starts_with('#') && !SPREADSHEET_WORDS.iter().any(begins_with)
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
}
