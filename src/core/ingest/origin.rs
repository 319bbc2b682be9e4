//! What the zero of a recording's time is.

use super::stamp::{ClockKind, DAY, HOUR, Stamp};

/// A clock, and when by it the zero of a recording is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Origin {
    clock: ClockKind,
    nanoseconds: i128,
}

impl Origin {
    /// A clock of the recorder's own, which says nothing of others.
    pub(super) const OWN: Self = Self::at(ClockKind::Own, 0);

    pub(super) const fn at(clock: ClockKind, nanoseconds: i128) -> Self {
        Self { clock, nanoseconds }
    }

    /// Where a stamp is the zero; `None` where what is the day in it and what the month is not told.
    pub(super) fn of_stamp(stamp: Stamp) -> Option<Self> {
        let nanoseconds = stamp.nanoseconds()?;
        Some(Self::at(stamp.clock(), nanoseconds.into()))
    }

    pub(super) fn is_of(self, clock: ClockKind) -> bool {
        self.clock == clock
    }

    /// For a message.
    pub(super) fn name(self) -> &'static str {
        match self.clock {
            ClockKind::Own => "seconds of its own",
            ClockKind::Utc => "time stamps of UTC",
            ClockKind::Instant => "dates and times of a typed table",
            ClockKind::Civil => "dates and times without a zone",
            ClockKind::DayOfYear => "days of the year",
            ClockKind::TimeOfDay => "times of day",
            ClockKind::OfHour => "minutes and seconds",
            ClockKind::Gps => "week and seconds of the satellites",
        }
    }

    /// How much later the zero is than another; `None` where the clocks are different. Times of day are those that are
    /// closest.
    pub(super) fn since(self, other: Self) -> Option<f64> {
        let since = self.nanoseconds - other.nanoseconds;
        let round = match self.clock {
            ClockKind::TimeOfDay => Some(i128::from(DAY)),
            ClockKind::OfHour => Some(i128::from(HOUR)),
            _ => None,
        };
        let since = match round {
            Some(round) => (since + round / 2).rem_euclid(round) - round / 2,
            None => since,
        };
        let is_instant = |clock| matches!(clock, ClockKind::Utc | ClockKind::Instant);
        let are_one =
            self.clock == other.clock || is_instant(self.clock) && is_instant(other.clock);
        are_one.then_some(since as f64 / 1e9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_of_one_kind_are_compared() {
        let of = |text: &str| Origin::of_stamp(Stamp::parse(text).unwrap()).unwrap();
        let since = |later: &str, earlier: &str| of(later).since(of(earlier));
        assert_eq!(
            since("2026-11-21T12:00:01.5Z", "2026-11-21T13:00:00+01:00"),
            Some(1.5)
        );
        assert_eq!(since("2026-11-21T12:00:00Z", "2026-11-21T12:00:00"), None);
        assert_eq!(since("0:00:01", "23:59:59"), Some(2.0));
        assert_eq!(since("23:59:59", "0:00:01"), Some(-2.0));
        assert_eq!(since("12:00:00", "10:00:00"), Some(7200.0));
        assert_eq!(since("325:12:00:00", "324:12:00:00"), Some(86_400.0));
        assert_eq!(since("0.5 sec", "0.25 sec"), Some(0.25));
        assert_eq!(Origin::OWN.since(of("0.5 sec")), Some(-0.5));
        let unclear = Stamp::parse("03/04/2026 10:00:00").unwrap();
        assert_eq!(Origin::of_stamp(unclear), None);
    }
}
