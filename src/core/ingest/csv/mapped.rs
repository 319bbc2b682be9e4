//! The header of a CSV file as a mapping has it: columns under other names, in other units, or left out.

use super::super::{
    IngestError, Limits, code,
    fault::pointer,
    header::{Column, Header, Titles},
    label::Label,
    mapping::{Mapping, Part, Source},
    name::Names,
    stamp::Stamp,
    text::{quoted, short_message},
    units::RecordedUnit,
};
use crate::flight::Fault;

/// What a mapping makes of a file's titles. Its units hold against those that the file states: they may be what was to be
/// corrected. Columns that it does not name are left out, whatever is in them.
///
/// # Errors
/// Every source that the file does not have, and every fault of names and units, by its place in the mapping.
pub(super) fn header(
    mapping: &Mapping,
    titles: &Titles,
    limits: &Limits,
) -> Result<Header, IngestError> {
    let mut taken = Taken {
        labels: titles.names.iter().map(|name| Label::split(name)).collect(),
        columns: titles.names.iter().map(|_| None).collect(),
        faults: Vec::new(),
    };
    let mut has_stamps = false;
    let time = match mapping.time.from.as_deref() {
        Some(from) => taken.take(&["time"], "t", from, |at| {
            let first = titles.first.get(at);
            has_stamps = first.is_some_and(|cell| Stamp::parse(cell).is_some());
            if has_stamps {
                RecordedUnit::of_stamps(&mapping.time.unit)
            } else {
                RecordedUnit::parse_time(&mapping.time.unit)
            }
        }),
        None => {
            let message = "a CSV file has a column of time; say which with \"from\"";
            let fault = Fault::new("/time", code::INVALID_MAPPING, message);
            taken.faults.push(fault);
            None
        }
    };
    let mut names = Names::new(limits);
    for (name, channel) in &mapping.channels {
        let place = ["channels", name.as_str()];
        if let Err((code, message)) = names.take(name) {
            taken.faults.push(Fault::new(pointer(place), code, message));
            continue;
        }
        let unit = |_| RecordedUnit::parse(&channel.unit);
        taken.take(&place, name, &channel.from, unit);
    }
    if mapping.channels.is_empty() {
        let message =
            "the mapping takes no channel besides time; add every quantity that is needed";
        let fault = Fault::new("/channels", code::NO_CHANNELS, message);
        taken.faults.push(fault);
    }
    IngestError::refuse(taken.faults)?;
    Ok(Header {
        // without one there was a fault
        time: time.unwrap_or_default(),
        has_stamps,
        columns: taken.columns,
    })
}

/// The columns of the file, and what became of them.
struct Taken<'a> {
    labels: Vec<Label<'a>>,
    columns: Vec<Option<Column>>,
    faults: Vec<Fault>,
}

impl Taken<'_> {
    /// Takes a column; which it is.
    fn take(
        &mut self,
        place: &[&str],
        name: &str,
        from: &str,
        unit: impl FnOnce(usize) -> Result<RecordedUnit, (&'static str, String)>,
    ) -> Option<usize> {
        let mut refuse = |member: &str, (code, message): (&'static str, String)| {
            let place = pointer(place.iter().copied().chain([member]));
            self.faults.push(Fault::new(place, code, message));
        };
        let at = column(from, &self.labels)
            .map_err(|why| refuse("from", why))
            .ok()?;
        if let Some(other) = &self.columns[at] {
            let message = format!("column {} is '{}' already", at + 1, other.name);
            refuse("from", (code::INVALID_MAPPING, message));
            return None;
        }
        let unit = unit(at).map_err(|why| refuse("unit", why)).ok()?;
        self.columns[at] = Some(Column {
            name: name.to_string(),
            unit,
        });
        Some(at)
    }
}

