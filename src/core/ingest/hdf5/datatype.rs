//! What the elements of a dataset are.

use super::super::stored::{Order, Stored, stored};
use super::file::Cursor;

#[derive(Clone, Debug)]
pub(super) enum Type {
    Number(Stored),
    /// An integer of eight bytes, the lowest first: a double has not all of its digits.
    Long,
    /// Of so many bytes.
    Text(usize),
    /// Fields by name, and the bytes of all.
    Compound(Vec<Field>, usize),
    /// So many of one kind.
    Array(Box<Type>, usize),
    /// The address of an object, of so many bytes.
    Reference(usize),
    /// What it is, and its bytes.
    Other(&'static str, usize),
}

#[derive(Clone, Debug)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) at: usize,
    pub(super) kind: Type,
}

/// Types in types.
const DEEPEST: u32 = 8;
const MOST_FIELDS: usize = 4096;

impl Type {
    /// Bytes of an element.
    pub(super) fn width(&self) -> usize {
        match self {
            Self::Number(number) => number.width,
            Self::Long => 8,
            Self::Array(of, count) => of.width().saturating_mul(*count),
            Self::Text(width)
            | Self::Compound(_, width)
            | Self::Reference(width)
            | Self::Other(_, width) => *width,
        }
    }

    /// How a number is read, where it is one.
    pub(super) fn number(&self) -> Option<Stored> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Long => Some(stored!(i64, Order::Little)),
            _ => None,
        }
    }

    /// For a message.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Number(_) | Self::Long => "numbers",
            Self::Text(_) => "text",
            Self::Compound(..) => "a table",
            Self::Array(..) => "arrays",
            Self::Reference(_) => "references",
            Self::Other(what, _) => what,
        }
    }

    pub(super) fn read(cursor: &mut Cursor) -> Option<Self> {
        Self::within(cursor, DEEPEST)
    }

    fn within(cursor: &mut Cursor, depth: u32) -> Option<Self> {
        let depth = depth.checked_sub(1)?;
        let head = cursor.u8()?;
        let bits = cursor.uint(3)? as u32;
        let width = cursor.u32()? as usize;
        let version = head >> 4;
        let order = match bits & 1 {
            0 => Order::Little,
            _ => Order::Big,
        };
        let read = match head & 15 {
            0 => {
                let (shift, precision) = (cursor.u16()?, cursor.u16()?);
                let is_whole = shift == 0 && usize::from(precision) == width.checked_mul(8)?;
                if is_whole && width == 8 && bits & 9 == 8 {
                    return Some(Self::Long);
                }
                let number = integer(width, bits & 8 != 0, order).filter(|_| is_whole);
                number.map_or(Self::Other("integers of odd sizes", width), Self::Number)
            }
            1 => {
                cursor.take(12)?;
                let number = float(width, order).filter(|_| bits & 0x40 == 0);
                number.map_or(Self::Other("numbers of odd sizes", width), Self::Number)
            }
            2 => {
                cursor.take(2)?;
                Self::Other("times", width)
            }
            3 => Self::Text(width),
            4 => {
                cursor.take(4)?;
                Self::Other("bits", width)
            }
            5 => {
                cursor.take((bits & 0xff) as usize)?;
                Self::Other("bytes", width)
            }
            6 => compound(cursor, version, (bits & 0xffff) as usize, width, depth)?,
            7 if bits & 15 == 0 && width <= 8 => Self::Reference(width),
            7 => Self::Other("references to parts", width),
            8 => enumeration(cursor, version, (bits & 0xffff) as usize, depth)?,
            9 => {
                Self::within(cursor, depth)?;
                Self::Other("texts or lists of any length", width)
            }
            10 => array(cursor, version, depth)?,
            _ => return None,
        };
        (width > 0 && read.width() == width).then_some(read)
    }
}

