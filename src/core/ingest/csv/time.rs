//! Which columns of a table are time, and how it is written in them.

use super::super::{
    code,
    fault::{of_file, pointer},
    mapping::{MappedTime, Titles as Wanted},
    stamp::Stamp,
    units::RecordedUnit,
};
use super::{
    parts::{self, InParts, Parts},
    time_column::{found, unit_word},
    titles::Titles,
};
use crate::flight::{Dimension, Fault, Unit};

/// How the samples of a table get their times.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Time {
    /// Numbers in a unit.
    Numbers {
        at: usize,
        unit: Unit,
    },
    /// Numbers that count from a day long ago, such as 1970: of these the differences are kept, to the last digit.
    Epoch {
        at: usize,
        unit: Unit,
    },
    Stamps {
        at: usize,
    },
    /// Times of day without signs between their parts: `101500.25`.
    Packed {
        at: usize,
    },
    /// Times of day, and the dates that they are of.
    Dated {
        date: usize,
        at: usize,
    },
    /// Weeks of the satellites' clock, and the time since each began.
    Week {
        week: usize,
        at: usize,
        unit: Unit,
    },
    /// Parts of it, from the year down to the second, and the finest in a unit.
    Parts(InParts),
    /// There is no column of it; seconds.
    Even {
        start: f64,
        step: f64,
    },
}

impl Time {
    pub(super) fn columns(self) -> impl Iterator<Item = usize> {
        self.beside().chain(self.column())
    }

    /// The columns that are read with [`Self::column`], in this order.
    pub(super) fn beside(self) -> impl Iterator<Item = usize> {
        let columns = match self {
            Self::Dated { date, .. } => [Some(date), None, None, None, None, None],
            Self::Week { week, .. } => [Some(week), None, None, None, None, None],
            Self::Parts(InParts { parts, .. }) => parts.columns,
            _ => [None; 6],
        };
        columns.into_iter().flatten()
    }

    /// The column by which a sample has a time.
    pub(super) fn column(self) -> Option<usize> {
        match self {
            Self::Numbers { at, .. }
            | Self::Epoch { at, .. }
            | Self::Stamps { at }
            | Self::Packed { at }
            | Self::Dated { at, .. }
            | Self::Week { at, .. }
            | Self::Parts(InParts { at, .. }) => Some(at),
            Self::Even { .. } => None,
        }
    }
}

