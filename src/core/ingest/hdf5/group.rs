//! What is in a group, by name.

use super::damage::damaged;
use super::file::File;
use super::header::{Header, kind};
use super::heap::Heap;
use super::tree;
use crate::flight::Fault;

/// Nodes of the tree that lists a group.
const MOST_NODES: usize = 100_000;

/// The names in a group with the addresses of their headers; at most `most` and one.
///
/// # Errors
/// The group is damaged.
pub(super) fn members(
    file: &File,
    header: &Header,
    most: usize,
) -> Result<Vec<(String, u64)>, Fault> {
    if let Some(message) = header.find(kind::SYMBOL_TABLE) {
        let mut cursor = file.within(message);
        let listed = || Some((cursor.address()?, cursor.address()?));
        let mut table = Table {
            file,
            members: Vec::new(),
            most,
            nodes: 0,
        };
        return { listed }()
            .and_then(|(tree, heap)| table.read(tree, heap))
            .map(|()| table.members)
            .ok_or_else(|| damaged("the list of a group cannot be read"));
    }
    let mut members = Vec::new();
    let unread = || damaged("a link cannot be read");
    for message in header.all(kind::LINK).take(most + 1) {
        let link = link(file, message).ok_or_else(unread)?;
        members.extend(link);
    }
    if let Some(info) = header.find(kind::LINK_INFO) {
        members.extend(dense(file, info, most).ok_or_else(unread)?);
    }
    Ok(members)
}

/// The links of a group that are in a heap, by their names.
fn dense(file: &File, info: &[u8], most: usize) -> Option<Vec<(String, u64)>> {
    let mut cursor = file.within(info);
    let flags = cursor.take(2)?[1];
    cursor.take(if flags & 1 != 0 { 8 } else { 0 })?;
    let (heap, index) = (cursor.address()?, cursor.address()?);
    if file.is_undefined(heap) || file.is_undefined(index) {
        return Some(Vec::new());
    }
    let heap = Heap::read(file, heap)?;
    let mut members = Vec::new();
    for record in tree::records(file, index, most)? {
        // behind the hash of the name
        members.extend(link(file, heap.object(record.get(4..)?)?)?);
    }
    members.sort_unstable();
    Some(members)
}

/// A message of a link; nothing where it leads to a name or another file.
fn link(file: &File, message: &[u8]) -> Option<Option<(String, u64)>> {
    let mut cursor = file.within(message);
    if cursor.u8()? != 1 {
        return None;
    }
    let flags = cursor.u8()?;
    let kind = if flags & 8 != 0 { cursor.u8()? } else { 0 };
    cursor.take(if flags & 4 != 0 { 8 } else { 0 })?;
    cursor.take(if flags & 16 != 0 { 1 } else { 0 })?;
    let length = usize::try_from(cursor.uint(1 << (flags & 3))?).ok()?;
    let name = String::from_utf8_lossy(cursor.take(length)?).into_owned();
    match kind {
        0 => Some(Some((name, cursor.address()?))),
        _ => Some(None),
    }
}

/// A list as a tree of names.
struct Table<'f, 'a> {
    file: &'f File<'a>,
    members: Vec<(String, u64)>,
    most: usize,
    nodes: usize,
}

impl Table<'_, '_> {
    fn read(&mut self, tree: u64, heap: u64) -> Option<()> {
        let mut cursor = self.file.cursor(heap)?;
        if cursor.take(8)?[..4] != *b"HEAP" {
            return None;
        }
        let length = cursor.count()?;
        cursor.size()?;
        let names = self.file.slice(cursor.address()?, length)?;
        self.node(tree, names, None)
    }

    /// `above` is the level of the node above.
    fn node(&mut self, address: u64, names: &[u8], above: Option<u8>) -> Option<()> {
        self.nodes += 1;
        let mut cursor = self.file.cursor(address)?;
        if self.nodes > MOST_NODES || cursor.take(4)? != b"TREE" || cursor.u8()? != 0 {
            return None;
        }
        let level = cursor.u8()?;
        if above.is_some_and(|above| level >= above) {
            return None;
        }
        let count = cursor.u16()?;
        cursor.address()?;
        cursor.address()?;
        for _ in 0..count {
            cursor.size()?;
            let child = cursor.address()?;
            if self.members.len() > self.most {
                break;
            }
            match level {
                0 => self.leaf(child, names)?,
                _ => self.node(child, names, Some(level))?,
            }
        }
        Some(())
    }

    fn leaf(&mut self, address: u64, names: &[u8]) -> Option<()> {
        let mut cursor = self.file.cursor(address)?;
        if cursor.take(6)?[..4] != *b"SNOD" {
            return None;
        }
        for _ in 0..cursor.u16()? {
            let at = usize::try_from(cursor.address()?).ok()?;
            let header = cursor.address()?;
            let kind = cursor.u32()?;
            cursor.take(20)?;
            if self.members.len() > self.most {
                break;
            }
            // 2: it leads to a name
            if kind < 2 {
                let name = self.file.within(names.get(at..)?).text()?;
                self.members.push((name, header));
            }
        }
        Some(())
    }
}