fn compound(
    cursor: &mut Cursor,
    version: u8,
    count: usize,
    width: usize,
    depth: u32,
) -> Option<Type> {
    if count > MOST_FIELDS {
        return None;
    }
    let mut fields = Vec::new();
    for _ in 0..count {
        let name = padded(cursor, version)?;
        let at = match version {
            3.. => cursor.uint(bytes_for(width))?,
            _ => cursor.u32()?.into(),
        };
        let mut elements = 1usize;
        if version == 1 {
            let rank = usize::from(cursor.u8()?);
            cursor.take(11)?;
            for place in 0..4 {
                let size = cursor.u32()? as usize;
                elements = if place < rank {
                    elements.checked_mul(size)?
                } else {
                    elements
                };
            }
        }
        let mut kind = Type::within(cursor, depth)?;
        if elements != 1 {
            kind = Type::Array(Box::new(kind), elements);
        }
        let at = usize::try_from(at).ok()?;
        if at.checked_add(kind.width())? > width {
            return None;
        }
        fields.push(Field { name, at, kind });
    }
    Some(Type::Compound(fields, width))
}

/// A name, which in older versions ends at a multiple of eight bytes.
fn padded(cursor: &mut Cursor, version: u8) -> Option<String> {
    let before = cursor.rest().len();
    let name = cursor.text()?;
    if version < 3 {
        // the bytes of the file: a letter in Latin-1 becomes a longer one
        let used = before - cursor.rest().len();
        cursor.take(used.next_multiple_of(8) - used)?;
    }
    Some(name)
}

fn enumeration(cursor: &mut Cursor, version: u8, count: usize, depth: u32) -> Option<Type> {
    let of = Type::within(cursor, depth)?;
    for _ in 0..count {
        padded(cursor, version)?;
    }
    cursor.take(count.checked_mul(of.width())?)?;
    Some(of)
}

fn array(cursor: &mut Cursor, version: u8, depth: u32) -> Option<Type> {
    let rank = usize::from(cursor.u8()?);
    cursor.take(if version < 3 { 3 } else { 0 })?;
    let mut count = 1usize;
    for _ in 0..rank {
        count = count.checked_mul(cursor.u32()? as usize)?;
    }
    cursor.take(if version < 3 { rank * 4 } else { 0 })?;
    let of = Type::within(cursor, depth)?;
    Some(Type::Array(Box::new(of), count))
}

/// Bytes that hold numbers up to `most`.
fn bytes_for(most: usize) -> usize {
    match most {
        0..=0xff => 1,
        0x100..=0xffff => 2,
        0x1_0000..=0xff_ffff => 3,
        _ => 4,
    }
}

fn integer(width: usize, is_signed: bool, order: Order) -> Option<Stored> {
    Some(match (width, is_signed) {
        (1, true) => stored!(i8, order),
        (1, false) => stored!(u8, order),
        (2, true) => stored!(i16, order),
        (2, false) => stored!(u16, order),
        (4, true) => stored!(i32, order),
        (4, false) => stored!(u32, order),
        (8, true) => stored!(i64, order),
        (8, false) => stored!(u64, order),
        _ => return None,
    })
}

fn float(width: usize, order: Order) -> Option<Stored> {
    Some(match width {
        4 => stored!(f32, order),
        8 => stored!(f64, order),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::super::file::{File, SIGNATURE};
    use super::*;

    #[test]
    fn names_may_be_in_latin_1() {
        let bytes = [SIGNATURE, &[2, 8, 8, 0], &[0; 36]].concat();
        let file = File::of(&bytes).unwrap();
        // of version 1: names end at a multiple of eight bytes
        let mut kind = vec![0x16, 2, 0, 0, 2, 0, 0, 0];
        for (at, name) in [&b"[deg]\0\0\0"[..], b"alpha [\xb0]\0\0\0\0\0\0\0"]
            .into_iter()
            .enumerate()
        {
            kind.extend(name);
            kind.extend([at as u8, 0, 0, 0]);
            kind.extend([0; 28]);
            kind.extend([0x10, 0, 0, 0, 1, 0, 0, 0, 0, 0, 8, 0]);
        }
        let Some(Type::Compound(fields, 2)) = Type::read(&mut file.within(&kind)) else {
            panic!("a type with fields");
        };
        let names: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
        assert_eq!(names, ["[deg]", "alpha [°]"]);
    }
}
