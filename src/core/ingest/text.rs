//! Bytes to text, and text of a stranger into a message.

use super::{code, fault::of_file};
use crate::flight::Fault;

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
const LONGEST_QUOTE: usize = 60;
const LONGEST_MESSAGE: usize = 300;
/// Variables of a file, or fields of one, are listed up to this many.
pub(super) const LISTED: usize = 20;

/// The text of a file without its byte order mark.
pub(super) fn decode(bytes: &[u8]) -> Result<&str, Fault> {
    let body = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
    let text = std::str::from_utf8(body).map_err(|fault| {
        let offset = fault.valid_up_to();
        let what = if fault.error_len().is_none() {
            "the file ends inside a character; it was cut off"
        } else if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
            "this is UTF-16; save the file as UTF-8"
        } else {
            "save the file as UTF-8"
        };
        let at = offset + (bytes.len() - body.len());
        let line = line_at(body, offset);
        of_file(
            code::NOT_UTF8,
            format!("not UTF-8 at byte {at} (from 0), line {line}: {what}"),
        )
    })?;
    if text.trim().is_empty() {
        return Err(of_file(
            code::EMPTY_BODY,
            "the file is empty; send a recording with a time axis and at least one channel",
        ));
    }
    Ok(text)
}

/// The line, from 1, of the byte at `offset`. Lines end in `\n`, `\r\n` or `\r`.
pub(super) fn line_at(bytes: &[u8], offset: usize) -> usize {
    let before = &bytes[..offset.min(bytes.len())];
    let ends = before
        .iter()
        .enumerate()
        .filter(|&(i, &byte)| byte == b'\n' || (byte == b'\r' && bytes.get(i + 1) != Some(&b'\n')));
    1 + ends.count()
}

/// A stranger's text in quotes: short, on one line, without control characters.
pub(super) fn quoted(text: &str) -> String {
    format!("'{}'", clipped(text, LONGEST_QUOTE))
}

/// A library's message, which may hold a stranger's text of any length.
pub(super) fn short_message(text: &str) -> String {
    clipped(text, LONGEST_MESSAGE)
}

/// The first `most` of several names or sentences, and how many more there are.
pub(super) fn listed(mut names: impl Iterator<Item = String>, most: usize) -> String {
    let list: Vec<String> = names
        .by_ref()
        .take(most)
        .map(|name| short_message(&name))
        .collect();
    match (list.join(", "), names.count()) {
        (list, _) if list.is_empty() => "nothing".to_string(),
        (list, 0) => list,
        (list, more) => format!("{list} and {more} more"),
    }
}

fn clipped(text: &str, longest: usize) -> String {
    let mut characters = text.chars();
    let mut clipped: String = characters
        .by_ref()
        .take(longest)
        .map(|c| if c.is_control() { '\u{fffd}' } else { c })
        .collect();
    if characters.next().is_some() {
        clipped.push_str("...");
    }
    clipped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_name_byte_and_line() {
        let fault = |bytes: &[u8]| decode(bytes).unwrap_err().message;
        assert!(fault(b"a\nb\xb0c").starts_with("not UTF-8 at byte 3 (from 0), line 2"));
        assert!(fault(b"a\nb\nc\xce").contains("line 3: the file ends inside a character"));
        assert!(fault(b"\xff\xfet\0").contains("UTF-16"));
        assert!(fault(b"\xef\xbb\xbfab\xff").contains("byte 5"));
        for empty in [&b""[..], b"\xef\xbb\xbf", b" \n\r\n"] {
            assert_eq!(decode(empty).unwrap_err().code, code::EMPTY_BODY);
        }
        assert_eq!(decode(b"\xef\xbb\xbft"), Ok("t"));
    }

    #[test]
    fn every_line_ending_counts_once() {
        assert_eq!(line_at(b"a\r\nb\nc\rd", 7), 4);
        assert_eq!(line_at(b"a\r\nb", 3), 2);
        assert_eq!(line_at(b"", 9), 1);
    }

    #[test]
    fn a_quote_is_short_and_on_one_line() {
        assert_eq!(quoted("a\nb"), "'a\u{fffd}b'");
        assert_eq!(quoted(&"é".repeat(1000)).chars().count(), 65);
    }
}