/// What a mapping says of time, and else the titles and the first rows.
pub(super) fn of(titles: &Titles, said: &MappedTime, faults: &mut Vec<Fault>) -> Option<Time> {
    let mut refuse = |place: &str, (code, message): (&'static str, String)| {
        faults.push(Fault::new(place, code, message));
    };
    let unit = |refuse: &mut dyn FnMut(&str, (&'static str, String))| {
        RecordedUnit::parse_time(&said.unit)
            .map_err(|why| refuse("/time/unit", why))
            .ok()
    };
    if let Some(step) = said.step {
        let unit = unit(&mut refuse)?.unit();
        let even = Time::Even {
            start: unit.to_si(said.start.unwrap_or(0.0)),
            step: unit.to_si(step),
        };
        return Some(even);
    }
    let mut column = |member: &str, wanted: &Option<Wanted>| match wanted {
        None => Some(None),
        Some(wanted) => match titles.find(wanted) {
            Ok(at) => Some(Some(at)),
            Err(why) => {
                refuse(&pointer(["time", member]), why);
                None
            }
        },
    };
    let from = column("from", &said.from);
    let date = column("date", &said.date);
    let week = column("week", &said.week);
    let mut parts = Parts::default();
    let mut are_known = true;
    for (column_of, (part, wanted)) in parts.columns.iter_mut().zip(said.parts()) {
        match column(part, wanted) {
            Some(at) => *column_of = at,
            None => are_known = false,
        }
    }
    let (from, date, week) = (from?, date?, week?);
    if !are_known {
        return None;
    }
    if from.is_none_or(|at| titles.is_empty(at))
        && let Some(even) = stated(titles, found(titles))
    {
        return even.map_err(|fault| faults.push(fault)).ok();
    }
    if let Some(at) = from.filter(|_| said.has_parts()) {
        return in_parts(titles, parts, at, said)
            .map_err(|(place, (code, message))| faults.push(Fault::new(place, code, message)))
            .ok();
    }
    let whole = from.or_else(|| found(titles));
    // seconds may be those of a minute
    if from.is_none()
        && let Some(parts) = parts::found(titles)
        && whole.is_none_or(|at| parts.has(at))
    {
        return Some(Time::Parts(parts));
    }
    let Some(at) = whole else {
        faults.push(no_time(titles));
        return None;
    };
    let place = if from.is_some() {
        "/time/unit".to_string()
    } else {
        place_of(titles, at)
    };
    let is_mapped = from.is_some();
    match written(
        titles,
        at,
        said,
        date.or_else(|| date_of(titles, at, is_mapped)),
        week.or_else(|| week_of(titles, at, is_mapped)),
    ) {
        Ok(time) => Some(time),
        Err((code, message)) => {
            let message = if is_mapped {
                message
            } else {
                format!("column {}: {message}", at + 1)
            };
            faults.push(Fault::new(place, code, message));
            None
        }
    }
}

/// The finest part of a time of which a mapping says the others.
fn in_parts(
    titles: &Titles,
    parts: Parts,
    at: usize,
    said: &MappedTime,
) -> Result<Time, (&'static str, (&'static str, String))> {
    if titles.stamp(at).is_some() {
        let message =
            "this column has time stamps, which need no parts beside them; leave these out"
                .to_string();
        return Err(("/time/from", (code::INVALID_MAPPING, message)));
    }
    let stated = match said.unit.is_empty() {
        true => titles.label(at).map_err(|why| ("/time/from", why))?.unit,
        false => &said.unit,
    };
    let usual = parts::unit_of(titles, at).or(match (&said.second, &said.minute, &said.hour) {
        // beside seconds stands what is finer
        (Some(_), ..) => Some(""),
        (None, None, Some(_)) => None,
        _ => Some("s"),
    });
    let unit = Some(stated).filter(|unit| !unit.is_empty()).or(usual);
    let unit = unit.ok_or_else(|| {
        let message = "beside hours alone stand minutes as often as seconds; say which, as unit = \"min\" or unit = \"s\"";
        ("/time/unit", (code::TIME_UNIT, message.to_string()))
    })?;
    let unit = RecordedUnit::parse_time(unit).map_err(|why| ("/time/unit", why))?;
    let (unit, usual) = (unit.unit(), usual.unwrap_or_default());
    Ok(Time::Parts(InParts {
        parts,
        at,
        unit,
        usual,
    }))
}

fn place_of(titles: &Titles, at: usize) -> String {
    let name = titles.any_label(at).name;
    let is_clear = super::super::name::is_identifier(name);
    let number = (at + 1).to_string();
    pointer(["columns", if is_clear { name } else { &number }])
}

fn no_time(titles: &Titles) -> Fault {
    if titles.names.is_none() {
        let message = format!(
            "rows of {} numbers have no names and units; say with a mapping which column is what, as (:,1)",
            titles.width
        );
        return of_file(code::MAPPING_NEEDED, message);
    }
    of_file(
        code::NO_TIME_COLUMN,
        "no column is named t or time (or timestamp), and none has time stamps; say with a mapping which one it is, or time = {step = 0.02, unit = \"s\"} where samples are evenly spaced",
    )
}

/// The times that the lines above a table say: even ones, where no column has any; or those of a first column without a title
/// that goes on by the step.
///
/// # Errors
/// Their number can be read in two ways.
fn stated(titles: &Titles, found: Option<usize>) -> Option<Result<Time, Fault>> {
    let stated = titles.stated?;
    let is_there = found.is_some_and(|at| !titles.is_empty(at));
    let is_in_parts = parts::found(titles).is_some();
    if is_there || is_in_parts || titles.names.is_none() {
        return None;
    }
    let Some(step) = stated.step else {
        let message = format!(
            "line {}: the comma in its number may be a decimal comma or stand between thousands, and no number of the table tells which; say in a mapping how far samples are apart, as time = {{step = 0.02, unit = \"s\"}}",
            stated.line
        );
        return Some(Err(of_file(code::AMBIGUOUS_NUMBER, message)));
    };
    let first = titles
        .first
        .iter()
        .filter_map(|row| row.first()?.trim().parse::<f64>().ok());
    let first: Vec<f64> = first.collect();
    let goes_on = first.len() > 1
        && first
            .windows(2)
            .all(|pair| ((pair[1] - pair[0]) / step - 1.0).abs() < 1e-3);
    let unit = RecordedUnit::parse_time("s").ok()?.unit();
    Some(Ok(match titles.title(0).is_empty() && goes_on {
        true => Time::Numbers { at: 0, unit },
        false => Time::Even { start: 0.0, step },
    }))
}

