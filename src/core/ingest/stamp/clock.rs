//! Times of day and lengths of time: `10:15:00.123`, `10:15:00 PM`, `47:00.1`, `0.02 sec`.

use crate::flight::{Dimension, Unit};

use super::date::number;

pub(super) const SECOND: i64 = 1_000_000_000;
pub(super) const MINUTE: i64 = 60 * SECOND;
pub(in super::super) const HOUR: i64 = 60 * MINUTE;
pub(in super::super) const DAY: i64 = 24 * HOUR;

/// Nanoseconds since midnight of `hh:mm:ss`, `hh:mm:ss.fff`, `hh:mm:ss:fff`, each perhaps with AM or PM.
pub(super) fn time_of_day(text: &str) -> Option<i64> {
    let (text, half) = half_of_day(text);
    let (hours, rest) = text.split_once(':')?;
    let (minutes, seconds) = rest.split_once(':')?;
    if !(1..=2).contains(&hours.len()) || minutes.len() != 2 {
        return None;
    }
    let hours = number(hours)?;
    let hours = match half {
        None => hours,
        Some(_) if !(1..=12).contains(&hours) => return None,
        Some(half) => hours % 12 + half,
    };
    let minutes = number(minutes).filter(|&minutes| minutes < 60)?;
    let time = hours * HOUR + minutes * MINUTE + seconds_of(seconds)?;
    (hours < 24).then_some(time)
}

/// Whether it is before noon (0) or behind it (12), if a text says so.
fn half_of_day(text: &str) -> (&str, Option<i64>) {
    for (word, half) in [("am", 0), ("pm", 12), ("a.m.", 0), ("p.m.", 12)] {
        let Some(at) = text.len().checked_sub(word.len()) else {
            continue;
        };
        if text.is_char_boundary(at) && text[at..].eq_ignore_ascii_case(word) {
            return (text[..at].trim_end(), Some(half));
        }
    }
    (text, None)
}

/// Nanoseconds of `mm:ss.f`. Without a fraction it may be hours and minutes.
pub(super) fn minutes(text: &str) -> Option<i64> {
    let (minutes, seconds) = text.split_once(':')?;
    let is_minutes = (1..=2).contains(&minutes.len()) && seconds.contains(['.', ',']);
    let minutes = number(minutes).filter(|&minutes| is_minutes && minutes < 60)?;
    Some(minutes * MINUTE + seconds_of(seconds)?)
}

/// Nanoseconds of `ss`, `ss.fff`, `ss,fff` or `ss:fff`, at most the ninth digit of the fraction.
fn seconds_of(text: &str) -> Option<i64> {
    let (whole, fraction) = match text.split_once(['.', ',', ':']) {
        Some((_, "")) => return None,
        Some((whole, fraction)) => (whole, fraction),
        None => (text, ""),
    };
    if whole.len() != 2 || !fraction.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    // 60 is a leap second
    let seconds = number(whole).filter(|&seconds| seconds <= 60)?;
    let digits = fraction.bytes().chain(std::iter::repeat(b'0')).take(9);
    let nanoseconds = digits.fold(0, |sum, digit| sum * 10 + i64::from(digit - b'0'));
    Some(seconds * SECOND + nanoseconds)
}

/// Nanoseconds of a number with a unit of time behind a blank: `0.02 sec`, `20 ms`.
pub(super) fn elapsed(text: &str) -> Option<i64> {
    let (value, unit) = text.split_once(' ')?;
    let value: f64 = value.parse().ok()?;
    let unit = Unit::parse(unit.trim()).ok()?;
    if unit.dimension != Dimension::SECOND || unit == Unit::NONE {
        return None;
    }
    let nanoseconds = (unit.to_si(value) * 1e9).round();
    (nanoseconds.abs() < 9e18).then_some(nanoseconds as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_day() {
        let expected = Some(22 * HOUR + 15 * MINUTE + SECOND / 2);
        for text in [
            "22:15:00.5",
            "22:15:00,500",
            "22:15:00:500",
            "10:15:00.5 PM",
            "10:15:00.5pm",
        ] {
            assert_eq!(time_of_day(text), expected, "{text}");
        }
        assert_eq!(time_of_day("12:00:00 AM"), Some(0));
        assert_eq!(time_of_day("12:00:00 PM"), Some(12 * HOUR));
        for text in [
            "25:00:00",
            "12:60:00",
            "12:00:61",
            "13:00:00 PM",
            "12:00",
            "1:2:3",
            "12:00:00.",
        ] {
            assert_eq!(time_of_day(text), None, "{text}");
        }
        assert_eq!(
            minutes("47:47.5"),
            Some(47 * MINUTE + 47 * SECOND + SECOND / 2)
        );
        assert_eq!(minutes("12:30"), None);
        assert_eq!(elapsed("0.02 sec"), Some(20_000_000));
        assert_eq!(elapsed("0.02 deg"), None);
    }
}
