//! A time that stands in several columns: hour, minute and second, or a day and the seconds of it.

use super::super::{label::Label, units::RecordedUnit};
use super::titles::Titles;
use crate::flight::Unit;

/// The columns that stand beside the finest, in the order of [`super::super::stamp::PARTS`], each where there is one.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) struct Parts {
    pub(super) columns: [Option<usize>; 6],
}

/// A time in several columns: the parts, the column of the finest, and its unit.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct InParts {
    pub(super) parts: Parts,
    pub(super) at: usize,
    pub(super) unit: Unit,
    /// That unit as it is to be said, where the file does not say it.
    pub(super) usual: &'static str,
}

impl InParts {
    pub(super) fn has(&self, column: usize) -> bool {
        self.at == column || self.parts.columns.contains(&Some(column))
    }
}

const YEAR: &[&str] = &["year", "yr", "yyyy", "yy"];
const MONTH: &[&str] = &["month", "mon", "mo", "mm"];
const DAY_OF_MONTH: &[&str] = &["day", "dayofmonth", "dd"];
const DAY_OF_YEAR: &[&str] = &[
    "doy",
    "dayofyear",
    "yearday",
    "yday",
    "julianday",
    "jday",
    "ddd",
];
const DAY: &[&str] = &["day", "days"];
const HOUR: &[&str] = &["hour", "hours", "hr", "hrs", "hh"];
const MINUTE: &[&str] = &["minute", "minutes", "min", "mins", "mm", "mi"];
const SECOND: &[&str] = &["second", "seconds", "sec", "secs", "ss"];
const SECOND_OF_DAY: &[&str] = &[
    "sod",
    "secondsofday",
    "secondofday",
    "secofday",
    "secsofday",
    "secondssincemidnight",
    "secsincemidnight",
];
/// Finer than the second, each with its unit.
const FINER: [(&str, &[&str]); 3] = [
    (
        "ms",
        &[
            "millisecond",
            "milliseconds",
            "millis",
            "msec",
            "msecs",
            "ms",
        ],
    ),
    (
        "us",
        &[
            "microsecond",
            "microseconds",
            "micros",
            "usec",
            "usecs",
            "us",
        ],
    ),
    (
        "ns",
        &[
            "nanosecond",
            "nanoseconds",
            "nanos",
            "nano",
            "nsec",
            "nsecs",
            "ns",
        ],
    ),
];
/// Words before these that say whose clock it is.
const WHOSE: [&str; 9] = [
    "utc", "gps", "gmt", "irig", "local", "lcl", "zulu", "rtc", "time",
];

/// The unit of a part of time, by the title of its column.
pub(super) fn unit_of(titles: &Titles, at: usize) -> Option<&'static str> {
    let coarse = [
        ("h", HOUR),
        ("min", MINUTE),
        ("s", SECOND),
        ("s", SECOND_OF_DAY),
    ];
    let mut all = coarse.into_iter().chain(FINER);
    let found = all.find(|(_, words)| is_called(titles, at, words));
    found.map(|(unit, _)| unit)
}

/// The time of a table whose titles say its parts.
pub(super) fn found(titles: &Titles) -> Option<InParts> {
    titles.names.as_ref()?;
    let after = |words: &[&str], first: usize| {
        (first..titles.width).find(|&at| is_called(titles, at, words))
    };
    let before = |words: &[&str], end: usize| (0..end).find(|&at| is_called(titles, at, words));
    let hour = after(HOUR, 0).filter(|&at| is_within(titles, at, 24.0));
    let minute = hour.and_then(|hour| after(MINUTE, hour + 1));
    let minute = minute.filter(|&at| is_within(titles, at, 59.0));
    let second = minute.and_then(|minute| after(SECOND, minute + 1));
    let second = second.filter(|&at| is_within(titles, at, 61.0));
    if let (Some(hour), Some(minute), Some(second)) = (hour, minute, second) {
        let [year, month, day] = date(titles, hour);
        let finest = match finer_than(titles, second) {
            Some((at, unit)) => (Some(second), at, unit),
            None => (None, second, "s"),
        };
        let parts = Parts {
            columns: [year, month, day, Some(hour), Some(minute), finest.0],
        };
        return in_unit(titles, parts, finest.1, finest.2);
    }
    let day = after(DAY_OF_YEAR, 0).filter(|&at| is_within(titles, at, 366.0))?;
    let second = after(SECOND_OF_DAY, 0).or_else(|| after(SECOND, 0))?;
    let parts = Parts {
        columns: [before(YEAR, day), None, Some(day), None, None, None],
    };
    in_unit(titles, parts, second, "s").filter(|_| is_within(titles, second, 86_401.0))
}