/// Which column a source is: by what stands over it, its unit left out, or by its number.
fn column(from: &str, labels: &[Label]) -> Result<usize, (&'static str, String)> {
    let source: Source = from
        .parse()
        .map_err(|why: &str| (code::INVALID_MAPPING, why.to_string()))?;
    let unknown = |message: String| Err((code::UNKNOWN_SOURCE, message));
    let Source { path, part } = source;
    match part {
        Part::Column(number) if path.is_empty() && number <= labels.len() => Ok(number - 1),
        Part::Column(number) if path.is_empty() => {
            let count = labels.len();
            unknown(format!("there is no column {number}: the file has {count}"))
        }
        Part::Whole => {
            let name = path.join(".");
            let mut found = (0..labels.len()).filter(|&at| labels[at].name == name);
            match (found.next(), found.next()) {
                (Some(at), None) => Ok(at),
                (Some(_), Some(second)) => unknown(format!(
                    "{} is the title of several columns; say which by its number, as (:,{})",
                    quoted(&name),
                    second + 1
                )),
                (None, _) => {
                    let all: Vec<&str> = labels.iter().map(|label| label.name).collect();
                    let all = short_message(&all.join(", "));
                    unknown(format!(
                        "there is no column {}; there are {all}",
                        quoted(&name)
                    ))
                }
            }
        }
        _ => unknown(
            "name a column of a CSV file by its title, as alpha, or by its number, as (:,2)"
                .to_string(),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::fault::places;
    use super::super::read;
    use super::*;
    use crate::flight::Maneuver;

    fn read_as(time: &str, channels: &str, text: &str) -> Result<Maneuver, IngestError> {
        let mapping = format!(r#"{{"time": {{{time}}}, "channels": {{{channels}}}}}"#);
        let mapping = Mapping::from_json(&mapping)?;
        read(text.as_bytes(), Some(&mapping), &Limits::default())
    }

    const ZEIT: &str = r#""from": "Zeit", "unit": "ms""#;

    #[test]
    fn columns_get_names_and_units_and_others_are_left_out() {
        let text = "Zeit;angle of attack [rad];mode;q(1)\n0;1,5;approach;-2\n40;;landing;0,3\n";
        let channels =
            r#""alpha": {"from": "(:,2)", "unit": "deg"}, "q": {"from": "(:,4)", "unit": "deg/s"}"#;
        let mapped = read_as(ZEIT, channels, text).unwrap();
        let plain = "t[s],alpha[deg],q[deg/s]\n0,1.5,-2\n0.04,,0.3\n";
        let plain = read(plain.as_bytes(), None, &Limits::default()).unwrap();
        assert_eq!(mapped.digest(), plain.digest());

        let stamps = "clock,q\n12:00:00,1\n12:00:00.5,2\n";
        let time = r#""from": "clock", "unit": "s""#;
        let mapped = read_as(time, r#""q": {"from": "q", "unit": "-"}"#, stamps).unwrap();
        assert_eq!(mapped.time(), [0.0, 0.5]);
    }

    #[test]
    fn faults_stand_at_their_place_in_the_mapping() {
        let faults = |time: &str, channels: &str| {
            places(read_as(
                time,
                channels,
                "Zeit,a[deg],b,b\n0,1,2,x\n1,1,2,3\n",
            ))
        };
        let channels = r#""a": {"from": "a", "unit": "deg"}, "again": {"from": "(:,2)", "unit": "deg"},
            "b": {"from": "b", "unit": "-"}, "c": {"from": "c", "unit": "-"}, "d": {"from": "(:,9)", "unit": "-"},
            "e": {"from": "x(:,2)", "unit": "-"}, "f": {"from": "(:,3)", "unit": "furlong"}, "g h": {"from": "b", "unit": "-"}"#;
        assert_eq!(
            faults(ZEIT, channels),
            [
                "invalid_mapping /channels/again/from",
                "unknown_source /channels/b/from",
                "unknown_source /channels/c/from",
                "unknown_source /channels/d/from",
                "unknown_source /channels/e/from",
                "unknown_unit /channels/f/unit",
                "invalid_name /channels/g h",
            ]
        );
        let a = r#""a": {"from": "a", "unit": "deg"}"#;
        let step = r#""step": 0.1, "unit": "s""#;
        assert_eq!(faults(step, a), ["invalid_mapping /time"]);
        let metres = r#""from": "Zeit", "unit": "m""#;
        assert_eq!(
            faults(metres, ""),
            ["time_unit /time/unit", "no_channels /channels"]
        );
        let last = r#""q": {"from": "(:,4)", "unit": "-"}"#;
        assert_eq!(faults(ZEIT, last), ["not_a_number /rows/1/q"]);
    }
}
