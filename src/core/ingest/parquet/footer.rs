//! What stands at the end of a file: its schema, where its columns are, and what pandas says of them.

use super::super::{Limits, code, fault::of_file};
use super::compact::{Compact, Value};
use super::damage::damaged;
use super::pandas::Pandas;
use super::schema::{self, Element, Leaf};
use crate::flight::Fault;

pub(super) struct Footer {
    pub(super) leaves: Vec<Leaf>,
    pub(super) groups: Vec<Group>,
    pub(super) rows: usize,
    pub(super) pandas: Pandas,
}

/// Some of the rows.
#[derive(Default)]
pub(super) struct Group {
    /// By column.
    pub(super) chunks: Vec<Place>,
    pub(super) rows: usize,
}

/// Where the values of a column are.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Place {
    pub(super) codec: i64,
    pub(super) start: usize,
    pub(super) length: usize,
}

const MARK: &[u8] = b"PAR1";
const ENCRYPTED: &[u8] = b"PARE";
/// Columns in all groups of rows.
const MOST_CHUNKS: usize = 1_000_000;

impl Footer {
    /// # Errors
    /// The file is cut off or encrypted, or has more in it than the limits allow.
    pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Self, Fault> {
        let mut reading = Reading::default();
        let mut compact = Compact::of(footer(bytes)?);
        // groups, lists and maps have elements beside their columns
        let most_elements = limits.max_columns.saturating_mul(4).saturating_add(1);
        compact.fields(|within, id, value| {
            match id {
                2 => within.list(|within| {
                    reading.elements.push(Element::read(within)?);
                    match reading.elements.len() > most_elements {
                        true => Err(damaged("its schema has no end")),
                        false => Ok(()),
                    }
                })?,
                4 => within.list(|within| reading.group(within))?,
                5 => within.list(|within| reading.note(within))?,
                8 => return Err(encrypted()),
                _ => within.skip(&value)?,
            }
            Ok(())
        })?;
        reading.footer(bytes.len(), limits)
    }
}

/// What was read so far.
#[derive(Default)]
struct Reading {
    elements: Vec<Element>,
    groups: Vec<Group>,
    chunks: usize,
    pandas: Pandas,
}

impl Reading {
    fn group(&mut self, compact: &mut Compact) -> Result<(), Fault> {
        let mut group = Group::default();
        compact.fields(|within, id, value| {
            match id {
                1 => within.list(|within| {
                    self.chunks += 1;
                    if self.chunks > MOST_CHUNKS {
                        return Err(too_many_groups());
                    }
                    group.chunks.push(Place::of_chunk(within)?);
                    Ok(())
                })?,
                3 => group.rows = within.count()?,
                _ => within.skip(&value)?,
            }
            Ok(())
        })?;
        // one without rows has nothing to be read
        if group.rows > 0 {
            self.groups.push(group);
        }
        Ok(())
    }

    fn note(&mut self, compact: &mut Compact) -> Result<(), Fault> {
        let (mut key, mut text): (&[u8], &[u8]) = (b"", b"");
        compact.fields(|within, id, value| {
            match id {
                1 => key = within.binary()?,
                2 => text = within.binary()?,
                _ => within.skip(&value)?,
            }
            Ok(())
        })?;
        if key == b"pandas" {
            self.pandas = Pandas::read(text);
        }
        Ok(())
    }

    fn footer(self, file: usize, limits: &Limits) -> Result<Footer, Fault> {
        let chunks = self.groups.iter().flat_map(|group| &group.chunks);
        let lengths = chunks.map(|place| place.length);
        if lengths.fold(0, usize::saturating_add) > file {
            return Err(damaged("its columns are longer than the file"));
        }
        let leaves = schema::leaves(&self.elements)?;
        let rows = self.groups.iter().map(|group| group.rows);
        let rows = rows.fold(0, usize::saturating_add);
        let values = rows.saturating_mul(leaves.len());
        let too_much = [
            limits.columns(leaves.len()),
            limits.samples(rows),
            limits.values(values),
        ];
        match too_much.into_iter().flatten().next() {
            Some(fault) => Err(fault),
            None => Ok(Footer {
                leaves,
                groups: self.groups,
                rows,
                pandas: self.pandas,
            }),
        }
    }
}

impl Place {
    fn of_chunk(compact: &mut Compact) -> Result<Self, Fault> {
        let mut place = Self::default();
        compact.fields(|within, id, value| {
            match id {
                3 => place = Self::read(within)?,
                8 | 9 => return Err(encrypted()),
                _ => within.skip(&value)?,
            }
            Ok(())
        })?;
        Ok(place)
    }

    fn read(compact: &mut Compact) -> Result<Self, Fault> {
        let mut place = Self::default();
        let (mut data, mut dictionary) = (0, 0);
        compact.fields(|within, id, value| {
            match (id, value) {
                (4, Value::Other(_)) => place.codec = within.integer()?,
                (7, Value::Other(_)) => place.length = within.count()?,
                (9, Value::Other(_)) => data = within.count()?,
                (11, Value::Other(_)) => dictionary = within.count()?,
                (_, value) => within.skip(&value)?,
            }
            Ok(())
        })?;
        place.start = match dictionary {
            0 => data,
            dictionary => dictionary.min(data),
        };
        Ok(place)
    }
}

/// The footer: before its length and the mark at the end.
fn footer(bytes: &[u8]) -> Result<&[u8], Fault> {
    let cut_off = || damaged("it is cut off at its end");
    let (rest, mark) = bytes.split_last_chunk::<4>().ok_or_else(cut_off)?;
    if mark == ENCRYPTED {
        return Err(encrypted());
    }
    if mark != MARK {
        return Err(cut_off());
    }
    let (rest, length) = rest.split_last_chunk().ok_or_else(cut_off)?;
    let length = u32::from_le_bytes(*length) as usize;
    let start = rest.len().checked_sub(length).ok_or_else(cut_off)?;
    Ok(&rest[start..])
}

fn encrypted() -> Fault {
    let message = "the Parquet file is encrypted, which is not read; write it without encryption, in Python with pyarrow.parquet.write_table(table, 'file.parquet')";
    of_file(code::FORMAT_NOT_READ, message)
}

fn too_many_groups() -> Fault {
    let message = format!(
        "the groups of rows have more than {MOST_CHUNKS} columns in all; write the file with larger groups, as row_group_size=100000"
    );
    of_file(code::TOO_MANY_COLUMNS, message)
}
