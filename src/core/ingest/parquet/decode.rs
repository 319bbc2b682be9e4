//! Values of a column, out of the ways in which they are encoded.

use super::hybrid::{self, Bits, varint};
use super::values::{Kind, Trouble, Values};

/// The ways of encoding by their numbers in the format.
pub(super) mod encoding {
    pub(in super::super) const PLAIN: i64 = 0;
    pub(in super::super) const PLAIN_DICTIONARY: i64 = 2;
    pub(in super::super) const RLE: i64 = 3;
    pub(in super::super) const DELTA: i64 = 5;
    pub(in super::super) const DICTIONARY: i64 = 8;
    pub(in super::super) const SPLIT: i64 = 9;
}

impl Values {
    /// Adds the values of a page, of which some may be missing.
    pub(super) fn push_page(
        &mut self,
        page: &Encoded,
        is_present: &[bool],
        room: &mut usize,
    ) -> Result<(), Trouble> {
        let count = is_present.iter().filter(|present| **present).count();
        if count == is_present.len() {
            return page.decode_into(self, count, room);
        }
        let mut dense = Self::of(page.kind);
        page.decode_into(&mut dense, count, room)?;
        let mut next = 0;
        for &present in is_present {
            if present {
                self.push_of(&dense, next, room)?;
                next += 1;
            } else {
                self.push_none();
            }
        }
        Ok(())
    }
}

/// Values as they stand in a page.
pub(super) struct Encoded<'a> {
    pub(super) kind: Kind,
    pub(super) encoding: i64,
    pub(super) bytes: &'a [u8],
    pub(super) dictionary: Option<&'a Values>,
}

impl Encoded<'_> {
    /// Adds `count` values.
    pub(super) fn decode_into(
        &self,
        values: &mut Values,
        count: usize,
        room: &mut usize,
    ) -> Result<(), Trouble> {
        match self.encoding {
            encoding::PLAIN => self.plain(values, count),
            encoding::PLAIN_DICTIONARY | encoding::DICTIONARY => {
                let dictionary = self.dictionary.ok_or(Trouble::Damaged)?;
                let (&width, bytes) = match self.bytes.split_first() {
                    Some(split) => split,
                    None if count == 0 => return Ok(()),
                    None => return Err(Trouble::Damaged),
                };
                let places = hybrid::numbers(bytes, width.into(), count);
                for at in places.ok_or(Trouble::Damaged)? {
                    values.push_of(dictionary, at as usize, room)?;
                }
                Ok(())
            }
            encoding::RLE => match (self.kind, values) {
                (Kind::Boolean, Values::Doubles(values)) => {
                    let bytes = self.bytes.get(4..).unwrap_or_default();
                    let bits = hybrid::numbers(bytes, 1, count).ok_or(Trouble::Damaged)?;
                    values.extend(bits.into_iter().map(f64::from));
                    Ok(())
                }
                _ => Err(Trouble::Encoding),
            },
            encoding::DELTA => {
                let (kind, values) = (self.kind, values);
                let each = |value: i64| push_integer(kind, values, value);
                deltas(self.bytes, count, each).ok_or(Trouble::Damaged)?
            }
            encoding::SPLIT => self.split(values, count),
            _ => Err(Trouble::Encoding),
        }
    }

    fn plain(&self, values: &mut Values, count: usize) -> Result<(), Trouble> {
        match (self.kind, values) {
            (Kind::Boolean, Values::Doubles(values)) => {
                let mut bits = Bits::of(self.bytes);
                for _ in 0..count {
                    values.push(bits.next(1).ok_or(Trouble::Damaged)? as f64);
                }
            }
            (Kind::Double(width, read), Values::Doubles(values)) => {
                values.extend(self.fixed(width, count)?.map(read));
            }
            (Kind::Integer(width, read), Values::Integers(values)) => {
                values.extend(self.fixed(width, count)?.map(read));
            }
            (Kind::Text, Values::Texts(texts)) => {
                let mut rest = self.bytes;
                for _ in 0..count {
                    let (length, behind) = rest.split_first_chunk().ok_or(Trouble::Damaged)?;
                    let length = u32::from_le_bytes(*length) as usize;
                    let (text, behind) = behind.split_at_checked(length).ok_or(Trouble::Damaged)?;
                    texts.push(text);
                    rest = behind;
                }
            }
            _ => return Err(Trouble::Damaged),
        }
        Ok(())
    }

    /// The bytes of each of `count` values.
    fn fixed(&self, width: usize, count: usize) -> Result<impl Iterator<Item = &[u8]>, Trouble> {
        let length = count.checked_mul(width).ok_or(Trouble::Damaged)?;
        let bytes = self.bytes.get(..length).ok_or(Trouble::Damaged)?;
        Ok(bytes.chunks_exact(width))
    }

    /// The first bytes of all values, then the second ones, and so on.
    fn split(&self, values: &mut Values, count: usize) -> Result<(), Trouble> {
        let width = match self.kind {
            Kind::Double(width, _) | Kind::Integer(width, _) => width,
            Kind::Boolean | Kind::Text => return Err(Trouble::Encoding),
        };
        let stride = self.bytes.len() / width;
        if stride < count {
            return Err(Trouble::Damaged);
        }
        let mut value = [0; 16];
        let value = value.get_mut(..width).ok_or(Trouble::Encoding)?;
        for at in 0..count {
            for (place, byte) in value.iter_mut().enumerate() {
                *byte = self.bytes[place * stride + at];
            }
            match (self.kind, &mut *values) {
                (Kind::Double(_, read), Values::Doubles(values)) => values.push(read(value)),
                (Kind::Integer(_, read), Values::Integers(values)) => values.push(read(value)),
                _ => return Err(Trouble::Damaged),
            }
        }
        Ok(())
    }
}

