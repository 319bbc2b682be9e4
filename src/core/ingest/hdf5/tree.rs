//! A tree of version 2: records of one length, in their order.

use super::file::File;

/// Records of all nodes together.
const MOST_RECORDS: usize = 1_000_000;
/// Levels above the leaves.
const DEEPEST: usize = 8;
/// Bytes of a node beside its records: signature, version, kind, checksum.
const OVERHEAD: usize = 10;

struct Tree<'f, 'a> {
    file: &'f File<'a>,
    /// Bytes of a record, and of a node.
    record: usize,
    node: usize,
    /// Bytes of the number of records in a child, and of that in all below it, by level.
    own: usize,
    below: Vec<usize>,
    records: Vec<&'a [u8]>,
    most: usize,
}

/// The records of the tree at an address; at most `most` and one.
pub(super) fn records<'a>(file: &File<'a>, address: u64, most: usize) -> Option<Vec<&'a [u8]>> {
    let mut cursor = file.cursor(address)?;
    if cursor.take(6)?[..4] != *b"BTHD" {
        return None;
    }
    let node = cursor.u32()? as usize;
    let record = usize::from(cursor.u16()?);
    let depth = usize::from(cursor.u16()?);
    cursor.take(2)?;
    let (root, count) = (cursor.address()?, cursor.u16()?);
    if file.is_undefined(root) || count == 0 {
        return Some(Vec::new());
    }
    if depth > DEEPEST || record == 0 {
        return None;
    }
    let mut tree = Tree {
        file,
        record,
        node,
        own: 0,
        below: vec![0],
        records: Vec::new(),
        most: most.min(MOST_RECORDS),
    };
    tree.widths(depth, cursor.offset())?;
    tree.read(root, count.into(), depth)?;
    Some(tree.records)
}

impl<'a> Tree<'_, 'a> {
    /// How wide the numbers of records are: as wide as the most that a full node may have.
    fn widths(&mut self, depth: usize, of_address: usize) -> Option<()> {
        let in_leaf = self.node.checked_sub(OVERHEAD)? / self.record;
        self.own = width(in_leaf);
        let mut all = in_leaf;
        for level in 1..=depth {
            let pointer = of_address + self.own + self.below[level - 1];
            let here = self.node.checked_sub(OVERHEAD + pointer)? / (self.record + pointer);
            all = (here + 1).checked_mul(all)?.checked_add(here)?;
            self.below.push(width(all));
        }
        Some(())
    }

    fn read(&mut self, address: u64, count: usize, level: usize) -> Option<()> {
        let mut cursor = self.file.cursor(address)?;
        let signature: &[u8] = if level == 0 { b"BTLF" } else { b"BTIN" };
        if cursor.take(6)?[..4] != *signature {
            return None;
        }
        let length = count.checked_mul(self.record)?;
        let mut records = cursor.take(length)?.chunks_exact(self.record);
        if level == 0 {
            let room = (self.most + 1).saturating_sub(self.records.len());
            self.records.extend(records.take(room));
            return Some(());
        }
        // a child stands before each record, and one behind the last
        for _ in 0..=count {
            let child = cursor.address()?;
            let in_child = usize::try_from(cursor.uint(self.own)?).ok()?;
            cursor.take(if level > 1 { self.below[level - 1] } else { 0 })?;
            self.read(child, in_child, level - 1)?;
            if self.records.len() > self.most {
                return Some(());
            }
            self.records.extend(records.next());
        }
        Some(())
    }
}

/// Bytes that hold a number.
fn width(most: usize) -> usize {
    let bits = (usize::BITS - most.leading_zeros()).max(1) as usize;
    bits.div_ceil(8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_wide_as_the_most_of_them() {
        assert_eq!(
            [0, 1, 255, 256, 65_535, 65_536].map(width),
            [1, 1, 1, 2, 2, 3]
        );
    }
}
