//! Bytes of a table to text: by its byte order mark, by the charset that was said, or by what the bytes are.

use std::borrow::Cow;

use crate::flight::{Fault, Finding, FindingCode};

use super::{code, fault::of_file, note::note, text::decode};

/// A text, and what was odd about its bytes.
pub(super) struct Decoded<'a> {
    pub(super) text: Cow<'a, str>,
    /// What the bytes were read as.
    pub(super) encoding: &'static str,
    pub(super) findings: Vec<Finding>,
}

/// The text of a table. Zero bytes in it, as of a block that was allocated and never written, are left out.
///
/// # Errors
/// The charset is unknown, the bytes are not of it, or there is no text.
pub(super) fn text<'a>(bytes: &'a [u8], charset: Option<&str>) -> Result<Decoded<'a>, Fault> {
    let encoding = match charset {
        Some(charset) => Encoding::named(charset)?,
        None => Encoding::of(bytes),
    };
    let mut findings = Vec::new();
    let text = match encoding {
        Encoding::Utf8 => match without_zeros(bytes, &mut findings) {
            Cow::Borrowed(bytes) => Cow::Borrowed(decode(bytes)?),
            Cow::Owned(bytes) => Cow::Owned(decode(&bytes)?.to_string()),
        },
        Encoding::Utf16 { is_big } => {
            let body = bytes
                .strip_prefix(if is_big { b"\xfe\xff" } else { b"\xff\xfe" })
                .unwrap_or(bytes);
            let units = without_zeros(&utf16_units(body, is_big), &mut findings).into_owned();
            Cow::Owned(utf16(units)?)
        }
        Encoding::Windows1252 => {
            if charset.is_none() {
                findings.push(note(
                    FindingCode::Encoding,
                    "the file is not UTF-8; it was read as Windows-1252 (Latin-1)".to_string(),
                    "where it is, say so, as Content-Type: text/csv; charset=iso-8859-1; where titles look wrong, save it as UTF-8",
                ));
            }
            Cow::Owned(windows_1252(&without_zeros(bytes, &mut findings)))
        }
    };
    if text.trim().is_empty() {
        return Err(empty());
    }
    Ok(Decoded {
        text,
        encoding: encoding.name(),
        findings,
    })
}

fn empty() -> Fault {
    of_file(
        code::EMPTY_BODY,
        "the file is empty; send a recording with a time axis and at least one channel",
    )
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Encoding {
    Utf8,
    Utf16 { is_big: bool },
    Windows1252,
}

impl Encoding {
    fn named(charset: &str) -> Result<Self, Fault> {
        let name = charset.trim().trim_matches('"').to_ascii_lowercase();
        match name.as_str() {
            "utf-8" | "utf8" | "us-ascii" | "ascii" => Ok(Self::Utf8),
            "utf-16" | "utf-16le" => Ok(Self::Utf16 { is_big: false }),
            "utf-16be" => Ok(Self::Utf16 { is_big: true }),
            "iso-8859-1" | "iso-8859-15" | "latin1" | "latin-1" | "windows-1252" | "cp1252" => {
                Ok(Self::Windows1252)
            }
            _ => {
                let charset: String = charset.chars().take(40).collect();
                let message = format!(
                    "charset '{charset}' is not read; those that are: utf-8, utf-16le, utf-16be, iso-8859-1, windows-1252"
                );
                Err(of_file(code::NOT_UTF8, message))
            }
        }
    }

    /// By the byte order mark, or by the evidence of the bytes.
    fn of(bytes: &[u8]) -> Self {
        match bytes {
            [0xff, 0xfe, ..] => return Self::Utf16 { is_big: false },
            [0xfe, 0xff, ..] => return Self::Utf16 { is_big: true },
            _ => {}
        }
        let head = &bytes[..bytes.len().min(4096)];
        let zeros = |from: usize| {
            head.iter()
                .skip(from)
                .step_by(2)
                .filter(|&&b| b == 0)
                .count()
        };
        let pairs = head.len() / 2;
        // of Latin text every other byte is zero
        if pairs >= 4 && zeros(1) * 10 > pairs * 9 && zeros(0) * 10 < pairs {
            return Self::Utf16 { is_big: false };
        }
        if pairs >= 4 && zeros(0) * 10 > pairs * 9 && zeros(1) * 10 < pairs {
            return Self::Utf16 { is_big: true };
        }
        match std::str::from_utf8(bytes) {
            Ok(_) => Self::Utf8,
            // cut off inside a character
            Err(fault) if fault.error_len().is_none() => Self::Utf8,
            // letters of UTF-8 before it: a damaged file, and not another encoding
            Err(fault) if !bytes[..fault.valid_up_to()].is_ascii() => Self::Utf8,
            Err(_) => Self::Windows1252,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Utf8 => "UTF-8",
            Self::Utf16 { is_big: false } => "UTF-16LE",
            Self::Utf16 { is_big: true } => "UTF-16BE",
            Self::Windows1252 => "Windows-1252",
        }
    }
}

/// Bytes, or units of UTF-16, with each run of zeros taken for the end of a line.
fn without_zeros<'a, U>(units: &'a [U], findings: &mut Vec<Finding>) -> Cow<'a, [U]>
where
    U: Copy + PartialEq + From<u8>,
{
    let is_zero = |unit: &U| *unit == U::from(0);
    let zeros = units.iter().filter(|unit| is_zero(unit)).count();
    if zeros == 0 {
        return Cow::Borrowed(units);
    }
    let message = format!(
        "{} zero bytes are left out: blocks that were never written",
        zeros * size_of::<U>()
    );
    findings.push(note(
        FindingCode::ZeroBytes,
        message,
        "nothing needs to be done where the recording ends before them",
    ));
    let end_of_line = U::from(b'\n');
    let mut kept = Vec::with_capacity(units.len() - zeros + 1);
    for part in units.split(is_zero).filter(|part| !part.is_empty()) {
        if kept.last().is_some_and(|last| *last != end_of_line) {
            kept.push(end_of_line);
        }
        kept.extend_from_slice(part);
    }
    Cow::Owned(kept)
}

