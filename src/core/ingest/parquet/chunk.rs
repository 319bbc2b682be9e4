//! A column, page by page.

use super::super::{code, fault::of_file};
use super::codec;
use super::compact::Compact;
use super::damage::damaged;
use super::decode::Encoded;
use super::footer::Place;
use super::hybrid;
use super::page::Head;
use super::schema::{Leaf, Why};
use super::values::{Kind, Trouble, Values};

/// What was read of a column.
pub(super) struct Chunk<'a> {
    bytes: &'a [u8],
    leaf: &'a Leaf,
    kind: Kind,
    /// Bytes that may still be unpacked.
    room: &'a mut usize,
    dictionary: Option<Values>,
    pub(super) values: Values,
}

impl<'a> Chunk<'a> {
    pub(super) fn new(bytes: &'a [u8], leaf: &'a Leaf, kind: Kind, room: &'a mut usize) -> Self {
        Self {
            bytes,
            leaf,
            kind,
            room,
            dictionary: None,
            values: Values::of(kind),
        }
    }

    /// Reads the values of a group of rows.
    pub(super) fn read(&mut self, place: Option<&Place>, rows: usize) -> Result<(), Why> {
        let place = place.ok_or_else(|| damaged("a group of rows lacks a column"))?;
        let end = place.start.saturating_add(place.length);
        let mut bytes = self
            .bytes
            .get(place.start..end.min(self.bytes.len()))
            .unwrap_or_default();
        let end = self.values.len() + rows;
        self.dictionary = None;
        while self.values.len() < end {
            let mut compact = Compact::of(bytes);
            let head = Head::read(&mut compact)?;
            let (page, behind) = compact
                .rest()
                .split_at_checked(head.packed)
                .ok_or_else(|| damaged("a page is cut off"))?;
            bytes = behind;
            if head.is_dictionary() {
                self.read_dictionary(&head, page, place.codec)?;
            } else if head.is_data() {
                if head.count > end - self.values.len() {
                    return Err(damaged("a column has more values than rows").into());
                }
                self.read_data(&head, page, place.codec)?;
            }
        }
        Ok(())
    }

    fn read_dictionary(&mut self, head: &Head, page: &[u8], codec: i64) -> Result<(), Why> {
        let bytes = codec::unpack(codec, page, head.length, self.room)?;
        let mut dictionary = Values::of(self.kind);
        let encoded = Encoded {
            kind: self.kind,
            // the only way there is, whatever it is called
            encoding: super::decode::encoding::PLAIN,
            bytes: &bytes,
            dictionary: None,
        };
        encoded
            .decode_into(&mut dictionary, head.count, self.room)
            .map_err(|trouble| why(trouble, head))?;
        self.dictionary = Some(dictionary);
        Ok(())
    }

    fn read_data(&mut self, head: &Head, page: &[u8], codec: i64) -> Result<(), Why> {
        let (levels, packed) = page
            .split_at_checked(head.levels)
            .ok_or_else(|| damaged("a page is shorter than its levels"))?;
        let length = head.length - head.levels;
        let bytes = match packed.is_empty() {
            true => Vec::new(),
            false => codec::unpack(head.codec(codec), packed, length, self.room)?,
        };
        let (levels, bytes) = match head.is_second() {
            true => (levels, &bytes[..]),
            false => self.levels_within(&bytes)?,
        };
        let is_present = self.presence(levels, head.count)?;
        let encoded = Encoded {
            kind: self.kind,
            encoding: head.encoding,
            bytes,
            dictionary: self.dictionary.as_ref(),
        };
        self.values
            .push_page(&encoded, &is_present, self.room)
            .map_err(|trouble| why(trouble, head))
    }

    /// The levels that stand before the values of a page of the first version, behind their length.
    fn levels_within<'p>(&self, bytes: &'p [u8]) -> Result<(&'p [u8], &'p [u8]), Why> {
        if self.leaf.present == 0 {
            return Ok((&[], bytes));
        }
        let split = || {
            let (length, rest) = bytes.split_first_chunk()?;
            rest.split_at_checked(u32::from_le_bytes(*length) as usize)
        };
        Ok(split().ok_or_else(|| damaged("a page is shorter than its levels"))?)
    }

    /// Which of `count` values are there.
    fn presence(&self, levels: &[u8], count: usize) -> Result<Vec<bool>, Why> {
        let present = self.leaf.present;
        if present == 0 {
            return Ok(vec![true; count]);
        }
        let width = present.ilog2() + 1;
        let levels = hybrid::numbers(levels, width, count)
            .ok_or_else(|| damaged("a page has too few levels"))?;
        Ok(levels.into_iter().map(|level| level == present).collect())
    }
}

fn why(trouble: Trouble, head: &Head) -> Why {
    match trouble {
        Trouble::Damaged => damaged("a page has fewer values than it says").into(),
        Trouble::Encoding => Why::NotRead(format!(
            "its values are encoded in way {}, which is not read",
            head.encoding
        )),
        Trouble::TooLong => {
            let message = "the texts of the Parquet file are longer than the longest body that is taken; leave out columns of text";
            of_file(code::UNPACKED_TOO_LARGE, message).into()
        }
    }
}
