//! The records of a group of data: in one block, or in a list of blocks, packed or not.

use std::borrow::Cow;
use std::io::Read;

use flate2::read::ZlibDecoder;

use super::super::{code, fault::of_file};
use super::block::Block;
use super::damage::damaged;
use crate::flight::Fault;

/// Blocks of data, and lists of them.
pub(super) const MOST_BLOCKS: usize = 1_000_000;
/// What becomes of a list that is stored by columns, in version 4.20.
const RESAVE: &str = "save it as version 4.10, in Python with asammdf.MDF('file.mf4').convert('4.10').save('new.mf4')";

/// All records behind a link; so many bytes of `room` are taken as are put together.
///
/// # Errors
/// There is less room; they are damaged, or stored in a way that is not read.
pub(super) fn records<'a>(
    file: &'a [u8],
    address: u64,
    room: &mut usize,
    left: &mut usize,
) -> Result<Cow<'a, [u8]>, Fault> {
    if address == 0 {
        return Ok(Cow::Borrowed(&[]));
    }
    let block = Block::read(file, address)?;
    match &block.kind {
        b"DT" => Ok(Cow::Borrowed(block.bytes())),
        _ => {
            let mut records = Vec::new();
            Gathering { file, room, left }.add(block, &mut records)?;
            Ok(Cow::Owned(records))
        }
    }
}

/// Bytes of all records behind a link, without unpacking them; what cannot be read has none. So many of the blocks `left` are
/// taken as are looked at. `None`: they are stored in a way that is not read.
pub(super) fn length(file: &[u8], address: u64, left: &mut usize) -> Option<usize> {
    let Some(block) = Block::read(file, address).ok().filter(|_| address != 0) else {
        return Some(0);
    };
    let of_block = |block: &Block| match &block.kind {
        b"DZ" => Packed::read(block).map_or(0, |packed| packed.length),
        b"DT" => block.bytes().len(),
        _ => 0,
    };
    let mut list = match &block.kind {
        b"HL" => block.link(0),
        b"DL" => address,
        b"DT" | b"DZ" => return Some(of_block(&block)),
        _ => return None,
    };
    let mut length = 0usize;
    while let Ok(Some(block)) = Block::find(file, list, b"DL") {
        for address in block.links().skip(1) {
            let of_link = Block::read(file, address).map_or(0, |block| of_block(&block));
            length = length.saturating_add(of_link);
            *left = left.saturating_sub(1);
            if *left == 0 {
                return Some(length);
            }
        }
        list = block.link(0);
        *left = left.saturating_sub(1);
        if *left == 0 {
            break;
        }
    }
    Some(length)
}

struct Gathering<'g, 'a> {
    file: &'a [u8],
    room: &'g mut usize,
    /// Blocks that may still be looked at.
    left: &'g mut usize,
}

