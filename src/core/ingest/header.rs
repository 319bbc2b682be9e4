//! The header of a table: which column is time, and name and unit of every other.

use std::collections::HashSet;

use crate::flight::Fault;

use super::{
    IngestError, Limits, code,
    fault::of_file,
    fault::pointer,
    label::Label,
    name::{Names, is_identifier},
    stamp::Stamp,
    units::RecordedUnit,
};

/// A header without faults.
pub(super) struct Header {
    /// Which of the columns is time, from 0.
    pub(super) time: usize,
    /// Time is written as time stamps; the unit of its column is then the second.
    pub(super) has_stamps: bool,
    /// All columns, time included; without a value those that are left out.
    pub(super) columns: Vec<Option<Column>>,
}

pub(super) struct Column {
    pub(super) name: String,
    pub(super) unit: RecordedUnit,
}

/// What a table says of its columns.
#[derive(Default)]
pub(super) struct Titles<'a> {
    /// Names, and units in brackets.
    pub(super) names: Vec<&'a str>,
    /// A row of units, if there is one; as many as names.
    pub(super) units: Option<Vec<&'a str>>,
    /// The cells of the first sample, by which time stamps are known; may be fewer.
    pub(super) first: Vec<&'a str>,
}

impl Header {
    /// Reads titles like `alpha[deg]`, `alpha (deg)`, or `mach` for a pure number.
    ///
    /// # Errors
    /// Every fault of the header.
    pub(super) fn parse(titles: &Titles, limits: &Limits) -> Result<Self, IngestError> {
        let names = titles.names.iter().map(|name| Label::split(name));
        let labels: Vec<Result<Label, _>> = match &titles.units {
            Some(units) => names
                .zip(units)
                .map(|(label, unit)| label.with_unit(unit))
                .collect(),
            None => names.map(Ok).collect(),
        };
        let known: Vec<Label> = (labels.iter().zip(&titles.names))
            .map(|(label, name)| {
                label
                    .as_ref()
                    .map_or_else(|_| Label::split(name), |&label| label)
            })
            .collect();
        let is_stamp = |at: usize| {
            titles
                .first
                .get(at)
                .is_some_and(|cell| Stamp::parse(cell).is_some())
        };
        let time = time_column(&known, is_stamp);
        let has_stamps = time.is_some_and(is_stamp);
        let mut faults: Vec<Fault> = missing_columns(time, known.len()).collect();
        let mut names = Names::new(limits);
        let mut pointed_at = HashSet::new();
        let mut columns = Vec::with_capacity(known.len());

        for (at, label) in known.iter().enumerate() {
            let name_fault = if time == Some(at) {
                None
            } else if time.is_some_and(|time| known[time].name == label.name) {
                Some(second_time_column(label.name))
            } else {
                label.check_name(&mut names).err()
            };
            let unit = match &labels[at] {
                Err(conflict) => Err(conflict.clone()),
                Ok(_) if time != Some(at) => RecordedUnit::parse(label.unit),
                Ok(_) if has_stamps => RecordedUnit::of_stamps(label.unit),
                Ok(_) => RecordedUnit::parse_time(label.unit),
            };
            // A name that is no identifier, or stands twice, does not say which column is meant.
            let is_name_clear = is_identifier(label.name)
                && label.name.len() <= limits.max_name_length
                && pointed_at.insert(label.name);
            let place = if is_name_clear {
                label.name.to_string()
            } else {
                (at + 1).to_string()
            };
            let mut report = |(code, message): (&'static str, String)| {
                let message = format!("column {}: {message}", at + 1);
                faults.push(Fault::new(pointer(["columns", &place]), code, message));
            };
            if let Some(why) = name_fault {
                report(why);
            }
            match unit {
                Ok(unit) => columns.push(Some(Column {
                    name: label.name.to_string(),
                    unit,
                })),
                Err(why) => report(why),
            }
        }

        IngestError::refuse(faults)?;
        Ok(Self {
            // Without a time column there was a fault.
            time: time.unwrap_or_default(),
            has_stamps,
            columns,
        })
    }
}

/// The first column called t or time, or else timestamp. `T[K]` before `t[s]` is a temperature: one
/// with a unit of time, or with time stamps, goes first.
fn time_column(labels: &[Label], is_stamp: impl Fn(usize) -> bool) -> Option<usize> {
    let of_all = |condition: &dyn Fn(usize) -> bool| (0..labels.len()).find(|&at| condition(at));
    let is_time = |at: usize| labels[at].is_called_time();
    of_all(&|at| is_time(at) && labels[at].has_unit_of_time())
        .or_else(|| of_all(&|at| is_time(at) && is_stamp(at)))
        .or_else(|| of_all(&is_time))
        .or_else(|| of_all(&|at| labels[at].is_called_timestamp()))
}

