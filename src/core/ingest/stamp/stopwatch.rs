//! Time stamps to seconds since the first.

use super::clock::{DAY, HOUR};
use super::value::{Kind, Stamp};

/// Time stamps to seconds since the first.
#[derive(Default)]
pub(in super::super) struct Stopwatch {
    first: Option<Stamp>,
    last: i64,
    rounds: i64,
}

impl Stopwatch {
    /// The stamp that others are counted from.
    pub(in super::super) fn first(&self) -> Option<Stamp> {
        self.first
    }

    /// The seconds from the first stamp to this one. A time of day that falls by more than half a day has
    /// passed midnight, and minutes that fall by more than half an hour the full hour.
    ///
    /// # Errors
    /// The stamp is of another kind than the first: with a zone and without, or with and without a date. Or what is day and
    /// what is month in it matters and is not told.
    pub(in super::super) fn seconds(&mut self, stamp: Stamp) -> Result<f64, &'static str> {
        let first = *self.first.get_or_insert(stamp);
        if first.kind != stamp.kind {
            return Err(
                "the first time stamp is written in another way, with a date or a zone where this has none or the other way round; write all alike",
            );
        }
        let since = |at: usize| {
            let (first, now) = (first.nanoseconds[at]?, stamp.nanoseconds[at]?);
            Some(i128::from(now) - i128::from(first))
        };
        let since = match (since(0), since(1)) {
            (Some(day_first), Some(month_first)) if day_first != month_first => {
                return Err(
                    "the day has changed, and what is the day and what the month in it can be told in two ways; write dates like 2026-11-21",
                );
            }
            (Some(since), _) | (None, Some(since)) => since,
            (None, None) => {
                return Err(
                    "the day stands first here and second in the first time stamp, or the other way round; write all alike",
                );
            }
        };
        let round = match stamp.kind {
            Kind::TimeOfDay => DAY,
            Kind::OfHour => HOUR,
            // whole nanoseconds below 104 days are exact
            _ => return Ok(since as f64 / 1e9),
        };
        let since = i64::try_from(since).unwrap_or(i64::MAX);
        let mut now = since.saturating_add(self.rounds * round);
        if self.last.saturating_sub(now) > round / 2 {
            self.rounds += 1;
            now = now.saturating_add(round);
        }
        self.last = now;
        Ok(now as f64 / 1e9)
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
            ["325-23:59:59.000", "325-23:59:59.040", "326-00:00:00.5"],
            [
                "2026:365:23:59:59",
                "2026:365:23:59:59.04",
                "2027:001:00:00:00.5",
            ],
            [
                "2026-365T23:59:59",
                "2026-365T23:59:59.04",
                "2027-001T00:00:00.5",
            ],
            ["11:59:59 AM", "11:59:59.04 AM", "12:00:00.5 PM"],
            [
                "21.11.2026 23:59:59",
                "21.11.2026 23:59:59.04",
                "22.11.2026 00:00:00.5",
            ],
            [
                "11/21/2026 23:59:59",
                "11/21/2026 23:59:59.04",
                "11/22/2026 0:00:00.5",
            ],
            [
                "03/04/2026 10:00:00",
                "03/04/2026 10:00:00.04",
                "03/04/2026 10:00:01.5",
            ],
            [
                "21-Nov-2026 10:00:00",
                "21-Nov-2026 10:00:00.04",
                "21-Nov-2026 10:00:01.5",
            ],
            [
                "Nov 21, 2026 1:00:00 PM",
                "Nov 21, 2026 1:00:00.04 PM",
                "Nov 21, 2026 1:00:01.5 PM",
            ],
            ["20261121T235959", "20261121T235959.04", "20261122T000000.5"],
            ["59:59.0", "59:59.04", "00:00.5"],
            ["10:15:00:000", "10:15:00:040", "10:15:01:500"],
            ["0.00 sec", "0.04 sec", "1.5 sec"],
            ["0 ms", "40 ms", "1500 ms"],
        ] {
            assert_eq!(seconds(&stamps), expected, "{stamps:?}");
        }
        assert_eq!(
            seconds(&["23:59:59", "0:00:01", "0:00:02"]),
            [0.0, 2.0, 3.0]
        );
    }

    #[test]
    fn a_day_in_a_column_of_its_own_counts() {
        let mut watch = Stopwatch::default();
        let mut push = |day, time| watch.seconds(Stamp::parse_with_date(day, time).unwrap());
        assert_eq!(push("2026-11-21", "23:59:59"), Ok(0.0));
        assert_eq!(push("2026-11-22", "00:00:01"), Ok(2.0));
        assert_eq!(push("2026-11-24", "00:00:01"), Ok(2.0 + 2.0 * 86400.0));
        assert!(Stamp::parse_with_date("x", "00:00:01").is_none());
        assert!(Stamp::is_date("11/21/2026") && !Stamp::is_date("1.5"));
    }

    #[test]
    fn what_is_ambiguous_or_no_time_is_none() {
        for text in [
            "",
            "1.5",
            "12:30",
            "2026-11-21T12:30",
            "2026-13-01T00:00:00Z",
            "32.11.2026 12:00:00",
            "13:00:00 PM",
            "25:00:00",
            "20261121",
            "000:12:00:00",
            ":::",
            "é:00:00",
            "2026-é1-21T12:00:00",
            "12:00:00é",
            "400:12:00:00",
            "9999-01-01T00:00:00Z",
            "5 deg",
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

    #[test]
    fn a_day_that_may_be_a_month_is_refused_where_it_matters() {
        let mut watch = Stopwatch::default();
        let mut push = |text: &str| watch.seconds(Stamp::parse(text).unwrap());
        assert_eq!(push("03/04/2026 23:59:59"), Ok(0.0));
        assert_eq!(push("03/04/2026 23:59:59.5"), Ok(0.5));
        assert!(push("03/05/2026 00:00:00").unwrap_err().contains("month"));
    }
}