/// The column of dates that goes with a column of times of day.
fn date_of(titles: &Titles, at: usize, is_mapped: bool) -> Option<usize> {
    let is_time_of_day = titles.stamp(at).is_some_and(Stamp::is_time_of_day);
    let is_date = |&other: &usize| {
        other != at && titles.any_label(other).is_called_date() && titles.has_dates(other)
    };
    (0..titles.width)
        .find(is_date)
        .filter(|_| is_time_of_day && !is_mapped)
}

/// The column of weeks that goes with one of the satellites' time.
fn week_of(titles: &Titles, at: usize, is_mapped: bool) -> Option<usize> {
    let name = titles.any_label(at).name.to_ascii_lowercase();
    let is_of_week = ["tow", "gps", "week"]
        .iter()
        .any(|word| name.contains(word));
    let is_number = |other: usize| {
        titles
            .first_said(other)
            .is_some_and(|cell| cell.trim().parse::<u32>().is_ok())
    };
    let is_week = |&other: &usize| {
        other != at && titles.any_label(other).is_called_week() && is_number(other)
    };
    (0..titles.width)
        .find(is_week)
        .filter(|_| is_of_week && !is_mapped && titles.stamp(at).is_none())
}

/// Two time units for the satellites' week: its length is said in seconds.
const YEAR: f64 = 365.25 * 86_400.0;

fn written(
    titles: &Titles,
    at: usize,
    said: &MappedTime,
    date: Option<usize>,
    week: Option<usize>,
) -> Result<Time, (&'static str, String)> {
    let label = titles.label(at)?;
    let unit = if said.unit.is_empty() {
        label.unit
    } else {
        &said.unit
    };
    if unit.to_ascii_lowercase().starts_with("hhmmss") && !titles.is_text(at) {
        return Ok(Time::Packed { at });
    }
    if titles.stamp(at).is_some() {
        let unit = if said.unit.is_empty() {
            label.unit
        } else {
            &said.unit
        };
        RecordedUnit::of_stamps(unit)?;
        return Ok(match date {
            Some(date) => Time::Dated { date, at },
            None => Time::Stamps { at },
        });
    }
    let first = titles.first_said(at).unwrap_or_default().trim();
    if titles.is_text(at) {
        let cell = super::super::text::quoted(first);
        let message = format!(
            "{cell} is no time stamp that is known; write 2026-11-21T10:15:00.123, 10:15:00.123 or 325:10:15:00.123, or seconds"
        );
        return Err((code::TIME_UNIT, message));
    }
    let number = first
        .trim_matches('"')
        .replace(',', ".")
        .parse::<f64>()
        .unwrap_or(0.0);
    let unit = if !said.unit.is_empty() {
        RecordedUnit::parse_time(&said.unit)?.unit()
    } else if !label.unit.is_empty() {
        RecordedUnit::parse_time(label.unit)?.unit()
    } else if let Some(unit) = unit_of_epoch(number) {
        unit
    } else if let Some(unit) = unit_word(titles, at) {
        RecordedUnit::parse_time(unit)?.unit()
    } else {
        RecordedUnit::parse_time("")?.unit()
    };
    Ok(match week {
        Some(week) => Time::Week { week, at, unit },
        None if unit.to_si(number).abs() > 3.0 * YEAR => Time::Epoch { at, unit },
        None => Time::Numbers { at, unit },
    })
}

/// The unit in which a number counts from 1970 to our time: only one does.
fn unit_of_epoch(number: f64) -> Option<Unit> {
    let is_of_our_time = |scale: f64| (30.0 * YEAR..80.0 * YEAR).contains(&(number * scale));
    let scale = [1.0, 1e-3, 1e-6, 1e-9]
        .into_iter()
        .find(|&scale| is_of_our_time(scale))?;
    Some(Unit {
        scale,
        offset: 0.0,
        dimension: Dimension::SECOND,
    })
}
