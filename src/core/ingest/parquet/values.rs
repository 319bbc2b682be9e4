//! Values of a column as they were stored.

use super::super::columns::{NONE, Texts};

/// How a value is stored.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Boolean,
    Integer(usize, fn(&[u8]) -> i64),
    Double(usize, fn(&[u8]) -> f64),
    Text,
}

/// Values as they were stored.
pub(super) enum Values {
    Doubles(Vec<f64>),
    Integers(Vec<i64>),
    Texts(Texts),
}

/// Why values cannot be decoded.
#[derive(Debug, PartialEq)]
pub(super) enum Trouble {
    Damaged,
    /// They are encoded in a way that is not read.
    Encoding,
    /// Texts are longer than there is room.
    TooLong,
}

impl Values {
    pub(super) fn of(kind: Kind) -> Self {
        match kind {
            Kind::Boolean | Kind::Double(..) => Self::Doubles(Vec::new()),
            Kind::Integer(..) => Self::Integers(Vec::new()),
            Kind::Text => Self::Texts(Texts::default()),
        }
    }

    pub(super) fn len(&self) -> usize {
        match self {
            Self::Doubles(values) => values.len(),
            Self::Integers(values) => values.len(),
            Self::Texts(texts) => texts.len(),
        }
    }

    pub(super) fn push_none(&mut self) {
        match self {
            Self::Doubles(values) => values.push(f64::NAN),
            Self::Integers(values) => values.push(NONE),
            Self::Texts(texts) => texts.push(b""),
        }
    }

    pub(super) fn push_of(
        &mut self,
        other: &Self,
        at: usize,
        room: &mut usize,
    ) -> Result<(), Trouble> {
        if at >= other.len() {
            return Err(Trouble::Damaged);
        }
        match (self, other) {
            (Self::Doubles(values), Self::Doubles(others)) => values.push(others[at]),
            (Self::Integers(values), Self::Integers(others)) => values.push(others[at]),
            (Self::Texts(texts), Self::Texts(others)) => {
                let text = others.get(at).as_bytes();
                *room = room.checked_sub(text.len()).ok_or(Trouble::TooLong)?;
                texts.push(text);
            }
            _ => return Err(Trouble::Damaged),
        }
        Ok(())
    }
}
