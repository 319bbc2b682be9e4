//! Attributes: names with values beside an object.

use super::datatype::Type;
use super::file::{Cursor, File};
use super::header::{Header, kind};

/// The attribute of a name, where it is a text.
pub(super) fn text(file: &File, header: &Header, name: &str) -> Option<String> {
    bytes(file, header, name).map(trimmed)
}

/// The attribute of a name, where it is a text, as its bytes stand there.
pub(super) fn bytes<'a>(file: &File<'a>, header: &Header<'a>, name: &str) -> Option<&'a [u8]> {
    let mut messages = header.all(kind::ATTRIBUTE);
    messages.find_map(|message| {
        let (mut kind, mut value) = parts(file.within(message), name)?;
        match Type::read(&mut kind)? {
            Type::Text(width) => value.take(width),
            _ => None,
        }
    })
}

/// The attribute of a name, where it is one number.
pub(super) fn number(file: &File, header: &Header, name: &str) -> Option<f64> {
    let mut messages = header.all(kind::ATTRIBUTE);
    messages.find_map(|message| {
        let (mut kind, mut value) = parts(file.within(message), name)?;
        let number = Type::read(&mut kind)?.number()?;
        value.take(number.width).map(number.read)
    })
}

/// Whether there is an attribute of a name.
pub(super) fn is_there(file: &File, header: &Header, name: &str) -> bool {
    let mut messages = header.all(kind::ATTRIBUTE);
    messages.any(|message| parts(file.within(message), name).is_some())
}

/// The type and the value of the attribute of a message, if it has the name.
fn parts<'a>(mut cursor: Cursor<'a>, name: &str) -> Option<(Cursor<'a>, Cursor<'a>)> {
    let version = cursor.u8()?;
    cursor.u8()?;
    let [of_name, of_type, of_space] =
        [cursor.u16()?, cursor.u16()?, cursor.u16()?].map(usize::from);
    cursor.take(if version == 3 { 1 } else { 0 })?;
    let padded = |length: usize| match version {
        1 => length.next_multiple_of(8),
        _ => length,
    };
    let found = cursor.take(padded(of_name))?;
    if found.split(|byte| *byte == 0).next() != Some(name.as_bytes()) {
        return None;
    }
    let kind = cursor;
    cursor.take(padded(of_type))?;
    cursor.take(padded(of_space))?;
    Some((kind, cursor))
}

/// A text of fixed length without what it is filled up with.
pub(super) fn trimmed(bytes: &[u8]) -> String {
    let end = memchr::memchr(0, bytes).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end])
        .trim_end()
        .to_string()
}