/// The column of what is finer than the second: behind it, or elsewhere with the same word for whose clock it is.
fn finer_than(titles: &Titles, second: usize) -> Option<(usize, &'static str)> {
    let whose = whose(titles, second);
    let of_same_clock = |at: &usize| {
        *at == second + 1 || *at != second && whose.is_some() && self::whose(titles, *at) == whose
    };
    let columns = (second + 1..titles.width).chain(0..second);
    let mut columns = columns.filter(of_same_clock);
    columns.find_map(|at| {
        let mut finer = FINER.iter();
        let found = finer.find(|(_, words)| is_called(titles, at, words));
        found.map(|(unit, _)| (at, *unit))
    })
}

/// The word for whose clock a column is of.
fn whose(titles: &Titles, at: usize) -> Option<&'static str> {
    let name = titles.any_label(at).name.to_ascii_lowercase();
    WHOSE.into_iter().find(|whose| name.starts_with(whose))
}

/// Year, month and day before the hour, or the day of the year.
fn date(titles: &Titles, hour: usize) -> [Option<usize>; 3] {
    let find = |words: &[&str], from: usize| (from..hour).find(|&at| is_called(titles, at, words));
    if let Some(year) = find(YEAR, 0)
        && let Some(month) = find(MONTH, year + 1)
        && let Some(day) = find(DAY_OF_MONTH, month + 1)
    {
        return [Some(year), Some(month), Some(day)];
    }
    let day = find(DAY_OF_YEAR, 0).or_else(|| find(DAY, 0).filter(|_| find(MONTH, 0).is_none()));
    let year = day.and_then(|day| find(YEAR, 0).filter(|year| *year < day));
    [year, None, day]
}

fn in_unit(titles: &Titles, parts: Parts, at: usize, usual: &'static str) -> Option<InParts> {
    let stated = RecordedUnit::parse_time(titles.any_label(at).unit);
    let unit = stated
        .or_else(|_| RecordedUnit::parse_time(usual))
        .ok()?
        .unit();
    Some(InParts {
        parts,
        at,
        unit,
        usual,
    })
}

/// Whether a column of numbers has one of these names, perhaps behind a word for whose clock it is.
fn is_called(titles: &Titles, at: usize, words: &[&str]) -> bool {
    let Label { name, .. } = titles.any_label(at);
    let letters = name.chars().filter(char::is_ascii_alphanumeric);
    let letters: String = letters.map(|letter| letter.to_ascii_lowercase()).collect();
    let bare = WHOSE.iter().find_map(|whose| letters.strip_prefix(whose));
    let is_one = |name: &str| words.contains(&name);
    at < titles.width
        && !titles.is_empty(at)
        && (is_one(&letters) || bare.is_some_and(is_one))
        && titles.stamp(at).is_none()
        && !titles.is_text(at)
}

/// Whether the first number of a column is one of a part of time. What follows is judged row by row.
fn is_within(titles: &Titles, at: usize, most: f64) -> bool {
    let first = titles.first_said(at).unwrap_or_default();
    let number = first.trim().replace(',', ".").parse::<f64>();
    number.is_ok_and(|number| (0.0..=most).contains(&number))
}
