//! The bytes of a file by their addresses, and where its outermost group is.

use super::super::{code, fault::of_file};
use super::damage::{REWRITE, damaged};
use crate::flight::Fault;

pub(super) const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";
/// Where the signature may stand: MATLAB writes 512 bytes of its own before it.
const STARTS: [usize; 6] = [0, 512, 1024, 2048, 4096, 8192];

#[derive(Clone, Copy)]
pub(super) struct File<'a> {
    /// From the signature on, as addresses count.
    bytes: &'a [u8],
    /// Bytes of an address, and of a length.
    offset: usize,
    length: usize,
    /// The header of the outermost group.
    pub(super) root: u64,
}

/// Where the signature stands.
pub(super) fn start(bytes: &[u8]) -> Option<usize> {
    let is_there = |start: &usize| {
        let rest = bytes.get(*start..);
        rest.is_some_and(|rest| rest.starts_with(SIGNATURE))
    };
    STARTS.into_iter().find(is_there)
}

impl<'a> File<'a> {
    /// # Errors
    /// It is damaged, or of a version that is not known.
    pub(super) fn of(bytes: &'a [u8]) -> Result<Self, Fault> {
        let start = start(bytes).ok_or_else(|| damaged("it has no signature"))?;
        let bytes = &bytes[start..];
        let version = bytes.get(8).copied().unwrap_or(0xff);
        let file = match version {
            0 | 1 => Self::first(bytes, version),
            2 | 3 => Self::second(bytes),
            _ => {
                let message = format!(
                    "this is an HDF5 file of version {version}, which is not known; {REWRITE}"
                );
                return Err(of_file(code::FORMAT_NOT_READ, message));
            }
        };
        file.filter(|file| {
            let is_known = |width| [2, 4, 8].contains(&width);
            is_known(file.offset) && is_known(file.length)
        })
        .ok_or_else(|| damaged("its first block is cut off"))
    }

    fn first(bytes: &'a [u8], version: u8) -> Option<Self> {
        let (offset, length) = ((*bytes.get(13)?).into(), (*bytes.get(14)?).into());
        let addresses = if version == 0 { 24 } else { 28 };
        let mut file = Self {
            bytes,
            offset,
            length,
            root: 0,
        };
        // base, free space, end, driver; then the name of the outermost group, and its header
        let mut cursor = file.cursor(addresses)?;
        cursor.take(offset.checked_mul(5)?)?;
        file.root = cursor.uint(offset)?;
        Some(file)
    }

    fn second(bytes: &'a [u8]) -> Option<Self> {
        let (offset, length) = ((*bytes.get(9)?).into(), (*bytes.get(10)?).into());
        let mut file = Self {
            bytes,
            offset,
            length,
            root: 0,
        };
        let mut cursor = file.cursor(12)?;
        cursor.take(offset.checked_mul(3)?)?;
        file.root = cursor.uint(offset)?;
        Some(file)
    }

    /// Reads from an address on.
    pub(super) fn cursor(&self, address: u64) -> Option<Cursor<'a>> {
        let rest = self.bytes.get(usize::try_from(address).ok()?..)?;
        Some(Cursor {
            rest,
            offset: self.offset,
            length: self.length,
        })
    }

    pub(super) fn slice(&self, address: u64, length: usize) -> Option<&'a [u8]> {
        self.cursor(address)?.take(length)
    }

    /// Whether an address leads nowhere.
    pub(super) fn is_undefined(&self, address: u64) -> bool {
        is_undefined(address, self.offset)
    }

    pub(super) fn len(&self) -> usize {
        self.bytes.len()
    }

    /// Reads what is a part of the file.
    pub(super) fn within(&self, rest: &'a [u8]) -> Cursor<'a> {
        Cursor {
            rest,
            offset: self.offset,
            length: self.length,
        }
    }
}

/// Reads numbers one behind the other.
#[derive(Clone, Copy)]
pub(super) struct Cursor<'a> {
    rest: &'a [u8],
    offset: usize,
    length: usize,
}

impl<'a> Cursor<'a> {
    pub(super) fn rest(&self) -> &'a [u8] {
        self.rest
    }

    pub(super) fn take(&mut self, length: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(length)?;
        self.rest = rest;
        Some(taken)
    }

    pub(super) fn u8(&mut self) -> Option<u8> {
        self.take(1)?.first().copied()
    }

    pub(super) fn u16(&mut self) -> Option<u16> {
        self.take(2)?.try_into().ok().map(u16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.take(4)?.try_into().ok().map(u32::from_le_bytes)
    }

    /// A number of up to eight bytes.
    pub(super) fn uint(&mut self, width: usize) -> Option<u64> {
        if width > 8 {
            return None;
        }
        let bytes = self.take(width)?.iter().rev();
        Some(bytes.fold(0, |sum, &byte| sum << 8 | u64::from(byte)))
    }

    /// An address.
    pub(super) fn address(&mut self) -> Option<u64> {
        self.uint(self.offset)
    }

    /// A length in bytes, or a count.
    pub(super) fn size(&mut self) -> Option<u64> {
        self.uint(self.length)
    }

    /// The same as a number of elements in memory.
    pub(super) fn count(&mut self) -> Option<usize> {
        usize::try_from(self.size()?).ok()
    }

    /// Bytes of an address.
    pub(super) fn offset(&self) -> usize {
        self.offset
    }

    /// Whether an address leads nowhere.
    pub(super) fn is_undefined(&self, address: u64) -> bool {
        is_undefined(address, self.offset)
    }

    /// A text up to a zero byte, behind which reading goes on.
    pub(super) fn text(&mut self) -> Option<String> {
        let end = memchr::memchr(0, self.rest)?;
        let text = self.take(end)?;
        self.take(1)?;
        Some(match str::from_utf8(text) {
            Ok(text) => text.to_string(),
            // programs of before write Latin-1
            Err(_) => text.iter().map(|&byte| char::from(byte)).collect(),
        })
    }
}

/// All bits of an address that leads nowhere are set, of as many bytes as addresses have.
fn is_undefined(address: u64, width: usize) -> bool {
    let bits = u32::try_from(width.saturating_mul(8)).unwrap_or(u64::BITS);
    address == u64::MAX >> u64::BITS.saturating_sub(bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_that_leads_nowhere_is_as_wide_as_others() {
        assert!(is_undefined(u64::MAX, 8) && is_undefined(0xffff_ffff, 4));
        assert!(!is_undefined(0xffff_ffff, 8) && !is_undefined(0xffff, 4));
        assert!(is_undefined(0xffff, 2));
    }
}
