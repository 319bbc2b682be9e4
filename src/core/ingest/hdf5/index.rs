//! Where the chunks of a dataset are.

use super::file::{Cursor, File};

/// A chunk as it stands in the file.
pub(super) struct Chunk<'a> {
    /// The place of its first element in the dataset.
    pub(super) at: Vec<u64>,
    pub(super) bytes: &'a [u8],
    /// A bit for each filter that was not applied.
    pub(super) mask: u32,
}

/// Chunks of a dataset: one for every two samples of the longest recording.
const MOST_CHUNKS: usize = 1_000_000;

/// How chunks are found.
#[derive(Clone, Copy, Debug)]
pub(super) enum Index {
    Tree {
        address: u64,
    },
    /// The only one: its bytes and mask, where it is packed.
    Single {
        address: u64,
        packed: Option<(usize, u32)>,
    },
    /// One behind the other.
    Implicit {
        address: u64,
    },
    FixedArray {
        address: u64,
    },
    /// No chunk was written.
    Empty,
    NotRead,
}

/// The shape of a dataset and of its chunks.
pub(super) struct Grid<'g> {
    pub(super) dimensions: &'g [u64],
    pub(super) chunk: &'g [u64],
    /// Bytes of a chunk.
    pub(super) length: usize,
}

impl Grid<'_> {
    /// Chunks along every dimension.
    fn counts(&self) -> Option<Vec<u64>> {
        let pairs = self.dimensions.iter().zip(self.chunk);
        pairs
            .map(|(size, chunk)| (*chunk > 0).then(|| size.div_ceil(*chunk)))
            .collect()
    }

    /// Chunks in all.
    pub(super) fn count(&self) -> Option<usize> {
        let counts = self.counts()?;
        let count = counts
            .iter()
            .try_fold(1u64, |all, count| all.checked_mul(*count))?;
        usize::try_from(count).ok()
    }

    /// The place of the chunk with a number.
    fn place(&self, number: usize) -> Option<Vec<u64>> {
        let mut number = number as u64;
        let mut place = vec![0; self.chunk.len()];
        for (axis, count) in self.counts()?.iter().enumerate().rev() {
            place[axis] = number.checked_rem(*count)?.checked_mul(self.chunk[axis])?;
            number = number.checked_div(*count)?;
        }
        Some(place)
    }
}

impl Index {
    /// All chunks that there are; `None` where the index is damaged, or lists more than there can be.
    pub(super) fn chunks<'a>(&self, file: &File<'a>, grid: &Grid) -> Option<Vec<Chunk<'a>>> {
        let count = grid.count().filter(|count| *count <= MOST_CHUNKS)?;
        match *self {
            Self::Tree { address } => {
                let mut tree = Tree {
                    file,
                    rank: grid.chunk.len(),
                    chunks: Vec::new(),
                    most: count,
                    nodes: 0,
                };
                if !file.is_undefined(address) {
                    tree.node(address, None)?;
                }
                Some(tree.chunks)
            }
            Self::Single { address, packed } => {
                let (length, mask) = packed.unwrap_or((grid.length, 0));
                Some(vec![Chunk {
                    at: grid.place(0)?,
                    bytes: file.slice(address, length)?,
                    mask,
                }])
            }
            Self::Implicit { address } => {
                let chunk = |number: usize| {
                    let start = (number as u64).checked_mul(grid.length as u64)?;
                    Some(Chunk {
                        at: grid.place(number)?,
                        bytes: file.slice(address.checked_add(start)?, grid.length)?,
                        mask: 0,
                    })
                };
                (0..count).map(chunk).collect()
            }
            Self::FixedArray { address } => fixed_array(file, grid, address, count),
            Self::Empty => Some(Vec::new()),
            Self::NotRead => None,
        }
    }
}

/// A tree of chunks by their places.
struct Tree<'f, 'a> {
    file: &'f File<'a>,
    rank: usize,
    chunks: Vec<Chunk<'a>>,
    most: usize,
    nodes: usize,
}

impl Tree<'_, '_> {
    /// `above` is the level of the node above.
    fn node(&mut self, address: u64, above: Option<u8>) -> Option<()> {
        self.nodes += 1;
        let mut cursor = self.file.cursor(address)?;
        let is_of_chunks = cursor.take(4)? == b"TREE" && cursor.u8()? == 1;
        let level = cursor.u8()?;
        let is_below = above.is_none_or(|above| level < above);
        // no node but the first is empty
        if !is_of_chunks || !is_below || self.nodes > self.most.saturating_mul(2).saturating_add(64)
        {
            return None;
        }
        let count = cursor.u16()?;
        cursor.address()?;
        cursor.address()?;
        for _ in 0..count {
            let length = cursor.u32()? as usize;
            let mask = cursor.u32()?;
            let at = (0..self.rank)
                .map(|_| cursor.uint(8))
                .collect::<Option<Vec<u64>>>()?;
            cursor.uint(8)?;
            let child = cursor.address()?;
            if level > 0 {
                self.node(child, Some(level))?;
                continue;
            }
            let bytes = self.file.slice(child, length)?;
            self.chunks.push(Chunk { at, bytes, mask });
            if self.chunks.len() > self.most {
                return None;
            }
        }
        Some(())
    }
}

fn fixed_array<'a>(
    file: &File<'a>,
    grid: &Grid,
    address: u64,
    count: usize,
) -> Option<Vec<Chunk<'a>>> {
    let mut cursor = file.cursor(address)?;
    if cursor.take(5)?[..4] != *b"FAHD" {
        return None;
    }
    let is_packed = cursor.u8()? == 1;
    let width = usize::from(cursor.u8()?);
    let bits = cursor.u8()?;
    let entries = cursor.count()?;
    let mut block = file.cursor(cursor.address()?)?;
    if block.take(6)?[..4] != *b"FADB" || bits > 30 || entries > file.len() {
        return None;
    }
    block.address()?;
    let of_page = 1usize << bits;
    let mut chunks = Vec::new();
    let mut numbers = 0..count.min(entries);
    if entries <= of_page {
        for number in numbers {
            chunks.extend(entry(file, grid, &mut block, number, is_packed, width)?);
        }
        return Some(chunks);
    }
    let pages = entries.div_ceil(of_page);
    let is_there = block.take(pages.div_ceil(8))?;
    block.take(4)?;
    for page in 0..pages {
        let mut within = block;
        let in_page = of_page.min(entries - page * of_page);
        block.take(in_page.checked_mul(width)?.checked_add(4)?)?;
        let is_there = is_there[page / 8] >> (7 - page % 8) & 1 == 1;
        for number in numbers.by_ref().take(in_page) {
            let entry = entry(file, grid, &mut within, number, is_packed, width)?;
            chunks.extend(entry.filter(|_| is_there));
        }
    }
    Some(chunks)
}

/// An entry of an array of chunks; nothing where the chunk was not written.
fn entry<'a>(
    file: &File<'a>,
    grid: &Grid,
    cursor: &mut Cursor<'a>,
    number: usize,
    is_packed: bool,
    width: usize,
) -> Option<Option<Chunk<'a>>> {
    let address = cursor.address()?;
    let (mut length, mut mask) = (grid.length, 0);
    if is_packed {
        let of_length = width.checked_sub(cursor.offset() + 4)?;
        length = usize::try_from(cursor.uint(of_length)?).ok()?;
        mask = cursor.u32()?;
    }
    if file.is_undefined(address) {
        return Some(None);
    }
    Some(Some(Chunk {
        at: grid.place(number)?,
        bytes: file.slice(address, length)?,
        mask,
    }))
}
