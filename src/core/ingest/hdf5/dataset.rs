//! A dataset: its shape, what its elements are, and their bytes.

use super::super::{code, fault::of_file};
use super::damage::{REWRITE, damaged};
use super::datatype::Type;
use super::file::{Cursor, File};
use super::filters::Filters;
use super::header::{Header, kind};
use super::index::{Grid, Index};
use super::layout::{Layout, layout};
use crate::flight::Fault;

pub(super) struct Dataset<'a> {
    pub(super) dimensions: Vec<u64>,
    pub(super) kind: Type,
    /// What the dimensions may become.
    largest: Vec<u64>,
    layout: Layout<'a>,
    filters: Filters,
    /// An element that was not written; `None`: zeros.
    fill: Option<&'a [u8]>,
}

/// Dimensions of a dataset.
const MOST_DIMENSIONS: usize = 32;

impl<'a> Dataset<'a> {
    /// The dataset of a header; `None` where it is that of a group.
    ///
    /// # Errors
    /// It is damaged.
    pub(super) fn read(file: &File<'a>, header: &Header<'a>) -> Result<Option<Self>, Fault> {
        let Some(layout) = header.find(kind::LAYOUT) else {
            return Ok(None);
        };
        let of_message = |kind| header.find(kind).map(|message| file.within(message));
        let dimensions = of_message(kind::DATASPACE).and_then(dimensions);
        let (dimensions, largest) = dimensions.ok_or_else(|| damaged("a dataset has no shape"))?;
        // a type that stands elsewhere is one that somebody named
        let kind = match of_message(kind::DATATYPE) {
            Some(mut cursor) => Type::read(&mut cursor)
                .ok_or_else(|| damaged("what a dataset holds cannot be read"))?,
            None => Type::Other("elements of a named type", 0),
        };
        let layout = self::layout(file.within(layout))
            .ok_or_else(|| damaged("where a dataset is cannot be read"))?;
        let filters = match header.find(kind::FILTERS) {
            Some(message) => Filters::read(file, message)?,
            None => Filters::none(),
        };
        Ok(Some(Self {
            dimensions,
            kind,
            largest,
            layout,
            filters,
            // a file of the library's first versions has the older message alone
            fill: match of_message(kind::FILL) {
                Some(message) => fill(message),
                None => of_message(kind::OLD_FILL).and_then(old_fill),
            },
        }))
    }

    /// How many elements it has.
    pub(super) fn count(&self) -> Option<usize> {
        let count = self
            .dimensions
            .iter()
            .try_fold(1u64, |all, size| all.checked_mul(*size))?;
        usize::try_from(count).ok()
    }

    /// The bytes of all elements, the last dimension first; so many of `room` are taken.
    ///
    /// # Errors
    /// There is less room; it is damaged, or stored in a way that is not read.
    pub(super) fn bytes(&self, file: &File<'a>, room: &mut usize) -> Result<Vec<u8>, Fault> {
        let length = self
            .count()
            .and_then(|count| count.checked_mul(self.kind.width()));
        let length = length.unwrap_or(usize::MAX);
        take(room, length)?;
        let cut_off = || damaged("the values of a dataset are cut off");
        match &self.layout {
            Layout::Compact(bytes) => {
                let bytes = bytes.get(..length).ok_or_else(cut_off)?;
                Ok(bytes.to_vec())
            }
            Layout::Contiguous(address) if file.is_undefined(*address) => self.unwritten(length),
            Layout::Contiguous(address) => {
                let bytes = file.slice(*address, length).ok_or_else(cut_off)?;
                Ok(bytes.to_vec())
            }
            Layout::Chunked(index, chunk) => self.chunked(file, index, chunk, length, room),
            Layout::NotRead => Err(not_read()),
        }
    }

    /// So many bytes of a dataset of which nothing was written.
    fn unwritten(&self, length: usize) -> Result<Vec<u8>, Fault> {
        let fill = self.fill.unwrap_or_default();
        if fill.iter().all(|byte| *byte == 0) {
            return Ok(vec![0; length]);
        }
        if fill.len() != self.kind.width() {
            return Err(damaged("what a dataset is filled with is no element"));
        }
        Ok(fill.repeat(length / fill.len()))
    }