fn utf16_units(body: &[u8], is_big: bool) -> Vec<u16> {
    let units = body.chunks_exact(2).map(|pair| {
        let pair = [pair[0], pair[1]];
        if is_big {
            u16::from_be_bytes(pair)
        } else {
            u16::from_le_bytes(pair)
        }
    });
    units.collect()
}

fn utf16(units: Vec<u16>) -> Result<String, Fault> {
    let text = String::from_utf16(&units)
        .map_err(|_| of_file(code::NOT_UTF8, "this is not UTF-16; save the file as UTF-8"))?;
    Ok(text.trim_start_matches('\u{feff}').to_string())
}

/// What 0x80 to 0x9f are; 0 where it is no character.
const HIGH: [u16; 32] = [
    0x20ac, 0, 0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021, 0x02c6, 0x2030, 0x0160, 0x2039,
    0x0152, 0, 0x017d, 0, 0, 0x2018, 0x2019, 0x201c, 0x201d, 0x2022, 0x2013, 0x2014, 0x02dc,
    0x2122, 0x0161, 0x203a, 0x0153, 0, 0x017e, 0x0178,
];

fn windows_1252(bytes: &[u8]) -> String {
    let character = |&byte: &u8| match byte {
        0x80..=0x9f => match HIGH[usize::from(byte - 0x80)] {
            0 => '\u{fffd}',
            code => char::from_u32(u32::from(code)).unwrap_or('\u{fffd}'),
        },
        _ => char::from(byte),
    };
    bytes.iter().map(character).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8], charset: Option<&str>) -> (String, &'static str) {
        let decoded = text(bytes, charset).unwrap();
        (decoded.text.into_owned(), decoded.encoding)
    }

    #[test]
    fn encodings_are_told_by_mark_by_word_and_by_evidence() {
        let expected = "t[s];\u{b0};\u{b5}s\n0;1;2\n";
        let little: Vec<u8> = expected.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = expected.encode_utf16().flat_map(u16::to_be_bytes).collect();
        let latin: Vec<u8> = expected.chars().map(|c| c as u8).collect();
        let marked = [&b"\xff\xfe"[..], &little].concat();
        for (bytes, charset, encoding) in [
            (expected.as_bytes(), None, "UTF-8"),
            (&marked[..], None, "UTF-16LE"),
            (&little[..], None, "UTF-16LE"),
            (&big[..], None, "UTF-16BE"),
            (&big[..], Some("UTF-16BE"), "UTF-16BE"),
            (&latin[..], None, "Windows-1252"),
            (&latin[..], Some("iso-8859-1"), "Windows-1252"),
        ] {
            assert_eq!(read(bytes, charset), (expected.to_string(), encoding));
        }
        assert_eq!(
            text(b"a", Some("ebcdic")).err().unwrap().code,
            code::NOT_UTF8
        );
        assert_eq!(
            text(b"a\xb0", Some("utf-8")).err().unwrap().code,
            code::NOT_UTF8
        );
    }

    #[test]
    fn zero_bytes_end_a_line_and_are_told() {
        let decoded = text(b"t,a\n0,1\n\0\0\0\0", None).unwrap();
        assert_eq!(decoded.text, "t,a\n0,1\n");
        assert_eq!(decoded.findings[0].code, "zero_bytes");
        assert_eq!(
            text(b"t,a\n0,1\0\0\x001,2\n", None).unwrap().text,
            "t,a\n0,1\n1,2\n"
        );
        let block = "20;1\0\0\0\x002.5;\u{b0}\0";
        let latin: Vec<u8> = block.chars().map(|c| c as u8).collect();
        let little: Vec<u8> = block.encode_utf16().flat_map(u16::to_le_bytes).collect();
        for (bytes, charset, zeros) in [(latin, "latin1", "5"), (little, "utf-16", "10")] {
            let decoded = text(&bytes, Some(charset)).unwrap();
            assert_eq!(decoded.text, "20;1\n2.5;\u{b0}", "{charset}");
            let told = &decoded.findings[0];
            assert_eq!(told.code, "zero_bytes", "{charset}");
            assert!(
                told.message.starts_with(&format!("{zeros} zero bytes")),
                "{told:?}"
            );
        }
        assert_eq!(text(&[0; 99], None).err().unwrap().code, code::EMPTY_BODY);
    }
}
