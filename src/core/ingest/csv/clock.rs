//! The time of a row, from its cells.

use super::super::{
    Origin,
    cell::{Decimal, Marks, is_missing, number, unquote},
    stamp::{ClockKind, Stamp, Stopwatch},
    text::quoted,
};
use super::{
    parts::{InParts, Parts},
    time::Time,
};
use crate::flight::Unit;

/// Reads the times of rows, one behind the other.
pub(super) struct Clock {
    time: Time,
    marks: Marks,
    watch: Stopwatch,
    /// The first number of an epoch or of a week, in 1e-9 of its unit.
    first: Option<i128>,
}

const WEEK: f64 = 7.0 * 86_400.0;

pub(super) const NOT_A_NUMBER: &str =
    "is not a number; write it like -1.5e-3, or leave the cell empty where there is no value";

/// A time of day without signs between its parts; zeros before it may be left out.
fn unpacked(cell: &str) -> Option<Stamp> {
    let cell = unquote(cell).replace(',', ".");
    let (whole, fraction) = cell.split_once('.').unwrap_or((&cell, ""));
    if whole.is_empty() || whole.len() > 6 || !whole.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let whole = format!("{whole:0>6}");
    let (hours, rest) = whole.split_at(2);
    let (minutes, seconds) = rest.split_at(2);
    let behind = if fraction.is_empty() { "" } else { "." };
    Stamp::parse(&format!("{hours}:{minutes}:{seconds}{behind}{fraction}"))
}

impl Clock {
    pub(super) fn new(time: Time, marks: Marks) -> Self {
        Self {
            time,
            marks,
            watch: Stopwatch::default(),
            first: None,
        }
    }

    /// Whether its cells are plain numbers.
    pub(super) fn takes_numbers(&self) -> bool {
        matches!(self.time, Time::Numbers { .. })
    }

    pub(super) fn of_number(&self, value: f64) -> f64 {
        match self.time {
            Time::Numbers { unit, .. } => unit.to_si(value),
            _ => value,
        }
    }

    /// The seconds of a row; `beside` are the cells of the columns of [`Time::beside`].
    ///
    /// # Errors
    /// Why its time cannot be read; nothing where there is none.
    pub(super) fn read(&mut self, cell: &str, beside: &[&str]) -> Result<f64, Option<String>> {
        if let Time::Even { .. } = self.time {
            // told when all rows are known
            return Ok(0.0);
        }
        if is_missing(unquote(cell)) {
            return Err(None);
        }
        let day = beside.first().copied().unwrap_or_default();
        match self.time {
            Time::Even { .. } => Ok(0.0),
            Time::Numbers { unit, .. } => self.number(cell).map(|value| unit.to_si(value)),
            Time::Epoch { unit, .. } => self.since_first(cell, unit),
            Time::Week { unit, .. } => {
                let week = self.number(day)?;
                let first = *self.first.get_or_insert(week as i128);
                Ok((week - first as f64) * WEEK + unit.to_si(self.number(cell)?))
            }
            Time::Parts(InParts { parts, unit, .. }) => {
                let parts = self.parts(parts, beside)?;
                let finest = (unit.to_si(self.number(cell)?) * 1e9).round();
                let stamp = Stamp::of_parts(parts, finest as i64);
                self.seconds(Some(stamp.map_err(Some)?))
            }
            Time::Stamps { .. } => self.seconds(Stamp::parse(cell)),
            Time::Packed { .. } => self.seconds(unpacked(cell)),
            Time::Dated { .. } => self.seconds(Stamp::parse_with_date(day, cell)),
        }
    }

    /// The whole numbers of the parts that there are.
    fn parts(&self, parts: Parts, beside: &[&str]) -> Result<[Option<i64>; 6], Option<String>> {
        let mut cells = beside.iter();
        let mut numbers = [None; 6];
        let there = numbers.iter_mut().zip(parts.columns);
        for (number, _) in there.filter(|(_, column)| column.is_some()) {
            let cell = cells.next().copied().unwrap_or_default();
            let value = self.number(cell)?;
            if value.fract() != 0.0 {
                let cell = quoted(cell.trim());
                return Err(Some(format!(
                    "does not fit: {cell} beside it is not whole; only the finest part of a time may have a fraction"
                )));
            }
            *number = Some(value as i64);
        }
        Ok(numbers)
    }

