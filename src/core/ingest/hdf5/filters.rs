//! What was done to the bytes of a chunk, undone.

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::super::{code, fault::of_file};
use super::damage::{REWRITE, damaged};
use super::file::{Cursor, File};
use crate::flight::Fault;

/// In the order in which they were applied.
pub(super) struct Filters(Vec<Filter>);

enum Filter {
    Deflate,
    /// Of elements of so many bytes.
    Shuffle(usize),
    Checksum,
    Lzf,
    Other(u16, String),
}

impl Filters {
    pub(super) fn none() -> Self {
        Self(Vec::new())
    }

    /// # Errors
    /// The message is damaged.
    pub(super) fn read(file: &File, message: &[u8]) -> Result<Self, Fault> {
        list(file.within(message)).ok_or_else(|| damaged("the filters of a dataset cannot be read"))
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The bytes of a chunk, at most `most`; of filters whose bit is set in `mask` none was applied.
    ///
    /// # Errors
    /// They are damaged; or there is a filter that is not read.
    pub(super) fn undo(&self, bytes: &[u8], mask: u32, most: usize) -> Result<Vec<u8>, Fault> {
        let mut bytes = bytes.to_vec();
        for (at, filter) in self.0.iter().enumerate().rev() {
            if at < 32 && mask >> at & 1 == 1 {
                continue;
            }
            let undone = match filter {
                Filter::Deflate => inflate(&bytes, most),
                Filter::Shuffle(width) => Some(unshuffle(&bytes, *width)),
                Filter::Checksum => {
                    let length = bytes.len().checked_sub(4);
                    length
                        .and_then(|length| bytes.get(..length))
                        .map(<[u8]>::to_vec)
                }
                Filter::Lzf => lzf(&bytes, most),
                Filter::Other(number, name) => return Err(not_read(*number, name)),
            };
            bytes = undone.ok_or_else(|| damaged("a chunk cannot be unpacked"))?;
        }
        Ok(bytes)
    }
}

fn list(mut cursor: Cursor) -> Option<Filters> {
    let version = cursor.u8()?;
    let count = cursor.u8()?;
    cursor.take(if version == 1 { 6 } else { 0 })?;
    let mut filters = Vec::new();
    for _ in 0..count {
        let number = cursor.u16()?;
        let has_name = version == 1 || number >= 256;
        let length = if has_name { cursor.u16()? } else { 0 };
        cursor.u16()?;
        let values = cursor.u16()?;
        let length = match version {
            1 => usize::from(length).next_multiple_of(8),
            _ => length.into(),
        };
        let name = super::attribute::trimmed(cursor.take(length)?);
        let mut first = None;
        for _ in 0..values {
            let value = cursor.u32()?;
            first = first.or(Some(value));
        }
        if version == 1 && values % 2 == 1 {
            cursor.take(4)?;
        }
        filters.push(match (number, first) {
            (1, _) => Filter::Deflate,
            (2, Some(width)) => Filter::Shuffle(width as usize),
            (3, _) => Filter::Checksum,
            (32000, _) => Filter::Lzf,
            _ => Filter::Other(number, name),
        });
    }
    Some(Filters(filters))
}

fn inflate(bytes: &[u8], most: usize) -> Option<Vec<u8>> {
    let mut inflated = Vec::new();
    let room = (most as u64).saturating_add(1);
    let read = ZlibDecoder::new(bytes)
        .take(room)
        .read_to_end(&mut inflated);
    (read.is_ok() && inflated.len() <= most).then_some(inflated)
}

/// The first bytes of all elements stand together, then the second ones, and so on; the rest as it is.
fn unshuffle(bytes: &[u8], width: usize) -> Vec<u8> {
    let count = bytes.len().checked_div(width).unwrap_or(0);
    let mut plain = bytes.to_vec();
    for at in 0..count {
        for place in 0..width {
            plain[at * width + place] = bytes[place * count + at];
        }
    }
    plain
}

/// The method of h5py's `compression="lzf"`: literals, and copies of what stands before.
fn lzf(mut bytes: &[u8], most: usize) -> Option<Vec<u8>> {
    let mut plain: Vec<u8> = Vec::new();
    while let Some((&head, rest)) = bytes.split_first() {
        bytes = rest;
        if head < 32 {
            let (literal, rest) = bytes.split_at_checked(usize::from(head) + 1)?;
            plain.extend_from_slice(literal);
            bytes = rest;
        } else {
            let mut length = usize::from(head >> 5);
            if length == 7 {
                let (&more, rest) = bytes.split_first()?;
                length += usize::from(more);
                bytes = rest;
            }
            let (&low, rest) = bytes.split_first()?;
            bytes = rest;
            let back = (usize::from(head & 31) << 8 | usize::from(low)) + 1;
            let start = plain.len().checked_sub(back)?;
            for at in start..start + length + 2 {
                plain.push(plain[at]);
            }
        }
        if plain.len() > most {
            return None;
        }
    }
    Some(plain)
}

fn not_read(number: u16, name: &str) -> Fault {
    let name = super::super::text::quoted(name);
    let message = format!(
        "the HDF5 file is packed with filter {number} {name}, which is not read; {REWRITE}"
    );
    of_file(code::FORMAT_NOT_READ, message)
}
