//! Pages: the parts in which the values of a column stand.

use super::compact::{Compact, Value};
use super::damage::damaged;
use crate::flight::Fault;

/// What stands before a page.
#[derive(Default)]
pub(super) struct Head {
    kind: i64,
    /// Bytes once it is unpacked, and as it is.
    pub(super) length: usize,
    pub(super) packed: usize,
    /// Missing values included.
    pub(super) count: usize,
    pub(super) encoding: i64,
    /// Bytes of levels that stand before the values and are not packed.
    pub(super) levels: usize,
    is_plain: bool,
}

impl Head {
    pub(super) fn read(compact: &mut Compact) -> Result<Self, Fault> {
        let mut head = Self::default();
        compact.fields(|within, id, value| match id {
            1 => {
                head.kind = within.integer()?;
                Ok(())
            }
            2 => {
                head.length = within.count()?;
                Ok(())
            }
            3 => {
                head.packed = within.count()?;
                Ok(())
            }
            5 | 7 => within.fields(|within, id, value| {
                match id {
                    1 => head.count = within.count()?,
                    2 => head.encoding = within.integer()?,
                    _ => within.skip(&value)?,
                }
                Ok(())
            }),
            8 => head.read_second(within),
            _ => within.skip(&value),
        })?;
        match head.levels > head.length.min(head.packed) {
            true => Err(damaged("a page is shorter than its levels")),
            false => Ok(head),
        }
    }

    /// That of a page of the second version.
    fn read_second(&mut self, compact: &mut Compact) -> Result<(), Fault> {
        compact.fields(|within, id, value| {
            match (id, value) {
                (1, _) => self.count = within.count()?,
                (4, _) => self.encoding = within.integer()?,
                (5 | 6, _) => self.levels = self.levels.saturating_add(within.count()?),
                (7, Value::Boolean(is_packed)) => self.is_plain = !is_packed,
                (_, value) => within.skip(&value)?,
            }
            Ok(())
        })
    }

    pub(super) fn is_dictionary(&self) -> bool {
        self.kind == 2
    }

    pub(super) fn is_data(&self) -> bool {
        self.kind == 0 || self.is_second()
    }

    pub(super) fn is_second(&self) -> bool {
        self.kind == 3
    }

    /// How its values are packed, by the codec of the column.
    pub(super) fn codec(&self, of_column: i64) -> i64 {
        if self.is_plain { 0 } else { of_column }
    }
}
