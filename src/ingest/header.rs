//! The header of a CSV file: which column is time, and name and unit of every other.

use std::collections::HashSet;

use crate::flight::{Fault, Unit};

use super::{
    IngestError, Limits, code,
    fault::of_file,
    fault::pointer,
    name::{Names, is_identifier},
    text::quoted,
    units::RecordedUnit,
};

/// A header without faults.
pub(super) struct Header {
    /// Which of the columns is time, from 0.
    pub(super) time: usize,
    /// All columns, time included.
    pub(super) columns: Vec<Column>,
}

pub(super) struct Column {
    pub(super) name: String,
    pub(super) unit: RecordedUnit,
}

impl Header {
    /// Reads cells like `alpha[deg]`, `alpha [deg]`, or `mach` for a pure number.
    ///
    /// # Errors
    /// Every fault of the header.
    pub(super) fn parse(cells: &[&str], limits: &Limits) -> Result<Self, IngestError> {
        let labels: Vec<Label> = cells.iter().map(|cell| Label::split(cell)).collect();
        let time = time_column(&labels);
        let mut faults: Vec<Fault> = missing_columns(time, labels.len()).collect();
        let mut names = Names::new(limits);
        let mut pointed_at = HashSet::new();
        let mut columns = Vec::with_capacity(labels.len());

        for (at, label) in labels.iter().enumerate() {
            let (name_fault, unit) = if time == Some(at) {
                (None, RecordedUnit::parse_time(label.unit))
            } else {
                let is_second_time = time.is_some_and(|time| labels[time].name == label.name);
                let name_fault = if is_second_time {
                    Some(second_time_column(label.name))
                } else {
                    label.check_name(&mut names).err()
                };
                (name_fault, RecordedUnit::parse(label.unit))
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
                Ok(unit) => columns.push(Column {
                    name: label.name.to_string(),
                    unit,
                }),
                Err(why) => report(why),
            }
        }

        IngestError::refuse(faults)?;
        Ok(Self {
            // Without a time column there was a fault.
            time: time.unwrap_or_default(),
            columns,
        })
    }
}

/// A header cell in its two parts.
struct Label<'a> {
    name: &'a str,
    unit: &'a str,
}

impl<'a> Label<'a> {
    fn split(cell: &'a str) -> Self {
        let (name, unit) = cell
            .strip_suffix(']')
            .and_then(|open| open.split_once('['))
            .unwrap_or((cell, ""));
        Self {
            name: name.trim(),
            unit: unit.trim(),
        }
    }

    fn check_name(&self, names: &mut Names) -> Result<(), (&'static str, String)> {
        let Some(instead) = self.unit_in_other_brackets() else {
            return names.take(self.name);
        };
        let message = format!(
            "{} does not have its unit in square brackets; write {}",
            quoted(self.name),
            quoted(&instead)
        );
        Err((code::INVALID_NAME, message))
    }

    /// `alpha (deg)` is usual elsewhere; what it would be here.
    fn unit_in_other_brackets(&self) -> Option<String> {
        let (name, unit) = [('(', ')'), ('{', '}')]
            .into_iter()
            .find_map(|(from, to)| {
                let open = self.name.strip_suffix(to)?;
                open.split_once(from)
            })?;
        let is_label = is_identifier(name.trim()) && Unit::parse(unit).is_ok();
        is_label.then(|| format!("{}[{}]", name.trim(), unit.trim()))
    }

    fn is_called_time(&self) -> bool {
        self.name.eq_ignore_ascii_case("t") || self.name.eq_ignore_ascii_case("time")
    }

    fn has_unit_of_time(&self) -> bool {
        RecordedUnit::parse(self.unit).is_ok_and(|unit| unit.is_of_time())
    }
}

/// The first column called t or time. `T[K]` before `t[s]` is a temperature: one with a unit of time
/// goes first.
fn time_column(labels: &[Label]) -> Option<usize> {
    let mut candidates = (0..labels.len()).filter(|&at| labels[at].is_called_time());
    candidates
        .clone()
        .find(|&at| labels[at].has_unit_of_time())
        .or_else(|| candidates.next())
}

fn missing_columns(time: Option<usize>, count: usize) -> impl Iterator<Item = Fault> {
    let no_time = time.is_none().then(|| {
        of_file(
            code::NO_TIME_COLUMN,
            "no column is named t or time; every recording needs one, as t[s]",
        )
    });
    let no_channels = (time.is_some() && count == 1).then(|| {
        of_file(
            code::NO_CHANNELS,
            "there is no channel beside time; add a column for every recorded quantity",
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

    fn parse(line: &str) -> Result<Header, IngestError> {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        Header::parse(&cells, &Limits::default())
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
        assert_eq!(header.columns[1].unit.unit().scale, 60.0);
        assert_eq!(header.columns[0].name, "a");
        assert_eq!(header.columns[2].unit.unit(), Unit::NONE);
    }

    #[test]
    fn all_faults_are_reported_at_once() {
        assert_eq!(
            faults("T[K],alpha[furlong],alpha[deg],,angle of attack[deg],q(deg/s)"),
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
    fn a_unit_in_round_brackets_gets_the_right_advice() {
        let error = parse("t[s],alpha (deg)").err().unwrap();
        assert!(error.to_string().contains("write 'alpha[deg]'"), "{error}");
    }
}
