//! A time stamp: dates with a time of day, times of day, days of the year with one (IRIG), lengths of time.

use super::super::cell::unquote;
use super::{
    clock::{DAY, HOUR, elapsed, minutes, time_of_day},
    date::{Readings, date, number},
};

/// A time stamp: which kind, and nanoseconds since that kind's own beginning.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in super::super) struct Stamp {
    pub(super) kind: Kind,
    /// With the day before the month, and with the month before the day; the same where that is clear.
    pub(super) nanoseconds: [Option<i64>; 2],
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    /// `2026-11-21T12:00:00.123Z`, `2026-11-21 12:00:00+01:00`
    Zoned,
    /// `2026-11-21T12:00:00.123`, `21.11.2026 12:00:00`, `2026:325:12:00:00`
    Civil,
    /// `12:00:00.123`, `11:00:00 PM`
    TimeOfDay,
    /// `325:12:00:00.123`
    DayOfYear,
    /// `47:00.1`
    OfHour,
    /// `0.02 sec`
    Elapsed,
}

/// By what a recording's time is told.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in super::super) enum ClockKind {
    /// Seconds since the recorder's own beginning.
    Own,
    Utc,
    /// Dates and times of a table of types, of which the zone is not looked at.
    Instant,
    /// Dates and times without a zone.
    Civil,
    DayOfYear,
    TimeOfDay,
    OfHour,
    /// Weeks and seconds of the satellites.
    Gps,
}

const LONGEST_STAMP: usize = 48;

impl Stamp {
    /// Reads a cell; `None` if it holds no time stamp. Seconds must be there: `12:30` may be minutes and seconds.
    pub(in super::super) fn parse(cell: &str) -> Option<Self> {
        let text = unquote(cell);
        if text.len() > LONGEST_STAMP || !text.is_ascii() {
            return None;
        }
        let is_compact = || text.len() >= 15 && b"Tt _-".contains(&text.as_bytes()[8]);
        if !text.contains(':') {
            let compact = is_compact().then(|| compact(text)).flatten();
            return compact
                .or_else(|| for_file_names(text))
                .or_else(|| elapsed(text).map(|at| of(Kind::Elapsed, at)));
        }
        let (text, zone) = without_zone(text);
        let stamp = without_a_zone(text)?;
        match zone {
            None => Some(stamp),
            Some(offset) => match stamp.kind {
                Kind::Civil => Some(Self {
                    kind: Kind::Zoned,
                    nanoseconds: stamp.nanoseconds.map(|at| at?.checked_sub(offset)),
                }),
                Kind::TimeOfDay | Kind::DayOfYear if offset == 0 => Some(stamp),
                _ => None,
            },
        }
    }

    /// A day and a time of day, from cells of their own.
    pub(in super::super) fn parse_with_date(day: &str, time: &str) -> Option<Self> {
        let stamp = Self::parse(time).filter(|stamp| stamp.kind == Kind::TimeOfDay)?;
        on(date(unquote(day))?, stamp.nanoseconds[0]?)
    }

    /// Whether a cell holds a date and no time.
    pub(in super::super) fn is_date(cell: &str) -> bool {
        let text = unquote(cell);
        text.is_ascii()
            && text.len() <= LONGEST_STAMP
            && text.contains(['-', '/', '.', ' '])
            && date(text).is_some()
    }

    /// By which clock it is told.
    pub(in super::super) fn clock(self) -> ClockKind {
        match self.kind {
            Kind::Zoned => ClockKind::Utc,
            Kind::Civil => ClockKind::Civil,
            Kind::TimeOfDay => ClockKind::TimeOfDay,
            Kind::DayOfYear => ClockKind::DayOfYear,
            Kind::OfHour => ClockKind::OfHour,
            Kind::Elapsed => ClockKind::Own,
        }
    }

    /// Nanoseconds since its clock's beginning; `None` where the day and the month in it are not told apart.
    pub(in super::super) fn nanoseconds(self) -> Option<i64> {
        match self.nanoseconds {
            [Some(one), Some(other)] => (one == other).then_some(one),
            [one, other] => one.or(other),
        }
    }

    pub(in super::super) fn is_time_of_day(self) -> bool {
        self.kind == Kind::TimeOfDay
    }
}

fn of(kind: Kind, nanoseconds: i64) -> Stamp {
    Stamp {
        kind,
        nanoseconds: [Some(nanoseconds); 2],
    }
}

fn on(days: Readings, time: i64) -> Option<Stamp> {
    let nanoseconds = days.map(|day| day?.checked_mul(DAY)?.checked_add(time));
    let stamp = Stamp {
        kind: Kind::Civil,
        nanoseconds,
    };
    nanoseconds.iter().any(Option::is_some).then_some(stamp)
}

