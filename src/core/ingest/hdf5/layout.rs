//! Where the bytes of a dataset are: in its header, in one piece, or in chunks.

use super::file::Cursor;
use super::index::Index;

pub(super) enum Layout<'a> {
    Compact(&'a [u8]),
    Contiguous(u64),
    Chunked(Index, Vec<u64>),
    NotRead,
}

pub(super) fn layout(mut cursor: Cursor<'_>) -> Option<Layout<'_>> {
    let version = cursor.u8()?;
    if !(3..=5).contains(&version) {
        return Some(Layout::NotRead);
    }
    Some(match cursor.u8()? {
        0 => {
            let length = cursor.u16()?;
            Layout::Compact(cursor.take(length.into())?)
        }
        1 => Layout::Contiguous(cursor.address()?),
        2 if version == 3 => {
            let rank = usize::from(cursor.u8()?).checked_sub(1)?;
            let address = cursor.address()?;
            let chunk = (0..rank).map(|_| cursor.u32().map(u64::from));
            Layout::Chunked(Index::Tree { address }, chunk.collect::<Option<_>>()?)
        }
        2 => chunked(&mut cursor)?,
        _ => Layout::NotRead,
    })
}

/// Chunks of versions 4 and 5, which differ in how long a chunk may be.
fn chunked<'a>(cursor: &mut Cursor<'a>) -> Option<Layout<'a>> {
    let flags = cursor.u8()?;
    let rank = usize::from(cursor.u8()?).checked_sub(1)?;
    let width = usize::from(cursor.u8()?);
    let chunk = (0..rank)
        .map(|_| cursor.uint(width))
        .collect::<Option<_>>()?;
    cursor.uint(width)?;
    let index = match cursor.u8()? {
        1 => {
            let packed = match flags & 2 {
                0 => None,
                _ => Some((cursor.count()?, cursor.u32()?)),
            };
            let address = cursor.address()?;
            Index::Single { address, packed }
        }
        2 => Index::Implicit {
            address: cursor.address()?,
        },
        3 => {
            cursor.u8()?;
            Index::FixedArray {
                address: cursor.address()?,
            }
        }
        _ => Index::NotRead,
    };
    let is_written = match index {
        Index::Single { address, .. }
        | Index::Implicit { address }
        | Index::FixedArray { address } => !cursor.is_undefined(address),
        _ => true,
    };
    Some(Layout::Chunked(
        if is_written { index } else { Index::Empty },
        chunk,
    ))
}