    fn chunked(
        &self,
        file: &File<'a>,
        index: &Index,
        chunk: &[u64],
        length: usize,
        room: &mut usize,
    ) -> Result<Vec<u8>, Fault> {
        if matches!(index, Index::NotRead) {
            return Err(not_read());
        }
        let wrong = || damaged("the chunks of a dataset cannot be found");
        let width = self.kind.width();
        let of_chunk = chunk
            .iter()
            .try_fold(width as u64, |all, size| all.checked_mul(*size));
        let of_chunk = of_chunk.and_then(|length| usize::try_from(length).ok());
        let of_chunk = of_chunk.filter(|length| *length > 0).ok_or_else(wrong)?;
        if chunk.len() != self.dimensions.len() {
            return Err(wrong());
        }
        // some chunks have numbers, which leave room for those that may still come
        let is_numbered = matches!(index, Index::Implicit { .. } | Index::FixedArray { .. });
        let grid = Grid {
            dimensions: match is_numbered {
                true => &self.largest,
                false => &self.dimensions,
            },
            chunk,
            length: of_chunk,
        };
        let mut bytes = self.unwritten(length)?;
        if length == 0 {
            return Ok(bytes);
        }
        for found in index.chunks(file, &grid).ok_or_else(wrong)? {
            let mut places = found.at.iter().zip(&self.dimensions);
            if places.any(|(at, size)| at >= size) {
                continue;
            }
            take(room, of_chunk)?;
            // packing makes little of it longer
            if found.bytes.len() > of_chunk.saturating_mul(2).saturating_add(4096) {
                return Err(wrong());
            }
            let undone;
            let plain = match self.filters.is_empty() {
                true => found.bytes,
                false => {
                    undone =
                        self.filters
                            .undo(found.bytes, found.mask, of_chunk.saturating_add(4))?;
                    &undone
                }
            };
            let plain = plain.get(..of_chunk).ok_or_else(wrong)?;
            place(&mut bytes, &self.dimensions, plain, chunk, &found.at, width)
                .ok_or_else(wrong)?;
        }
        Ok(bytes)
    }
}

fn take(room: &mut usize, length: usize) -> Result<(), Fault> {
    *room = room.checked_sub(length).ok_or_else(|| {
        let message = "the datasets of the HDF5 file have more values than a recording may; leave out what the estimation does not need, or send a shorter part";
        of_file(code::TOO_MANY_VALUES, message)
    })?;
    Ok(())
}

fn not_read() -> Fault {
    let message = format!("the HDF5 file stores a dataset in a way that is not read; {REWRITE}");
    of_file(code::FORMAT_NOT_READ, message)
}

/// Copies what of a chunk is within the dataset to its place.
fn place(
    bytes: &mut [u8],
    dimensions: &[u64],
    plain: &[u8],
    chunk: &[u64],
    at: &[u64],
    width: usize,
) -> Option<()> {
    // what there is of the chunk in each dimension
    let sizes = dimensions.iter().zip(chunk).zip(at);
    let sizes: Vec<u64> = sizes
        .map(|((size, chunk), at)| size.saturating_sub(*at).min(*chunk))
        .collect();
    let (&run, outer) = sizes.split_last()?;
    if sizes.contains(&0) {
        return Some(());
    }
    let length = usize::try_from(run).ok()?.checked_mul(width)?;
    let mut within = vec![0u64; outer.len()];
    loop {
        let (mut from, mut to) = (0u64, 0u64);
        for axis in 0..dimensions.len() {
            let step = within.get(axis).copied().unwrap_or(0);
            from = from.checked_mul(chunk[axis])?.checked_add(step)?;
            to = to
                .checked_mul(dimensions[axis])?
                .checked_add(at[axis].checked_add(step)?)?;
        }
        let from = usize::try_from(from).ok()?.checked_mul(width)?;
        let to = usize::try_from(to).ok()?.checked_mul(width)?;
        let source = plain.get(from..from.checked_add(length)?)?;
        bytes
            .get_mut(to..to.checked_add(length)?)?
            .copy_from_slice(source);
        // the next row of the chunk
        let mut axis = outer.len();
        loop {
            let Some(before) = axis.checked_sub(1) else {
                return Some(());
            };
            axis = before;
            within[axis] += 1;
            if within[axis] < outer[axis] {
                break;
            }
            within[axis] = 0;
        }
    }
}

/// The size in every dimension, and the largest that it may have; none of a single value.
fn dimensions(mut cursor: Cursor) -> Option<(Vec<u64>, Vec<u64>)> {
    let version = cursor.u8()?;
    let rank = usize::from(cursor.u8()?);
    let has_largest = cursor.u8()? & 1 != 0;
    match version {
        1 => cursor.take(5)?,
        // 2: there is nothing
        2 => match cursor.u8()? {
            2 => return Some((vec![0], vec![0])),
            _ => &[],
        },
        _ => return None,
    };
    if rank > MOST_DIMENSIONS {
        return None;
    }
    let mut sizes = || {
        (0..rank)
            .map(|_| cursor.size())
            .collect::<Option<Vec<u64>>>()
    };
    let dimensions = sizes()?;
    let largest = match has_largest {
        true => sizes()?,
        false => dimensions.clone(),
    };
    Some((dimensions, largest))
}

/// The element that stands where nothing was written; `None` where it is not said.
fn fill(mut cursor: Cursor<'_>) -> Option<&[u8]> {
    let is_said = match cursor.u8()? {
        1 | 2 => cursor.take(3)?[2] != 0,
        3 => cursor.u8()? & 0x20 != 0,
        _ => false,
    };
    let length = is_said.then(|| cursor.u32()).flatten()?;
    cursor.take(length as usize)
}