fn missing_columns(time: Option<usize>, count: usize) -> impl Iterator<Item = Fault> {
    let no_time = time.is_none().then(|| {
        of_file(
            code::NO_TIME_COLUMN,
            "no column is named t or time (or timestamp); every recording needs one, as t[s]",
        )
    });
    let no_channels = (time.is_some() && count == 1).then(|| {
        of_file(
            code::NO_CHANNELS,
            "there is no channel besides time; add a column for every recorded quantity",
        )
    });
    no_time.into_iter().chain(no_channels)
}

fn second_time_column(name: &str) -> (&'static str, String) {
    let message = format!("'{name}' is the time column already; leave one out, or rename it");
    (code::DUPLICATE_CHANNEL, message)
}

#[cfg(test)]
mod tests {
    use super::super::fault::places;
    use super::*;
    use crate::flight::Unit;

    fn parse(line: &str) -> Result<Header, IngestError> {
        let titles = Titles {
            names: line.split(',').map(str::trim).collect(),
            ..Titles::default()
        };
        Header::parse(&titles, &Limits::default())
    }

    fn column(header: &Header, at: usize) -> &Column {
        header.columns[at].as_ref().unwrap()
    }

    fn faults(line: &str) -> Vec<String> {
        places(parse(line))
    }

    #[test]
    fn time_is_found_anywhere_and_in_any_case() {
        let time = |line: &str| parse(line).unwrap().time;
        assert_eq!(time("t[s],a"), 0);
        assert_eq!(time("a, Time [ms] ,b"), 1);
        assert_eq!(time("T[K],t[s],a"), 1, "the first is a temperature");
        let header = parse("a [deg],TIME[min],mach").unwrap();
        assert_eq!(column(&header, 1).unit.unit().scale, 60.0);
        assert_eq!(column(&header, 0).name, "a");
        assert_eq!(column(&header, 2).unit.unit(), Unit::NONE);
    }

    #[test]
    fn all_faults_are_reported_at_once() {
        assert_eq!(
            faults("T[K],alpha[furlong],alpha[deg],,angle of attack[deg],q{deg/s}"),
            [
                "time_unit /columns/T",
                "unknown_unit /columns/alpha",
                "duplicate_channel /columns/3",
                "empty_name /columns/4",
                "invalid_name /columns/5",
                "invalid_name /columns/6",
            ]
        );
        assert_eq!(
            faults("a b[xyz],c"),
            [
                "no_time_column ",
                "invalid_name /columns/1",
                "unknown_unit /columns/1"
            ]
        );
        assert_eq!(faults("t[s]"), ["no_channels "]);
        assert_eq!(faults("t,a"), ["time_unit /columns/t"]);
        assert_eq!(faults("t[s],a,t[s]"), ["duplicate_channel /columns/3"]);
        assert_eq!(faults("time[s],t"), ["invalid_name /columns/t"]);
        assert_eq!(faults("t[s],alpha[deg"), ["invalid_name /columns/2"]);
        let long = format!("t[s],{}", "x".repeat(1000));
        assert_eq!(faults(&long), ["name_too_long /columns/2"]);
    }

    #[test]
    fn a_unit_in_braces_gets_the_right_advice() {
        let error = parse("t[s],alpha {deg}").err().unwrap();
        assert!(error.to_string().contains("write 'alpha[deg]'"), "{error}");
    }

    #[test]
    fn units_may_stand_in_a_row_and_time_may_be_stamps() {
        let titled = |names: &str, units: &str, first: &str| {
            let cells = |line: &'static str| line.split(';').collect::<Vec<_>>();
            let leak = |text: &str| cells(Box::leak(text.to_string().into_boxed_str()));
            let titles = Titles {
                names: leak(names),
                units: (!units.is_empty()).then(|| leak(units)),
                first: leak(first),
            };
            Header::parse(&titles, &Limits::default())
        };
        let header = titled("t;alpha;mach", "ms;deg;", "0;1;2").unwrap();
        assert_eq!(column(&header, 0).unit.unit().scale, 1e-3);
        assert_eq!(column(&header, 1).unit, RecordedUnit::parse("deg").unwrap());
        assert!(!header.has_stamps);
        let conflict = places(titled("t;alpha[rad]", "s;deg", "0;1"));
        assert_eq!(conflict, ["unit_conflict /columns/alpha"]);

        let header = titled("T[K];time;a", "", "300;12:00:00.5;1").unwrap();
        assert_eq!((header.time, header.has_stamps), (1, true));
        assert_eq!(column(&header, 1).unit.unit(), Unit::parse("s").unwrap());
        let header = titled("timestamp;a", "UTC;deg", "2026-11-21T12:00:00Z;1").unwrap();
        assert!(header.has_stamps);
        let kelvin = places(titled("t[K];a", "", "12:00:00;1"));
        assert_eq!(kelvin, ["time_unit /columns/t"]);
        assert_eq!(titled("t[s];timestamp[ms]", "", "0;1").unwrap().time, 0);
    }
}
