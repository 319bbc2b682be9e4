//! What separates the cells of a line: commas, semicolons, tabs, vertical bars or blanks.

use super::super::lines::Line;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Delimiter {
    /// A comma, a semicolon or a tab; one between two cells.
    Byte(u8),
    /// `| 0.0 | 1.5 |`, with bars at the ends or without.
    Bars,
    /// As many blanks and tabs as there are.
    Blanks,
}

impl Delimiter {
    /// All, in the order in which they are preferred where several would do.
    pub(super) const ALL: [Self; 5] = [
        Self::Byte(b'\t'),
        Self::Byte(b';'),
        Self::Byte(b','),
        Self::Bars,
        Self::Blanks,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Byte(b'\t') => "tabs",
            Self::Byte(b';') => "semicolons",
            Self::Byte(_) => "commas",
            Self::Bars => "vertical bars",
            Self::Blanks => "blanks",
        }
    }

    /// Of the sign itself, as a line `sep=;` or a mapping has it.
    pub(super) fn named(sign: &str) -> Option<Self> {
        match sign {
            "," => Some(Self::Byte(b',')),
            ";" => Some(Self::Byte(b';')),
            "\t" | "\\t" | "tab" => Some(Self::Byte(b'\t')),
            "|" => Some(Self::Bars),
            " " | "blank" | "blanks" => Some(Self::Blanks),
            _ => None,
        }
    }

    /// The delimiter that a line `sep=;` declares, as spreadsheets write it before the header.
    pub(super) fn declared(line: Line) -> Option<Self> {
        let (key, value) = line.text.split_once('=')?;
        let is_sep = key
            .trim()
            .trim_start_matches('"')
            .eq_ignore_ascii_case("sep");
        let sign = value.trim_end_matches([' ', '"']);
        Self::named(sign).filter(|_| is_sep)
    }

    /// The cells of a line, with the blanks and quotes around them.
    pub(super) fn cells(self, line: &str) -> Vec<&str> {
        let mut rest = self.without_ends(line);
        let mut cells = Vec::new();
        if self == Self::Blanks {
            while !rest.is_empty() {
                let end = self.cell_end(rest.as_bytes());
                cells.push(&rest[..end]);
                rest = rest[end..].trim_start();
            }
            return cells;
        }
        loop {
            let end = self.cell_end(rest.as_bytes());
            cells.push(&rest[..end]);
            if end == rest.len() {
                return cells;
            }
            rest = &rest[end + 1..];
        }
    }

    /// The line without bars at its ends, or the blanks before and behind it.
    pub(super) fn without_ends(self, line: &str) -> &str {
        match self {
            Self::Byte(_) => line,
            Self::Blanks => line.trim(),
            Self::Bars => {
                let line = line.trim();
                let line = line.strip_prefix('|').unwrap_or(line);
                line.strip_suffix('|').unwrap_or(line)
            }
        }
    }

    /// Where the first cell of the bytes ends: a delimiter in quotes ends none (RFC 4180).
    pub(super) fn cell_end(self, bytes: &[u8]) -> usize {
        let is_end = |byte: u8| match self {
            Self::Byte(delimiter) => byte == delimiter,
            Self::Bars => byte == b'|',
            Self::Blanks => byte == b' ' || byte == b'\t',
        };
        let begin = bytes.iter().position(|&byte| byte != b' ').unwrap_or(0);
        if bytes.get(begin) == Some(&b'"')
            && let Some(close) = closing_quote(&bytes[begin + 1..])
        {
            let behind = begin + 1 + close + 1;
            let blanks = match self {
                Self::Blanks => 0,
                _ => bytes[behind..]
                    .iter()
                    .take_while(|&&byte| byte == b' ')
                    .count(),
            };
            let end = behind + blanks;
            if bytes.get(end).is_none_or(|&byte| is_end(byte)) {
                return end;
            }
        }
        let end = match self {
            Self::Byte(delimiter) => memchr::memchr(delimiter, bytes),
            Self::Bars => memchr::memchr(b'|', bytes),
            Self::Blanks => memchr::memchr2(b' ', b'\t', bytes),
        };
        end.unwrap_or(bytes.len())
    }
}

/// The quote that closes a cell; two in a row stand for one in it.
fn closing_quote(bytes: &[u8]) -> Option<usize> {
    let mut from = 0;
    loop {
        let at = from + memchr::memchr(b'"', &bytes[from..])?;
        if bytes.get(at + 1) != Some(&b'"') {
            return Some(at);
        }
        from = at + 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_parted_and_quotes_protect() {
        let cells = |delimiter: Delimiter, line: &'static str| delimiter.cells(line).join("#");
        let comma = Delimiter::Byte(b',');
        assert_eq!(cells(comma, "a,\"b,c\",d"), "a#\"b,c\"#d");
        assert_eq!(
            cells(comma, "a, \"b \"\"x\"\",c\" ,d,"),
            "a# \"b \"\"x\"\",c\" #d#"
        );
        assert_eq!(
            cells(comma, "0,\"1"),
            "0#\"1",
            "a forgotten quote protects nothing"
        );
        assert_eq!(cells(comma, "0,\"1\"x,2"), "0#\"1\"x#2");
        assert_eq!(
            cells(Delimiter::Blanks, "  0.0\t 1.5  \"a b\" "),
            "0.0#1.5#\"a b\""
        );
        assert_eq!(cells(Delimiter::Bars, "| 0.0 | 1.5 |"), " 0.0 # 1.5 ");
        assert_eq!(cells(Delimiter::Bars, "0.0|1.5"), "0.0#1.5");
    }

    #[test]
    fn a_line_may_declare_it() {
        let declared = |text| Delimiter::declared(Line { number: 1, text });
        assert_eq!(declared("sep=;"), Some(Delimiter::Byte(b';')));
        assert_eq!(declared("\"sep=\t\""), Some(Delimiter::Byte(b'\t')));
        assert_eq!(declared("separation=;"), None);
        assert_eq!(declared("sep=x"), None);
    }
}
