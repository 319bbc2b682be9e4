//! Thrift's compact protocol, in which Parquet writes what is beside its values.

use super::damage::damaged;
use crate::flight::Fault;

/// Structs in structs.
const DEEPEST: u32 = 16;

/// Reads what stands there, value by value.
#[derive(Clone)]
pub(super) struct Compact<'a> {
    rest: &'a [u8],
    depth: u32,
}

/// The value of a field.
pub(super) enum Value {
    Boolean(bool),
    /// It follows.
    Other(u8),
}

const BOOLEAN_TRUE: u8 = 1;
const BOOLEAN_FALSE: u8 = 2;
const BYTE: u8 = 3;
const DOUBLE: u8 = 7;
const BINARY: u8 = 8;
const LIST: u8 = 9;
const SET: u8 = 10;
const MAP: u8 = 11;
const STRUCT: u8 = 12;

impl<'a> Compact<'a> {
    pub(super) fn of(bytes: &'a [u8]) -> Self {
        Self {
            rest: bytes,
            depth: 0,
        }
    }

    /// What was not read yet.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// Goes through the fields of a struct; `each` reads the value of a field, or skips it.
    ///
    /// # Errors
    /// Those of `each`; the struct is cut off.
    pub(super) fn fields(
        &mut self,
        mut each: impl FnMut(&mut Self, i16, Value) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(damaged("its header is too deep"));
        }
        let mut id = 0i16;
        loop {
            let head = self.byte()?;
            if head == 0 {
                self.depth -= 1;
                return Ok(());
            }
            id = match head >> 4 {
                0 => self.integer()? as i16,
                delta => id.wrapping_add(i16::from(delta)),
            };
            let value = match head & 15 {
                BOOLEAN_TRUE => Value::Boolean(true),
                BOOLEAN_FALSE => Value::Boolean(false),
                kind => Value::Other(kind),
            };
            each(self, id, value)?;
        }
    }

    pub(super) fn byte(&mut self) -> Result<u8, Fault> {
        let (&first, rest) = self.rest.split_first().ok_or_else(cut_off)?;
        self.rest = rest;
        Ok(first)
    }

    fn varint(&mut self) -> Result<u64, Fault> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Ok(value);
            }
        }
        Err(damaged("a number in its header has no end"))
    }

    pub(super) fn integer(&mut self) -> Result<i64, Fault> {
        let value = self.varint()?;
        Ok((value >> 1) as i64 ^ -((value & 1) as i64))
    }

    /// A number that cannot be less than none.
    pub(super) fn count(&mut self) -> Result<usize, Fault> {
        let count = usize::try_from(self.integer()?);
        count.map_err(|_| damaged("a count in its header is negative"))
    }

    pub(super) fn binary(&mut self) -> Result<&'a [u8], Fault> {
        let length = self.varint()?;
        let length = usize::try_from(length).unwrap_or(usize::MAX);
        let (bytes, rest) = self.rest.split_at_checked(length).ok_or_else(cut_off)?;
        self.rest = rest;
        Ok(bytes)
    }

    pub(super) fn text(&mut self) -> Result<String, Fault> {
        Ok(String::from_utf8_lossy(self.binary()?).into_owned())
    }

    /// Goes through a list.
    ///
    /// # Errors
    /// Those of `each`; the list is cut off.
    pub(super) fn list(
        &mut self,
        mut each: impl FnMut(&mut Self) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let (length, _) = self.list_head()?;
        (0..length).try_for_each(|_| each(self))
    }

    fn list_head(&mut self) -> Result<(u64, u8), Fault> {
        let head = self.byte()?;
        let length = match head >> 4 {
            15 => self.varint()?,
            short => short.into(),
        };
        // every element has a byte
        if length > self.rest.len() as u64 {
            return Err(cut_off());
        }
        Ok((length, head & 15))
    }

    /// Passes over a value.
    pub(super) fn skip(&mut self, value: &Value) -> Result<(), Fault> {
        match *value {
            Value::Boolean(_) => Ok(()),
            Value::Other(kind) => self.skip_kind(kind),
        }
    }

    fn skip_kind(&mut self, kind: u8) -> Result<(), Fault> {
        match kind {
            BOOLEAN_TRUE | BOOLEAN_FALSE | BYTE => self.byte().map(|_| ()),
            4..=6 => self.varint().map(|_| ()),
            DOUBLE => (0..8).try_for_each(|_| self.byte().map(|_| ())),
            BINARY => self.binary().map(|_| ()),
            LIST | SET => {
                let (length, kind) = self.list_head()?;
                self.deeper(|within| (0..length).try_for_each(|_| within.skip_kind(kind)))
            }
            MAP => {
                let length = self.varint()?;
                if length == 0 {
                    return Ok(());
                }
                let kinds = self.byte()?;
                if length > self.rest.len() as u64 {
                    return Err(cut_off());
                }
                self.deeper(|within| {
                    (0..length).try_for_each(|_| {
                        within.skip_kind(kinds >> 4)?;
                        within.skip_kind(kinds & 15)
                    })
                })
            }
            STRUCT => self.fields(|within, _, value| within.skip(&value)),
            _ => Err(damaged("its header has a field of an unknown kind")),
        }
    }

    fn deeper(&mut self, read: impl FnOnce(&mut Self) -> Result<(), Fault>) -> Result<(), Fault> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(damaged("its header is too deep"));
        }
        read(self)?;
        self.depth -= 1;
        Ok(())
    }
}

fn cut_off() -> Fault {
    damaged("its header is cut off")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_read_and_others_passed_over() {
        // 1: 150, 2: true, 4: [1, -1], 5: {1: "ab"}, 6: "cd"
        let bytes = b"\x15\xac\x02\x11\x29\x25\x02\x01\x1c\x18\x02ab\x00\x18\x02cd\x00\xff";
        let mut compact = Compact::of(bytes);
        let (mut one, mut two, mut six) = (0, false, String::new());
        let mut list = Vec::new();
        compact
            .fields(|within, id, value| {
                match (id, value) {
                    (1, _) => one = within.integer()?,
                    (2, Value::Boolean(value)) => two = value,
                    (4, _) => within.list(|within| {
                        list.push(within.integer()?);
                        Ok(())
                    })?,
                    (6, _) => six = within.text()?,
                    (_, value) => within.skip(&value)?,
                }
                Ok(())
            })
            .unwrap();
        assert_eq!((one, two, six.as_str()), (150, true, "cd"));
        assert_eq!(list, [1, -1]);
        assert_eq!(compact.rest(), b"\xff");
        for end in 0..bytes.len() - 1 {
            let all = |within: &mut Compact, _, value| within.skip(&value);
            assert!(Compact::of(&bytes[..end]).fields(all).is_err());
        }
        let deep = [0x1c; 100];
        let all = |within: &mut Compact, _, value| within.skip(&value);
        assert!(Compact::of(&deep).fields(all).is_err());
    }
}