    /// What the zero of the times is that were read.
    pub(super) fn origin(&self) -> Option<Origin> {
        match self.time {
            Time::Even { .. } | Time::Numbers { .. } => Some(Origin::OWN),
            Time::Epoch { unit, .. } => {
                // a second has many of its units, or it has many seconds
                let (many, of_many) = ((1.0 / unit.scale).round(), unit.scale.round());
                let first = match unit.scale < 1.0 {
                    true => self.first? / many as i128,
                    false => self.first?.checked_mul(of_many as i128)?,
                };
                Some(Origin::at(ClockKind::Utc, first))
            }
            Time::Week { .. } => {
                let week = self.first?;
                Some(Origin::at(
                    ClockKind::Gps,
                    week * WEEK as i128 * 1_000_000_000,
                ))
            }
            Time::Stamps { .. } | Time::Packed { .. } | Time::Dated { .. } | Time::Parts(_) => {
                Origin::of_stamp(self.watch.first()?)
            }
        }
    }

    fn number(&self, cell: &str) -> Result<f64, Option<String>> {
        match number(cell, self.marks) {
            Some(value) if value.is_nan() => Err(None),
            Some(value) => Ok(value),
            None => Err(Some(NOT_A_NUMBER.to_string())),
        }
    }

    fn since_first(&mut self, cell: &str, unit: Unit) -> Result<f64, Option<String>> {
        let now = match billionths(unquote(cell), self.marks.decimal) {
            Some(exact) => exact,
            None => (self.number(cell)? * 1e9) as i128,
        };
        let first = *self.first.get_or_insert(now);
        Ok(unit.to_si(now.saturating_sub(first) as f64 / 1e9))
    }

    /// Seconds since the first time stamp.
    fn seconds(&mut self, stamp: Option<Stamp>) -> Result<f64, Option<String>> {
        let stamp = stamp.ok_or_else(|| Some("is not a time stamp like that of the first row; write all alike, as in 2026-11-21T12:00:00.123Z or 12:00:00.123".to_string()))?;
        self.watch
            .seconds(stamp)
            .map_err(|why| Some(format!("does not fit: {why}")))
    }
}

/// A number without an exponent in billionths, to the last digit.
fn billionths(text: &str, decimal: Decimal) -> Option<i128> {
    let point = if decimal == Decimal::Comma { ',' } else { '.' };
    let (whole, fraction) = text.split_once(point).unwrap_or((text, ""));
    let is_digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    if whole.is_empty() || whole.len() > 24 || !is_digits(whole) || !is_digits(fraction) {
        return None;
    }
    let digits = fraction.bytes().chain(std::iter::repeat(b'0')).take(9);
    let digits = whole.bytes().chain(digits);
    Some(digits.fold(0, |sum, digit| sum * 10 + i128::from(digit - b'0')))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_epoch_keeps_its_last_digits() {
        let unit = |text| Unit::parse(text).unwrap();
        let mut clock = Clock::new(
            Time::Epoch {
                at: 0,
                unit: unit("ns"),
            },
            Marks::POINT,
        );
        assert_eq!(clock.read("1795255200123456789", &[]), Ok(0.0));
        assert_eq!(clock.read("1795255200123456796", &[]), Ok(7.0 * 1e-9));
        let mut clock = Clock::new(
            Time::Epoch {
                at: 0,
                unit: unit("s"),
            },
            Marks::POINT,
        );
        assert_eq!(clock.read("1795255200.123456789", &[]), Ok(0.0));
        assert_eq!(
            clock.read("\"1795255201.123456799\"", &[]),
            Ok(1.000_000_01)
        );
        assert_eq!(clock.read("", &[]), Err(None));
    }

    #[test]
    fn an_epoch_has_no_end() {
        let unit = Unit::parse("s").unwrap();
        let mut clock = Clock::new(Time::Epoch { at: 0, unit }, Marks::POINT);
        assert_eq!(clock.read("-1e300", &[]), Ok(0.0));
        assert!(clock.read("1e300", &[]).is_ok_and(f64::is_finite));
    }

    #[test]
    fn a_week_is_counted_on() {
        let unit = Unit::parse("s").unwrap();
        let mut clock = Clock::new(
            Time::Week {
                week: 0,
                at: 1,
                unit,
            },
            Marks::POINT,
        );
        assert_eq!(clock.read("604799.5", &["2300"]), Ok(604_799.5));
        assert_eq!(clock.read("0.5", &["2301"]), Ok(604_800.5));
    }
}