/// The same in the older message.
fn old_fill(mut cursor: Cursor<'_>) -> Option<&[u8]> {
    let length = cursor.u32()?;
    cursor.take(length as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a header is, and what is elsewhere.
    const HEADER: usize = 48;
    const ELSEWHERE: usize = 512;
    const NOWHERE: u64 = u64::MAX;

    fn words(words: &[u64]) -> Vec<u8> {
        words.iter().flat_map(|word| word.to_le_bytes()).collect()
    }

    /// The bytes of a dataset of bytes with a shape, the largest one, and some messages.
    fn read(
        shape: &[u64],
        largest: &[u64],
        messages: &[(u16, Vec<u8>)],
        elsewhere: &[u8],
    ) -> Result<Vec<u8>, Fault> {
        let mut space = vec![1, shape.len() as u8, 1, 0, 0, 0, 0, 0];
        space.extend(words(shape));
        space.extend(words(largest));
        let of_bytes = vec![0x10, 0, 0, 0, 1, 0, 0, 0, 0, 0, 8, 0];
        let own = [(kind::DATASPACE, space), (kind::DATATYPE, of_bytes)];
        let mut header = Vec::new();
        for (kind, message) in own.iter().chain(messages) {
            header.extend(kind.to_le_bytes());
            header.extend((message.len() as u16).to_le_bytes());
            header.extend([0; 4]);
            header.extend(message);
        }
        let mut bytes = super::super::file::SIGNATURE.to_vec();
        bytes.extend([2, 8, 8, 0]);
        bytes.resize(HEADER, 0);
        bytes.extend([1, 0, 0, 0, 1, 0, 0, 0]);
        bytes.extend((header.len() as u64).to_le_bytes());
        bytes.extend(header);
        bytes.resize(ELSEWHERE, 0);
        bytes.extend(elsewhere);
        let file = File::of(&bytes)?;
        let header = Header::read(&file, HEADER as u64, &mut 1000)?;
        let dataset = Dataset::read(&file, &header)?.expect("a dataset");
        dataset.bytes(&file, &mut 1000)
    }

    /// Chunks of one row and two columns in an array of so many, of which some are written.
    fn in_array(chunks: &[Option<[u8; 2]>]) -> ((u16, Vec<u8>), Vec<u8>) {
        let mut layout = vec![4, 2, 0, 3, 1, 1, 2, 1, 3, 10];
        layout.extend(words(&[ELSEWHERE as u64]));
        let block = ELSEWHERE + 24;
        let mut array = b"FAHD\0\0\x08\x0a".to_vec();
        array.extend(words(&[chunks.len() as u64, block as u64]));
        array.extend(b"FADB\0\0");
        array.extend(words(&[ELSEWHERE as u64]));
        let start = block + 14 + 8 * chunks.len();
        let mut values: Vec<u8> = Vec::new();
        for chunk in chunks {
            let address = chunk.map_or(NOWHERE, |_| (start + values.len()) as u64);
            array.extend(words(&[address]));
            values.extend(chunk.iter().flatten());
        }
        array.extend(values);
        ((kind::LAYOUT, layout), array)
    }

    #[test]
    fn what_was_not_written_has_the_value_that_the_file_says() {
        let (layout, array) = in_array(&[Some([1, 2]), None]);
        let of_chunks = |fill: &[u8]| {
            let messages = [layout.clone(), (kind::FILL, fill.to_vec())];
            read(&[2, 2], &[2, 2], &messages, &array).unwrap()
        };
        assert_eq!(of_chunks(&[3, 0x20, 1, 0, 0, 0, 7]), [1, 2, 7, 7]);
        assert_eq!(of_chunks(&[2, 1, 0, 1, 1, 0, 0, 0, 7]), [1, 2, 7, 7]);
        assert_eq!(of_chunks(&[2, 1, 0, 0]), [1, 2, 0, 0]);
        assert_eq!(of_chunks(&[3, 0]), [1, 2, 0, 0]);
        let old = |message: &[(u16, Vec<u8>)]| {
            let messages = [std::slice::from_ref(&layout), message].concat();
            read(&[2, 2], &[2, 2], &messages, &array).unwrap()
        };
        let in_old = (kind::OLD_FILL, vec![1, 0, 0, 0, 5]);
        assert_eq!(old(std::slice::from_ref(&in_old)), [1, 2, 5, 5]);
        let in_new = (kind::FILL, vec![3, 0x20, 1, 0, 0, 0, 7]);
        assert_eq!(old(&[in_old, in_new]), [1, 2, 7, 7]);
        let mut layout = vec![3, 1];
        layout.extend(words(&[NOWHERE, 4]));
        let fill = (kind::FILL, vec![1, 1, 0, 1, 1, 0, 0, 0, 9]);
        let messages = [(kind::LAYOUT, layout), fill];
        assert_eq!(read(&[2, 2], &[2, 2], &messages, &[]).unwrap(), [9; 4]);
    }

    #[test]
    fn chunks_are_numbered_by_the_largest_shape() {
        let (layout, array) = in_array(&[Some([1, 2]), None, Some([3, 4]), None]);
        assert_eq!(
            read(&[2, 2], &[2, 4], &[layout], &array).unwrap(),
            [1, 2, 3, 4]
        );
    }
}
