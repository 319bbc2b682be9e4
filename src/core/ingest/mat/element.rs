//! Data elements of a MAT file: a tag of kind and length, bytes, padding to eight.

use super::super::{code, fault::of_file, stored::Order};
use crate::flight::Fault;

/// What is not as the format has it.
pub(super) type Damage = &'static str;

pub(super) fn damaged(why: Damage) -> Fault {
    let message = format!("the MAT file is damaged: {why}; save it or upload it again");
    of_file(code::DAMAGED_FILE, message)
}

/// Kinds of elements (`mi` in the format's description).
pub(super) mod kind {
    pub(crate) const INT8: u32 = 1;
    pub(crate) const UINT8: u32 = 2;
    pub(crate) const INT16: u32 = 3;
    pub(crate) const UINT16: u32 = 4;
    pub(crate) const INT32: u32 = 5;
    pub(crate) const UINT32: u32 = 6;
    pub(crate) const SINGLE: u32 = 7;
    pub(crate) const DOUBLE: u32 = 9;
    pub(crate) const INT64: u32 = 12;
    pub(crate) const UINT64: u32 = 13;
    pub(crate) const MATRIX: u32 = 14;
    pub(crate) const COMPRESSED: u32 = 15;
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Element<'a> {
    pub(super) kind: u32,
    pub(super) bytes: &'a [u8],
}

/// The elements that stand one behind another in some bytes.
#[derive(Clone, Copy)]
pub(super) struct Elements<'a> {
    pub(super) rest: &'a [u8],
    pub(super) order: Order,
}

impl<'a> Elements<'a> {
    /// The next element; `None` at the end.
    ///
    /// # Errors
    /// The element is longer than the bytes that are left.
    pub(super) fn next(&mut self) -> Result<Option<Element<'a>>, Damage> {
        if self.rest.is_empty() {
            return Ok(None);
        }
        let (first, second) = self.tag().ok_or("it ends inside the tag of an element")?;
        // an element of up to four bytes stands in its own tag
        let short = (first >> 16) as usize;
        let (kind, length, start) = if short > 0 {
            (first & 0xffff, short, 4)
        } else {
            (first, second as usize, 8)
        };
        if short > 4 {
            return Err("a short element is longer than four bytes");
        }
        let end = start + length;
        let bytes = self
            .rest
            .get(start..end)
            .ok_or("it ends inside an element")?;
        // compressed elements are not padded, and the padding of the last one may be missing
        let padded = if kind == kind::COMPRESSED {
            end
        } else {
            end.next_multiple_of(8)
        };
        self.rest = self.rest.get(padded..).unwrap_or_default();
        Ok(Some(Element { kind, bytes }))
    }

    /// The next element, which must be there.
    pub(super) fn expect(&mut self) -> Result<Element<'a>, Damage> {
        self.next()?.ok_or("an element is missing")
    }

    fn tag(&self) -> Option<(u32, u32)> {
        Some((
            self.order.u32(self.rest)?,
            self.order.u32(self.rest.get(4..)?)?,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn elements(rest: &[u8], order: Order) -> Elements<'_> {
        Elements { rest, order }
    }

    #[test]
    fn short_and_padded_elements_are_read_in_both_orders() {
        let little = [
            1, 0, 3, 0, b'a', b'b', b'c', 0, 2, 0, 0, 0, 1, 0, 0, 0, 7, 0, 0, 0, 0, 0, 0, 0,
        ];
        let big = [0, 3, 0, 1, b'a', b'b', b'c', 0, 0, 0, 0, 2, 0, 0, 0, 1, 7];
        for (bytes, order) in [(&little[..], Order::Little), (&big[..], Order::Big)] {
            let mut elements = elements(bytes, order);
            let name = elements.expect().unwrap();
            assert_eq!((name.kind, name.bytes), (kind::INT8, &b"abc"[..]));
            let byte = elements.expect().unwrap();
            assert_eq!((byte.kind, byte.bytes), (kind::UINT8, &[7][..]));
            assert_eq!(elements.next(), Ok(None));
        }
    }

    #[test]
    fn lengths_beyond_the_end_are_damage() {
        for bytes in [
            &[1, 0, 9, 0, 0, 0, 0, 0][..],
            &[2, 0, 0, 0, 255, 255, 255, 255],
            &[1, 0, 0],
            &[2, 0, 0, 0, 1, 0, 0, 0],
        ] {
            assert!(elements(bytes, Order::Little).next().is_err(), "{bytes:?}");
        }
    }
}
