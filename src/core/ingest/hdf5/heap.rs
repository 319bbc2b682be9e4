//! A heap of small objects, in blocks that double in size ("fractal heap").

use super::file::File;

/// Blocks on the way to an object: each is within a larger one.
const DEEPEST: u32 = 32;

pub(super) struct Heap<'f, 'a> {
    file: &'f File<'a>,
    /// Blocks of a row, and bytes of one in the first.
    width: u64,
    start: u64,
    /// Rows whose blocks have objects in them; those of the others have blocks.
    direct: u32,
    /// Bytes of an offset within the heap, and of a length.
    of_offset: usize,
    of_length: usize,
    root: u64,
    /// Rows of the root; none where it is one block of objects.
    rows: u32,
}

impl<'f, 'a> Heap<'f, 'a> {
    /// `None` where it is damaged, or packed.
    pub(super) fn read(file: &'f File<'a>, address: u64) -> Option<Self> {
        let mut cursor = file.cursor(address)?;
        if cursor.take(7)?[..4] != *b"FRHP" {
            return None;
        }
        let filters = cursor.u16()?;
        cursor.take(1)?;
        let largest = cursor.u32()?.into();
        cursor.size()?;
        cursor.address()?;
        cursor.size()?;
        cursor.address()?;
        for _ in 0..8 {
            cursor.size()?;
        }
        let width = cursor.u16()?.into();
        let (start, most) = (cursor.size()?, cursor.size()?);
        let bits = u32::from(cursor.u16()?);
        cursor.take(2)?;
        let root = cursor.address()?;
        let rows = cursor.u16()?.into();
        if filters != 0 || width == 0 || !start.is_power_of_two() || !most.is_power_of_two() {
            return None;
        }
        let direct = most.ilog2().checked_sub(start.ilog2())? + 2;
        Some(Self {
            file,
            width,
            start,
            direct,
            of_offset: usize::try_from(bits.div_ceil(8)).ok()?,
            of_length: bytes_for(most.ilog2()).min(bytes_for(u64::checked_ilog2(largest)? + 1)),
            root,
            rows,
        })
    }

    /// The object of an identifier.
    pub(super) fn object(&self, identifier: &'a [u8]) -> Option<&'a [u8]> {
        let mut cursor = self.file.within(identifier);
        let head = cursor.u8()?;
        match head >> 4 & 3 {
            0 => {
                let offset = cursor.uint(self.of_offset)?;
                let length = usize::try_from(cursor.uint(self.of_length)?).ok()?;
                let (address, within) = self.block(offset)?;
                self.file.slice(address.checked_add(within)?, length)
            }
            // so small that it stands in its identifier
            2 => cursor.take(usize::from(head & 15) + 1),
            _ => None,
        }
    }

    /// The block of objects that has an offset, and the place in it.
    fn block(&self, offset: u64) -> Option<(u64, u64)> {
        let (mut address, mut rows, mut within) = (self.root, self.rows, offset);
        for _ in 0..DEEPEST {
            if rows == 0 {
                let is_block = self.file.slice(address, 4)? == b"FHDB";
                return is_block.then_some((address, within));
            }
            let (row, column, rest) = self.place(within)?;
            if row >= rows {
                return None;
            }
            let mut cursor = self.file.cursor(address)?;
            if cursor.take(5)?[..4] != *b"FHIB" {
                return None;
            }
            cursor.address()?;
            cursor.take(self.of_offset)?;
            let before = u64::from(row)
                .checked_mul(self.width)?
                .checked_add(column)?;
            let before = usize::try_from(before).ok()?;
            cursor.take(before.checked_mul(cursor.offset())?)?;
            address = cursor.address()?;
            within = rest;
            rows = match row < self.direct {
                true => 0,
                false => self.rows_within(row)?,
            };
        }
        None
    }

    /// Row and column of the block that has an offset, and the place in it. The blocks of the first two rows are of one size,
    /// those of each further row twice as large.
    fn place(&self, offset: u64) -> Option<(u32, u64, u64)> {
        let of_row = self.width.checked_mul(self.start)?;
        let row = match offset / of_row {
            0 => 0,
            rows => rows.ilog2() + 1,
        };
        let times = 1u64.checked_shl(row.saturating_sub(1))?;
        let begins = if row == 0 {
            0
        } else {
            of_row.checked_mul(times)?
        };
        let size = self.start.checked_mul(times)?;
        let rest = offset.checked_sub(begins)?;
        Some((row, rest / size, rest % size))
    }

    /// Rows of a block of blocks that stands in a row.
    fn rows_within(&self, row: u32) -> Option<u32> {
        let size = self.start.ilog2() + row - 1;
        let of_row = self.start.ilog2() + self.width.ilog2();
        size.checked_sub(of_row)?.checked_add(1)
    }
}

/// Bytes of a number of so many bits.
fn bytes_for(bits: u32) -> usize {
    bits.div_ceil(8) as usize
}