impl<'a> Gathering<'_, 'a> {
    fn add(&mut self, block: Block<'a>, records: &mut Vec<u8>) -> Result<(), Fault> {
        match &block.kind {
            b"DZ" => self.unpack(&block, records),
            b"DT" => {
                self.take(block.bytes().len())?;
                records.extend_from_slice(block.bytes());
                Ok(())
            }
            b"HL" => self.list(block.link(0), records),
            b"DL" => {
                self.members(&block, records)?;
                self.list(block.link(0), records)
            }
            b"LD" | b"DV" => {
                let message =
                    format!("the MDF file is stored by columns, which is not read; {RESAVE}");
                Err(of_file(code::FORMAT_NOT_READ, message))
            }
            _ => Err(damaged("there is no data where it should be")),
        }
    }

    fn list(&mut self, mut address: u64, records: &mut Vec<u8>) -> Result<(), Fault> {
        while let Some(list) = Block::find(self.file, address, b"DL")? {
            self.members(&list, records)?;
            address = list.link(0);
        }
        Ok(())
    }

    /// The blocks that a list has.
    fn members(&mut self, list: &Block, records: &mut Vec<u8>) -> Result<(), Fault> {
        self.count()?;
        for address in list.links().skip(1).filter(|address| *address != 0) {
            self.count()?;
            let block = Block::read(self.file, address)?;
            match &block.kind {
                b"DT" | b"DZ" => self.add(block, records)?,
                _ => return Err(damaged("there is no data where it should be")),
            }
        }
        Ok(())
    }

    fn count(&mut self) -> Result<(), Fault> {
        let left = self.left.checked_sub(1);
        *self.left = left.ok_or_else(|| damaged("its lists of data have no end"))?;
        Ok(())
    }

    fn unpack(&mut self, block: &Block, records: &mut Vec<u8>) -> Result<(), Fault> {
        let wrong = || damaged("packed data cannot be unpacked");
        let packed = Packed::read(block).ok_or_else(wrong)?;
        self.take(packed.length)?;
        let unpacked = packed.unpack().ok_or_else(wrong)?;
        records.extend_from_slice(&unpacked);
        Ok(())
    }

    fn take(&mut self, length: usize) -> Result<(), Fault> {
        *self.room = self.room.checked_sub(length).ok_or_else(|| {
            let message = "the MDF file unpacks to more than the longest body that is taken; send a shorter part, or fewer channels";
            of_file(code::UNPACKED_TOO_LARGE, message)
        })?;
        Ok(())
    }
}

/// A block of packed data.
struct Packed<'a> {
    is_transposed: bool,
    /// Bytes of a record, where it is transposed.
    columns: usize,
    /// Bytes that it becomes.
    length: usize,
    bytes: &'a [u8],
}

impl<'a> Packed<'a> {
    /// `None` where it is packed in a way that is not known.
    fn read(block: &Block<'a>) -> Option<Self> {
        let mut cursor = block.cursor();
        let kind = cursor.take(2)?;
        let method = cursor.u8()?;
        cursor.u8()?;
        let columns = cursor.u32()? as usize;
        let (length, packed) = (cursor.count()?, cursor.count()?);
        (kind == b"DT" && method <= 1).then_some(Self {
            is_transposed: method == 1,
            columns,
            length,
            bytes: cursor.take(packed)?,
        })
    }

    fn unpack(&self) -> Option<Vec<u8>> {
        let mut unpacked = Vec::new();
        let room = (self.length as u64).saturating_add(1);
        let read = ZlibDecoder::new(self.bytes)
            .take(room)
            .read_to_end(&mut unpacked);
        if read.is_err() || unpacked.len() != self.length {
            return None;
        }
        let rows = self.length.checked_div(self.columns).unwrap_or(0);
        if !self.is_transposed || rows == 0 {
            return Some(unpacked);
        }
        // what is no whole record stays where it is
        let mut plain = unpacked.clone();
        for row in 0..rows {
            for column in 0..self.columns {
                plain[row * self.columns + column] = unpacked[column * rows + row];
            }
        }
        Some(plain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_of_data_is_looked_at_within_a_budget() {
        // a list of four, all of which are one block of five bytes; nothing is at address 0
        let mut bytes = vec![0; 8];
        bytes.extend(b"##DL\0\0\0\0");
        bytes.extend(64u64.to_le_bytes());
        bytes.extend(5u64.to_le_bytes());
        let links = [0u64, 72, 72, 72, 72];
        bytes.extend(links.iter().flat_map(|link| link.to_le_bytes()));
        bytes.extend(b"##DT\0\0\0\0");
        bytes.extend(29u64.to_le_bytes());
        bytes.extend(0u64.to_le_bytes());
        bytes.extend([0; 5]);
        let mut left = 100;
        assert_eq!((length(&bytes, 8, &mut left), left), (Some(20), 95));
        left = 2;
        assert_eq!((length(&bytes, 8, &mut left), left), (Some(10), 0));
    }
}