/// `20261121T101500.123`
fn compact(text: &str) -> Option<Stamp> {
    let time = text.get(9..)?.trim_end_matches(['Z', 'z']);
    let (clock, fraction) = time.split_at_checked(6)?;
    let [hours, minutes, seconds] = [clock.get(..2)?, clock.get(2..4)?, clock.get(4..)?];
    let time = time_of_day(&format!("{hours}:{minutes}:{seconds}{fraction}"))?;
    on(date(&text[..8])?, time)
}

/// `2026-11-21_10-15-00.123`, as names of files have it.
fn for_file_names(text: &str) -> Option<Stamp> {
    let (day, clock) = text.split_once(['_', 'T'])?;
    let fields: Vec<&str> = clock.split('-').collect();
    let [hours, minutes, seconds] = *fields.as_slice() else {
        return None;
    };
    let time = time_of_day(&format!("{hours}:{minutes}:{seconds}"))?;
    on(date(day)?, time)
}

/// `0 days 00:00:00.02`: days before a time.
fn days(text: &str) -> Option<Stamp> {
    let (count, time) = text.split_once(" day")?;
    let time = time.trim_start_matches(['s', ',', ' ']);
    let at = number(count)?.checked_mul(DAY)?;
    Some(of(Kind::Elapsed, at.checked_add(time_of_day(time)?)?))
}

/// The text before its time zone, and how far that is ahead of UTC.
fn without_zone(text: &str) -> (&str, Option<i64>) {
    for word in ["UTC", "GMT", "Z", "z"] {
        if let Some(text) = text.strip_suffix(word) {
            return (text.trim_end(), Some(0));
        }
    }
    let first_colon = text.find(':').unwrap_or(text.len());
    let Some(at) = text.rfind(['+', '-']).filter(|&at| at > first_colon) else {
        return (text, None);
    };
    let digits: String = text[at + 1..].chars().filter(|c| *c != ':').collect();
    let minutes = match digits.len() {
        2 => number(&digits).map(|hours| 60 * hours),
        4 => number(&digits).map(|both| both / 100 * 60 + both % 100),
        _ => None,
    };
    match minutes {
        Some(minutes) => {
            let sign = if text[at..].starts_with('-') { -1 } else { 1 };
            (text[..at].trim_end(), Some(sign * minutes * HOUR / 60))
        }
        None => (text, None),
    }
}

fn without_a_zone(text: &str) -> Option<Stamp> {
    let colons = text.bytes().filter(|&byte| byte == b':').count();
    let (first, rest) = text.split_once(':')?;
    match colons {
        1 => minutes(text).map(|at| of(Kind::OfHour, at)),
        // 325:10:15:00:123
        4 if first.len() == 3 => day_of_year(first, rest),
        // a year and its day: 2026:325:10:15:00, 26:325:10:15:00
        4 => {
            let (day, time) = rest.split_once(':')?;
            let century = if first.len() == 2 { "20" } else { "" };
            let days = date(&format!("{century}{first}-{day}"))?;
            on(days, time_of_day(time)?)
        }
        3 if first.len() == 3 => day_of_year(first, rest),
        3 if first.len() > 3 => {
            // a date, a colon, a time: 21/Nov/2026:10:15:00
            match date(first) {
                Some(days) => on(days, time_of_day(rest)?),
                None => dated(text),
            }
        }
        _ => match time_of_day(text) {
            Some(at) => Some(of(Kind::TimeOfDay, at)),
            None => days(text).or_else(|| dated(text)),
        },
    }
}

fn day_of_year(day: &str, time: &str) -> Option<Stamp> {
    let day = number(day).filter(|day| (1..=366).contains(day))?;
    Some(of(Kind::DayOfYear, day * DAY + time_of_day(time)?))
}

/// A date or a day of the year, something between, and a time.
fn dated(text: &str) -> Option<Stamp> {
    let hours = text.find(':')?;
    let digits = text[..hours]
        .bytes()
        .rev()
        .take_while(u8::is_ascii_digit)
        .count();
    if !(1..=2).contains(&digits) {
        return None;
    }
    let (before, time) = text.split_at(hours - digits);
    let day = before.trim_end_matches([' ', ',', '_', '-', '/']);
    let day = if day.len() == before.len() {
        before.strip_suffix(['T', 't'])?
    } else {
        day
    };
    if day.len() == 3 {
        return day_of_year(day, time);
    }
    on(date(day)?, time_of_day(time)?)
}
