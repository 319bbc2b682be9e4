//! The header of an object: messages that say what it is.

use super::damage::damaged;
use super::file::{Cursor, File};
use crate::flight::Fault;

/// The kinds of messages that are read.
pub(super) mod kind {
    pub(in super::super) const DATASPACE: u16 = 0x01;
    pub(in super::super) const LINK_INFO: u16 = 0x02;
    pub(in super::super) const DATATYPE: u16 = 0x03;
    pub(in super::super) const OLD_FILL: u16 = 0x04;
    pub(in super::super) const FILL: u16 = 0x05;
    pub(in super::super) const LINK: u16 = 0x06;
    pub(in super::super) const LAYOUT: u16 = 0x08;
    pub(in super::super) const FILTERS: u16 = 0x0b;
    pub(in super::super) const ATTRIBUTE: u16 = 0x0c;
    pub(super) const CONTINUATION: u16 = 0x10;
    pub(in super::super) const SYMBOL_TABLE: u16 = 0x11;
    pub(super) const ALL: [u16; 10] = [
        DATASPACE,
        LINK_INFO,
        DATATYPE,
        OLD_FILL,
        FILL,
        LINK,
        LAYOUT,
        FILTERS,
        ATTRIBUTE,
        SYMBOL_TABLE,
    ];
}

pub(super) struct Message<'a> {
    pub(super) kind: u16,
    pub(super) bytes: &'a [u8],
}

pub(super) struct Header<'a> {
    messages: Vec<Message<'a>>,
}

/// Parts of a header.
const MOST_BLOCKS: usize = 1000;
const MOST_MESSAGES: usize = 20_000;
/// The message is elsewhere.
const SHARED: u8 = 2;

impl<'a> Header<'a> {
    /// So many bytes of `room` are taken as it has.
    ///
    /// # Errors
    /// It is damaged, or there is less room.
    pub(super) fn read(file: &File<'a>, address: u64, room: &mut usize) -> Result<Self, Fault> {
        Self::of(file, address, room)
            .ok_or_else(|| damaged("the header of an object cannot be read"))
    }

    fn of(file: &File<'a>, address: u64, room: &mut usize) -> Option<Self> {
        let mut cursor = file.cursor(address)?;
        let is_second = cursor.rest().starts_with(b"OHDR");
        let (first, is_ordered) = match is_second {
            true => second(&mut cursor)?,
            false => (first(&mut cursor)?, false),
        };
        let mut messages = Vec::new();
        let mut blocks = vec![first];
        let (mut read, mut count) = (0, 0);
        while let Some(block) = blocks.get(read).copied() {
            read += 1;
            *room = room.checked_sub(block.len())?;
            let mut cursor = file.within(block);
            while let Some((message, flags)) = message(&mut cursor, is_second, is_ordered) {
                if message.kind == kind::CONTINUATION {
                    let mut cursor = file.within(message.bytes);
                    let (address, length) = (cursor.address()?, cursor.count()?);
                    let block = file.slice(address, length)?;
                    blocks.push(match is_second {
                        true => block.strip_prefix(b"OCHK")?,
                        false => block,
                    });
                } else if flags & SHARED == 0 && kind::ALL.contains(&message.kind) {
                    messages.push(message);
                }
                count += 1;
                if count > MOST_MESSAGES || blocks.len() > MOST_BLOCKS {
                    return None;
                }
            }
        }
        Some(Self { messages })
    }

    pub(super) fn all(&self, kind: u16) -> impl Iterator<Item = &'a [u8]> {
        let of_kind = self
            .messages
            .iter()
            .filter(move |message| message.kind == kind);
        of_kind.map(|message| message.bytes)
    }

    pub(super) fn find(&self, kind: u16) -> Option<&'a [u8]> {
        self.all(kind).next()
    }
}

/// Bytes of all headers of a file: several objects may have one.
pub(super) fn room(file: &File) -> usize {
    file.len().saturating_mul(4).saturating_add(1 << 20)
}

/// The messages of a header of version 1.
fn first<'a>(cursor: &mut Cursor<'a>) -> Option<&'a [u8]> {
    if cursor.u8()? != 1 {
        return None;
    }
    cursor.take(7)?;
    let length = cursor.u32()? as usize;
    cursor.take(4)?;
    cursor.take(length)
}

/// The messages of a header of version 2, and whether each has a number.
fn second<'a>(cursor: &mut Cursor<'a>) -> Option<(&'a [u8], bool)> {
    cursor.take(5)?;
    let flags = cursor.u8()?;
    if flags & 0x20 != 0 {
        cursor.take(16)?;
    }
    if flags & 0x10 != 0 {
        cursor.take(4)?;
    }
    let length = cursor.uint(1 << (flags & 3))?;
    let block = cursor.take(usize::try_from(length).ok()?)?;
    Some((block, flags & 4 != 0))
}

fn message<'a>(
    cursor: &mut Cursor<'a>,
    is_second: bool,
    is_ordered: bool,
) -> Option<(Message<'a>, u8)> {
    let (kind, length, flags);
    if is_second {
        kind = cursor.u8()?.into();
        length = cursor.u16()?;
        flags = cursor.u8()?;
        cursor.take(if is_ordered { 2 } else { 0 })?;
    } else {
        kind = cursor.u16()?;
        length = cursor.u16()?;
        flags = cursor.u8()?;
        cursor.take(3)?;
    }
    let bytes = cursor.take(length.into())?;
    Some((Message { kind, bytes }, flags))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_within_a_budget_and_have_what_is_read() {
        let mut bytes = super::super::file::SIGNATURE.to_vec();
        bytes.extend([2, 8, 8, 0]);
        bytes.resize(48, 0);
        // two messages without bytes: nothing, and a filter
        bytes.extend([1, 0, 2, 0, 1, 0, 0, 0, 16, 0, 0, 0, 0, 0, 0, 0]);
        bytes.extend([0, 0, 0, 0, 0, 0, 0, 0]);
        bytes.extend([0x0b, 0, 0, 0, 0, 0, 0, 0]);
        let file = File::of(&bytes).unwrap();
        let mut room = 31;
        let header = Header::read(&file, 48, &mut room).unwrap();
        assert_eq!(header.messages.len(), 1);
        assert!(header.find(kind::FILTERS).is_some());
        assert!(Header::read(&file, 48, &mut room).is_err());
    }
}