/// Adds a value of the bits of an integer; that of four bytes has only the lower ones.
fn push_integer(kind: Kind, values: &mut Values, value: i64) -> Result<(), Trouble> {
    let bytes = value.to_le_bytes();
    match (kind, values) {
        (Kind::Integer(width @ (4 | 8), read), Values::Integers(values)) => {
            values.push(read(&bytes[..width]));
        }
        (Kind::Double(8, read), Values::Doubles(values)) => values.push(read(&bytes)),
        _ => return Err(Trouble::Encoding),
    }
    Ok(())
}

/// Goes through values that are written as the differences between them, in blocks of parts of which each has a width of its
/// own. `None` where there are not `count` of them.
fn deltas(
    mut bytes: &[u8],
    count: usize,
    mut each: impl FnMut(i64) -> Result<(), Trouble>,
) -> Option<Result<(), Trouble>> {
    let rest = &mut bytes;
    let block = usize::try_from(varint(rest)?).ok()?;
    let parts = usize::try_from(varint(rest)?).ok()?;
    let _total = varint(rest)?;
    let mut value = zigzag(varint(rest)?);
    let of_part = block.checked_div(parts)?;
    let is_sound = of_part > 0 && of_part.is_multiple_of(8);
    let Some(mut left) = count.checked_sub(1) else {
        return Some(Ok(()));
    };
    if let Err(trouble) = each(value) {
        return Some(Err(trouble));
    }
    while left > 0 {
        let least = zigzag(varint(rest)?);
        let (widths, behind) = rest.split_at_checked(parts).filter(|_| is_sound)?;
        *rest = behind;
        for &width in widths {
            if left == 0 {
                break;
            }
            if width > 64 {
                return None;
            }
            let length = (of_part / 8).checked_mul(width.into())?.min(rest.len());
            let mut bits = Bits::of(&rest[..length]);
            for _ in 0..of_part.min(left) {
                let delta = bits.next(width.into())? as i64;
                value = value.wrapping_add(least).wrapping_add(delta);
                if let Err(trouble) = each(value) {
                    return Some(Err(trouble));
                }
            }
            left -= of_part.min(left);
            *rest = &rest[length..];
        }
    }
    Some(Ok(()))
}

fn zigzag(value: u64) -> i64 {
    (value >> 1) as i64 ^ -((value & 1) as i64)
}
