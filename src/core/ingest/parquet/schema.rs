//! What columns a file has, and how the values of each are stored.

use super::super::columns::{Cells, NONE};
use super::compact::{Compact, Value};
use super::damage::damaged;
use super::values::{Kind, Values};
use crate::flight::Fault;

/// A column that holds values.
pub(super) struct Leaf {
    /// Its name; behind those of the groups that it is in.
    pub(super) title: String,
    /// The level at which a value is there: how many of it and its groups may be missing.
    pub(super) present: u32,
    pub(super) kind: Result<(Kind, Meaning), Why>,
}

/// Why a column is not read.
#[derive(Clone, Debug)]
pub(super) enum Why {
    /// The others are all the same.
    NotRead(String),
    Refused(Fault),
}

impl From<Fault> for Why {
    fn from(fault: Fault) -> Self {
        Self::Refused(fault)
    }
}

/// What a stored value means.
#[derive(Clone, Copy)]
pub(super) enum Meaning {
    Number,
    /// So many times too large.
    Scaled(f64),
    /// So many nanoseconds each, since 1970.
    Instant(i64),
    /// Of such a unit since midnight.
    TimeOfDay(&'static str),
}

impl Meaning {
    /// The cells of a table, and their unit; that of a duration is said elsewhere.
    pub(super) fn cells(
        self,
        values: Values,
        duration: Option<&'static str>,
    ) -> (Cells, &'static str) {
        let known = |value: i64| (value != NONE).then_some(value);
        match (self, values) {
            (Self::Instant(each), Values::Integers(values)) => {
                let in_range = |value| known(value)?.checked_mul(each);
                let instants = values
                    .into_iter()
                    .map(|value| in_range(value).unwrap_or(NONE));
                (Cells::Instants(instants.collect()), "")
            }
            (Self::Scaled(scale), Values::Integers(values)) => {
                let number = |value| known(value).map_or(f64::NAN, |value| value as f64 / scale);
                (Cells::Doubles(values.into_iter().map(number).collect()), "")
            }
            (Self::Scaled(scale), Values::Doubles(mut values)) => {
                values.iter_mut().for_each(|value| *value /= scale);
                (Cells::Doubles(values), "")
            }
            (Self::TimeOfDay(unit), Values::Integers(values)) => (Cells::Integers(values), unit),
            (_, Values::Integers(values)) => {
                (Cells::Integers(values), duration.unwrap_or_default())
            }
            (_, Values::Doubles(values)) => (Cells::Doubles(values), ""),
            (_, Values::Texts(texts)) => (Cells::Texts(texts), ""),
        }
    }
}

/// An element of the schema: a column, or a group of some.
#[derive(Default)]
pub(super) struct Element {
    physical: Option<i64>,
    length: usize,
    repetition: i64,
    name: String,
    pub(super) children: usize,
    converted: Option<i64>,
    scale: i64,
    logical: Option<Logical>,
}

/// What it says of the meaning of its values, by the numbers of the format.
#[derive(Clone, Copy, Default)]
struct Logical {
    id: i16,
    /// Of a time: 1 ms, 2 µs, 3 ns.
    unit: i16,
    is_unsigned: bool,
    scale: i64,
}

/// A name, or the names of groups before one, is kept up to so many characters.
const LONGEST_TITLE: usize = 1000;
const OPTIONAL: i64 = 1;
const REPEATED: i64 = 2;

impl Element {
    pub(super) fn read(compact: &mut Compact) -> Result<Self, Fault> {
        let mut element = Self::default();
        compact.fields(|within, id, value| {
            match id {
                1 => element.physical = Some(within.integer()?),
                2 => element.length = within.count()?,
                3 => element.repetition = within.integer()?,
                4 => element.name = within.text()?,
                5 => element.children = within.count()?,
                6 => element.converted = Some(within.integer()?),
                7 => element.scale = within.integer()?,
                10 => element.logical = Logical::read(within)?,
                _ => within.skip(&value)?,
            }
            Ok(())
        })?;
        Ok(element)
    }

