//! A time that stands in several numbers: from the year down to the second.

use super::calendar::{day, nth_day};
use super::clock::{DAY, HOUR, MINUTE, SECOND};
use super::value::{Kind, Stamp};

/// What a time is put together from, the largest first.
pub(in super::super) const PARTS: [&str; 6] = ["year", "month", "day", "hour", "minute", "second"];

/// Years of two digits are of this century up to here, as they are in dates.
const LAST_OF_CENTURY: i64 = 69;

impl Stamp {
    /// The parts of [`PARTS`] that there are, and nanoseconds besides. A day without a month is that of the year.
    ///
    /// # Errors
    /// Which part is none.
    pub(in super::super) fn of_parts(
        parts: [Option<i64>; 6],
        nanoseconds: i64,
    ) -> Result<Self, String> {
        let [year, month, of_month, hour, minute, second] = parts;
        // 60 is a leap second; seconds alone count from any day
        let most_seconds = if minute.is_some() { 60 } else { i64::MAX };
        for (what, part, range) in [
            ("hour", hour, 0..=24),
            ("minute", minute, 0..=59),
            ("second", second, 0..=most_seconds),
        ] {
            if let Some(part) = part.filter(|part| !range.contains(part)) {
                return Err(format!("there is no {what} {part}"));
            }
        }
        let within = match (second, minute, hour, of_month) {
            (Some(_), ..) => SECOND,
            (None, Some(_), ..) => 61 * SECOND,
            (None, None, Some(_), _) => HOUR + SECOND,
            (None, None, None, Some(_)) => DAY + SECOND,
            _ => i64::MAX,
        };
        if !(0..within).contains(&nanoseconds) {
            return Err("there is more in its finest part than in the part above".to_string());
        }
        let year = year.map(|year| match year {
            0..=LAST_OF_CENTURY => 2000 + year,
            70..=99 => 1900 + year,
            _ => year,
        });
        let days = match (year, month, of_month) {
            (Some(year), Some(month), Some(of)) => day(year, month, of),
            (Some(year), None, Some(nth)) => nth_day(year, nth),
            (None, None, nth) => Some(nth.unwrap_or(0)).filter(|nth| (0..=366).contains(nth)),
            _ => None,
        };
        let days = days.ok_or("there is no such day")?;
        let sum = [
            (days, DAY),
            (hour.unwrap_or(0), HOUR),
            (minute.unwrap_or(0), MINUTE),
            (second.unwrap_or(0), SECOND),
        ]
        .into_iter()
        .try_fold(nanoseconds, |sum, (count, each)| {
            sum.checked_add(count.checked_mul(each)?)
        })
        .ok_or("it is too long ago, or too far ahead")?;
        let kind = match (year, of_month, hour, minute) {
            (Some(_), ..) => Kind::Civil,
            (None, Some(_), ..) => Kind::DayOfYear,
            (None, None, Some(_), _) => Kind::TimeOfDay,
            (None, None, None, Some(_)) => Kind::OfHour,
            _ => Kind::Elapsed,
        };
        Ok(Self {
            kind,
            nanoseconds: [Some(sum); 2],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::Stopwatch;
    use super::*;

    #[test]
    fn parts_mean_what_a_stamp_of_them_means() {
        let half = SECOND / 2;
        for (parts, text) in [
            (
                [Some(2026), Some(11), Some(21), Some(10), Some(15), Some(7)],
                "2026-11-21 10:15:07.5",
            ),
            (
                [Some(26), None, Some(325), Some(10), Some(15), Some(7)],
                "2026:325:10:15:07.5",
            ),
            (
                [None, None, Some(325), Some(10), Some(15), Some(7)],
                "325:10:15:07.5",
            ),
            (
                [None, None, None, Some(10), Some(15), Some(7)],
                "10:15:07.5",
            ),
            ([None, None, None, None, Some(15), Some(7)], "15:07.5"),
        ] {
            assert_eq!(
                Stamp::of_parts(parts, half).ok(),
                Stamp::parse(text),
                "{text}"
            );
        }
        assert!(Stamp::of_parts([None, None, None, Some(1), Some(2), None], 61 * SECOND).is_err());
        assert!(Stamp::of_parts([None, None, None, Some(1), Some(2), Some(3)], SECOND).is_err());
        for parts in [
            [None, None, None, Some(25), Some(0), None],
            [None, None, None, Some(0), Some(60), None],
            [Some(2026), Some(2), Some(30), None, None, None],
            [Some(2026), None, None, None, None, None],
            [None, Some(2), Some(3), None, None, None],
            [None, None, None, None, None, Some(i64::MAX)],
        ] {
            assert!(Stamp::of_parts(parts, 0).is_err(), "{parts:?}");
        }
    }

    #[test]
    fn hours_go_on_behind_midnight() {
        let mut watch = Stopwatch::default();
        let mut push = |hour, minute, second| {
            let parts = [None, None, None, Some(hour), Some(minute), Some(second)];
            watch.seconds(Stamp::of_parts(parts, 0).unwrap()).unwrap()
        };
        assert_eq!([push(23, 59, 59), push(0, 0, 1)], [0.0, 2.0]);
    }
}
