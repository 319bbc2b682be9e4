//! Time stamps: dates with a time of day (ISO 8601), times of day, and days of the year with one (IRIG).

use jiff::Timestamp;

use super::cell::unquote;

/// A time stamp: which kind, and nanoseconds since that kind's own beginning.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Stamp {
    kind: Kind,
    nanoseconds: i64,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Kind {
    /// `2026-11-21T12:00:00.123Z`, `2026-11-21 12:00:00+01:00`
    Zoned,
    /// `2026-11-21T12:00:00.123`
    Civil,
    /// `12:00:00.123`
    TimeOfDay,
    /// `325:12:00:00.123`
    DayOfYear,
}

const DAY: i64 = 86_400 * 1_000_000_000;
const LONGEST_STAMP: usize = 48;

impl Stamp {
    /// Reads a cell; `None` if it holds no time stamp. Seconds must be there: `12:30` may be minutes and seconds.
    pub(super) fn parse(cell: &str) -> Option<Self> {
        let text = unquote(cell);
        if text.len() > LONGEST_STAMP || !text.contains(':') {
            return None;
        }
        let (kind, nanoseconds) = if text.get(4..5) == Some("-") {
            dated(text)?
        } else if let Some((day, time)) = day_of_year(text) {
            (Kind::DayOfYear, day * DAY + time_of_day(time)?)
        } else {
            (Kind::TimeOfDay, time_of_day(text)?)
        };
        Some(Self { kind, nanoseconds })
    }
}

fn dated(text: &str) -> Option<(Kind, i64)> {
    let time = text.get(11..)?;
    if time.get(5..6) != Some(":") {
        return None;
    }
    let has_zone = time.ends_with(['Z', 'z']) || time.contains(['+', '-']);
    if has_zone {
        Some((Kind::Zoned, nanoseconds(text)?))
    } else {
        Some((Kind::Civil, nanoseconds(&format!("{text}Z"))?))
    }
}

/// The day and the rest of `325:12:00:00`.
fn day_of_year(text: &str) -> Option<(i64, &str)> {
    let (day, time) = text.split_once(':')?;
    let is_day = day.len() == 3 && time.matches(':').count() == 2;
    let day = day.parse().ok().filter(|day| (1..=366).contains(day))?;
    is_day.then_some((day, time))
}

fn time_of_day(text: &str) -> Option<i64> {
    let hours = text.find(':')?;
    if !matches!(hours, 1 | 2) || text.get(hours + 3..hours + 4) != Some(":") {
        return None;
    }
    nanoseconds(&format!(
        "1970-01-01T{:0>width$}Z",
        text,
        width = text.len() + 2 - hours
    ))
}

fn nanoseconds(text: &str) -> Option<i64> {
    let stamp: Timestamp = text.parse().ok()?;
    stamp.as_nanosecond().try_into().ok()
}

/// Time stamps to seconds since the first.
#[derive(Default)]
pub(super) struct Stopwatch {
    first: Option<Stamp>,
    last: i64,
    midnights: i64,
}

impl Stopwatch {
    /// The seconds from the first stamp to this one. A time of day that falls by more than half a day has
    /// passed midnight.
    ///
    /// # Errors
    /// The stamp is of another kind than the first: with a zone and without, or with and without a date.
    pub(super) fn seconds(&mut self, stamp: Stamp) -> Result<f64, &'static str> {
        let first = *self.first.get_or_insert(stamp);
        if first.kind != stamp.kind {
            return Err(
                "the first time stamp is written in another way, with a date or a zone where this has none or the other way round; write all alike",
            );
        }
        let mut now = stamp.nanoseconds.saturating_add(self.midnights * DAY);
        if stamp.kind == Kind::TimeOfDay && self.last.saturating_sub(now) > DAY / 2 {
            self.midnights += 1;
            now = now.saturating_add(DAY);
        }
        self.last = now;
        // whole nanoseconds below 104 days are exact
        Ok((i128::from(now) - i128::from(first.nanoseconds)) as f64 / 1e9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(stamps: &[&str]) -> Vec<f64> {
        let mut watch = Stopwatch::default();
        let read = |text: &&str| watch.seconds(Stamp::parse(text).expect(text)).unwrap();
        stamps.iter().map(read).collect()
    }

    #[test]
    fn stamps_become_seconds_since_the_first() {
        let expected = [0.0, 0.04, 1.5];
        for stamps in [
            [
                "2026-11-21T12:00:00Z",
                "2026-11-21T12:00:00.040Z",
                "\"2026-11-21T12:00:01,5Z\"",
            ],
            [
                "2026-11-21T12:00:00+01:00",
                "2026-11-21T11:00:00.04Z",
                "2026-11-21 11:00:01.5+00",
            ],
            [
                "2026-12-31 23:59:59",
                "2026-12-31 23:59:59.04",
                "2027-01-01T00:00:00.5",
            ],
            ["9:59:59", "9:59:59.04", "10:00:00.5"],
            ["23:59:59", "23:59:59.040", "00:00:00.500"],
            ["325:23:59:59.000", "325:23:59:59.040000", "326:00:00:00.5"],
        ] {
            assert_eq!(seconds(&stamps), expected, "{stamps:?}");
        }
        assert_eq!(
            seconds(&["23:59:59", "0:00:01", "0:00:02"]),
            [0.0, 2.0, 3.0]
        );
    }

    #[test]
    fn what_is_ambiguous_or_no_time_is_none() {
        for text in [
            "",
            "1.5",
            "12:30",
            "2026-11-21T12:30",
            "21.11.2026 12:00:00",
            "11/21/2026 12:00:00",
            "12:00:00 PM",
            "2026-13-01T00:00:00Z",
            "25:00:00",
            "20261121",
            "9999-01-01T00:00:00Z",
            "000:12:00:00",
            ":::",
            "é:00:00",
            "2026-é1-21T12:00:00",
            "12:00:00é",
            "400:12:00:00",
        ] {
            assert_eq!(Stamp::parse(text), None, "{text}");
        }
    }

    #[test]
    fn kinds_do_not_mix() {
        let mut watch = Stopwatch::default();
        let mut push = |text: &str| watch.seconds(Stamp::parse(text).unwrap());
        assert!(push("2026-11-21T12:00:00Z").is_ok());
        assert!(push("2026-11-21T12:00:01").is_err());
        assert!(push("12:00:02").is_err());
        assert_eq!(push("2026-11-21T12:00:03Z"), Ok(3.0));
    }
}