    /// How values are stored, and what they mean.
    fn kind(&self) -> Result<(Kind, Meaning), Why> {
        let logical = self.logical.unwrap_or_default();
        let converted = self.converted.unwrap_or(-1);
        let unsigned = (11..=14).contains(&converted) || logical.is_unsigned;
        let is_decimal = converted == 5 || logical.id == 5;
        let meaning = match (converted, logical.id, logical.unit) {
            _ if is_decimal => {
                let scale = self.scale.max(logical.scale).clamp(0, 300);
                Meaning::Scaled(10f64.powi(scale as i32))
            }
            (6, ..) | (_, 6, _) => Meaning::Instant(86_400_000_000_000),
            (7, ..) | (_, 7, 1) => Meaning::TimeOfDay("ms"),
            (8, ..) | (_, 7, 2) => Meaning::TimeOfDay("us"),
            (_, 7, _) => Meaning::TimeOfDay("ns"),
            (9, ..) | (_, 8, 1) => Meaning::Instant(1_000_000),
            (10, ..) | (_, 8, 2) => Meaning::Instant(1000),
            (_, 8, _) => Meaning::Instant(1),
            _ => Meaning::Number,
        };
        let is_text = matches!(converted, 0 | 4 | 19) || matches!(logical.id, 1 | 4 | 12);
        let not_read = |what: &str| Err(Why::NotRead(what.to_string()));
        let kind = match self.physical {
            Some(0) => Kind::Boolean,
            Some(1) if unsigned => Kind::Integer(4, |bytes| {
                of(bytes).map_or(NONE, |bytes| u32::from_le_bytes(bytes).into())
            }),
            Some(1) => Kind::Integer(4, |bytes| {
                of(bytes).map_or(NONE, |bytes| i32::from_le_bytes(bytes).into())
            }),
            Some(2) if unsigned => Kind::Double(8, |bytes| {
                of(bytes).map_or(f64::NAN, |bytes| u64::from_le_bytes(bytes) as f64)
            }),
            Some(2) => Kind::Integer(8, |bytes| of(bytes).map_or(NONE, i64::from_le_bytes)),
            Some(3) => return Ok((Kind::Integer(12, of_julian_day), Meaning::Instant(1))),
            Some(4) => Kind::Double(4, |bytes| {
                of(bytes).map_or(f64::NAN, |bytes| f32::from_le_bytes(bytes).into())
            }),
            Some(5) => Kind::Double(8, |bytes| of(bytes).map_or(f64::NAN, f64::from_le_bytes)),
            Some(6) if is_text => Kind::Text,
            Some(7) if is_decimal && (1..=16).contains(&self.length) => {
                Kind::Double(self.length, of_decimal)
            }
            Some(7) if logical.id == 15 && self.length == 2 => Kind::Double(2, of_half),
            Some(6) if is_decimal => return not_read("its decimals have no fixed length"),
            Some(6 | 7) => return not_read("it holds bytes, not numbers"),
            _ => return not_read("it is of an unknown kind"),
        };
        Ok((kind, meaning))
    }
}

impl Logical {
    fn read(compact: &mut Compact) -> Result<Option<Self>, Fault> {
        let mut found = None;
        compact.fields(|within, id, value| {
            let mut logical = Self {
                id,
                ..Self::default()
            };
            match id {
                5 => within.fields(|within, id, value| {
                    match id {
                        1 => logical.scale = within.integer()?,
                        _ => within.skip(&value)?,
                    }
                    Ok(())
                })?,
                7 | 8 => within.fields(|within, id, value| match id {
                    2 => within.fields(|within, unit, value| {
                        logical.unit = unit;
                        within.skip(&value)
                    }),
                    _ => within.skip(&value),
                })?,
                10 => within.fields(|within, id, value| match (id, value) {
                    (2, Value::Boolean(is_signed)) => {
                        logical.is_unsigned = !is_signed;
                        Ok(())
                    }
                    (_, value) => within.skip(&value),
                })?,
                _ => within.skip(&value)?,
            }
            found = Some(logical);
            Ok(())
        })?;
        Ok(found)
    }
}

/// The columns of a schema, whose elements stand one behind the other, each group before what is in it.
///
/// # Errors
/// A group has more in it than there is.
pub(super) fn leaves(elements: &[Element]) -> Result<Vec<Leaf>, Fault> {
    let mut leaves = Vec::new();
    // of the groups that are open: what is still to come in each, its title, and its level
    let mut open: Vec<(usize, String, u32, bool)> = Vec::new();
    let (root, elements) = elements
        .split_first()
        .ok_or_else(|| damaged("it has no schema"))?;
    open.push((root.children, String::new(), 0, false));
    for element in elements {
        while open.last().is_some_and(|(left, ..)| *left == 0) {
            open.pop();
        }
        let Some((left, group, level, is_list)) = open.last_mut() else {
            return Err(damaged("its schema has more columns than it says"));
        };
        *left -= 1;
        let title = match group.as_str() {
            "" => element.name.chars().take(LONGEST_TITLE).collect(),
            group => format!("{group}.{}", element.name)
                .chars()
                .take(LONGEST_TITLE)
                .collect(),
        };
        let present = *level + u32::from(element.repetition == OPTIONAL);
        let is_list = *is_list || element.repetition == REPEATED;
        if element.physical.is_none() {
            open.push((element.children, title, present, is_list));
            continue;
        }
        let kind = match is_list {
            true => Err(Why::NotRead("it is a list in each row".to_string())),
            false => element.kind(),
        };
        leaves.push(Leaf {
            title,
            present,
            kind,
        });
    }
    match open.iter().all(|(left, ..)| *left == 0) {
        true => Ok(leaves),
        false => Err(damaged("its schema has fewer columns than it says")),
    }
}

fn of<const N: usize>(bytes: &[u8]) -> Option<[u8; N]> {
    bytes.try_into().ok()
}

/// Nanoseconds of a day, and the day, from noon of 4714 BC.
fn of_julian_day(bytes: &[u8]) -> i64 {
    const DAY_OF_1970: i64 = 2_440_588;
    let instant = || {
        let (time, day) = bytes.split_first_chunk()?;
        let day = i64::from(u32::from_le_bytes(day.try_into().ok()?)) - DAY_OF_1970;
        day.checked_mul(86_400_000_000_000)?
            .checked_add(i64::from_le_bytes(*time))
    };
    instant().unwrap_or(NONE)
}

fn of_decimal(bytes: &[u8]) -> f64 {
    let is_negative = bytes.first().is_some_and(|first| first & 0x80 != 0);
    let start = if is_negative { -1i128 } else { 0 };
    bytes
        .iter()
        .fold(start, |value, &byte| value << 8 | i128::from(byte)) as f64
}

fn of_half(bytes: &[u8]) -> f64 {
    let Some(bits) = of(bytes).map(u16::from_le_bytes) else {
        return f64::NAN;
    };
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f64::from(bits & 1023));
    let size = match exponent {
        0 => fraction * 2f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1024.0 + fraction) * 2f64.powi(exponent - 25),
    };
    if bits >> 15 == 0 { size } else { -size }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_odd_sizes() {
        assert_eq!(of_decimal(&[0xff, 0x38]), -200.0);
        assert_eq!(of_decimal(&[0x01, 0x00, 0x00]), 65_536.0);
        let half = |bits: u16| of_half(&bits.to_le_bytes());
        assert_eq!(
            (half(0x3c00), half(0xc500), half(0x0001)),
            (1.0, -5.0, 2f64.powi(-24))
        );
        assert!(half(0x7e00).is_nan() && half(0x7c00).is_infinite());
        let mut stamp = 3_600_000_000_000i64.to_le_bytes().to_vec();
        stamp.extend(2_440_589u32.to_le_bytes());
        assert_eq!(of_julian_day(&stamp), 90_000_000_000_000);
        assert_eq!(of_julian_day(&stamp[1..]), NONE);
    }
}
