//! Several recordings of one flight become one: every channel keeps its samples, at the times of its file.

use indexmap::IndexMap;

use super::name::Names;
use super::text::quoted;
use super::union::Union;
use super::{IngestError, Limits, Origin, Reading, code, note};
use crate::flight::{Fault, Finding, FindingCode, Maneuver, escape};

/// A file of several that are one recording.
pub struct Part {
    /// What the file is called.
    pub name: String,
    /// What was read of it.
    pub reading: Reading,
    /// Seconds that are added to its times, once the zeros of the files are put together. It must be said where their clocks
    /// are of different kinds.
    pub offset: Option<f64>,
}

/// Puts recordings together, on the time of the first. A name that is taken gets that of the file behind it. Nothing is
/// interpolated: a channel has no value at the times of the others.
///
/// # Errors
/// The clocks are of different kinds and no offset is said; a file has no time in common with any other; there is more than
/// the limits allow.
pub fn join(parts: Vec<Part>, limits: &Limits) -> Result<Reading, IngestError> {
    let shifts = shifts(&parts)?;
    let axes: Vec<Vec<f64>> = (parts.iter().zip(&shifts))
        .map(|(part, shift)| {
            part.reading
                .maneuver
                .time()
                .iter()
                .map(|time| time + shift)
                .collect()
        })
        .collect();
    IngestError::refuse(apart(&parts, &axes))?;
    let columns: usize = parts
        .iter()
        .map(|part| part.reading.maneuver.channels().len())
        .sum();
    limits.columns(columns + 1).map_or(Ok(()), Err)?;
    let union = Union::of(&axes, limits)?;
    let values = union.time.len().saturating_mul(columns);
    limits.values(values).map_or(Ok(()), Err)?;
    let origin = parts.first().and_then(|part| part.reading.origin);
    let mut findings: Vec<Finding> = one_clock(&parts).into_iter().collect();
    let mut names = Names::new(limits);
    let mut channels = IndexMap::with_capacity(columns);
    let mut renamed = Vec::new();
    for (axis, part) in parts.into_iter().enumerate() {
        let of_file = part.reading.findings.into_iter();
        findings.extend(of_file.map(|finding| Finding {
            message: format!("{}: {}", part.name, finding.message),
            ..finding
        }));
        for (name, channel) in part.reading.maneuver.channels() {
            let free = match names.take(name) {
                Ok(()) => name.clone(),
                Err(_) => {
                    let stem = part.name.split('.').next().unwrap_or_default();
                    let free = names.take_like(&format!("{name}_{stem}"));
                    renamed.push((format!("{}/{name}", part.name), free.clone()));
                    free
                }
            };
            let mut channel = channel.clone();
            channel.values = union.spread(axis, &channel.values);
            channels.insert(free, channel);
        }
    }
    findings.extend(note::renamed(&renamed));
    let maneuver = Maneuver::new(union.time, channels);
    let maneuver = maneuver
        .map_err(|error| Fault::new("", super::axis::code_of(&error), error.to_string()))?;
    Ok(Reading {
        maneuver,
        findings,
        origin,
    })
}

/// What is added to the times of each file.
fn shifts(parts: &[Part]) -> Result<Vec<f64>, IngestError> {
    let first = parts.first().and_then(|part| part.reading.origin);
    let mut faults = Vec::new();
    let mut shifts = Vec::new();
    for part in parts {
        let origin = part.reading.origin;
        let since = origin
            .zip(first)
            .and_then(|(origin, first)| origin.since(first));
        let offset = part.offset.unwrap_or(0.0);
        if !offset.is_finite() {
            faults.push(fault(part, "its offset is a number of seconds".to_string()));
        }
        match since {
            Some(since) => shifts.push(since + offset),
            None if part.offset.is_some() => shifts.push(offset),
            None => {
                let name = |origin: Option<Origin>| {
                    origin.map_or("dates whose day and month are not clear", Origin::name)
                };
                let message = format!(
                    "its times are {} and those of {} {}: say what is added to its times, as {{{}: 0.12}} under offsets, 0 where both begin together",
                    name(origin),
                    quoted(&parts[0].name),
                    name(first),
                    serde_json::Value::from(part.name.as_str())
                );
                faults.push(fault(part, message));
            }
        }
    }
    IngestError::refuse(faults)?;
    Ok(shifts)
}

/// Files that have no time in common with any other.
fn apart(parts: &[Part], axes: &[Vec<f64>]) -> Vec<Fault> {
    let ends: Vec<Option<(f64, f64)>> = (axes.iter())
        .map(|axis| Some((*axis.first()?, *axis.last()?)))
        .collect();
    let meets = |at: usize| {
        let others = ends.iter().enumerate().filter(|(other, _)| *other != at);
        let mut others = others.filter_map(|(_, ends)| *ends);
        ends[at].is_some_and(|(from, to)| others.any(|(begin, end)| begin <= to && from <= end))
    };
    let apart = parts
        .iter()
        .enumerate()
        .filter(|(at, _)| parts.len() > 1 && !meets(*at));
    apart
        .map(|(at, part)| {
            let (from, to) = ends[at].unwrap_or_default();
            let message = format!(
                "it goes from {from} s to {to} s of the first file's time and has none in common with the others; say what is added to its times under offsets, or send it as a recording of its own"
            );
            fault(part, message)
        })
        .collect()
}

fn fault(part: &Part, message: String) -> Fault {
    let place = format!("/files/{}", escape(&part.name));
    Fault::new(
        place,
        code::OTHER_CLOCK,
        format!("{}: {message}", quoted(&part.name)),
    )
}

/// That the files' own seconds are taken for those of one clock.
fn one_clock(parts: &[Part]) -> Option<Finding> {
    let is_silent =
        |part: &&Part| part.offset.is_none() && part.reading.origin.is_some_and(Origin::is_own);
    let silent: Vec<String> = parts
        .iter()
        .filter(is_silent)
        .map(|part| quoted(&part.name))
        .collect();
    let message = format!(
        "the times of {} are seconds without a date: they are taken for those of one clock",
        note::listed(silent.iter().cloned())
    );
    let remedy = "say an offset where the clocks differ; it can be estimated as a delay of the channels, too";
    (silent.len() > 1).then(|| note::note(FindingCode::Recognised, message, remedy))
}

#[cfg(test)]
mod tests {
    use super::super::{Format, fault::places, read_recording};
    use super::*;

    fn part(name: &str, text: &str, offset: Option<f64>) -> Part {
        let limits = Limits::default();
        let reading = read_recording(text.as_bytes(), Format::Csv, None, None, &limits);
        Part {
            name: name.to_string(),
            reading: reading.unwrap_or_else(|error| panic!("{name}: {error}")),
            offset,
        }
    }

    fn joined(parts: Vec<Part>) -> Result<Reading, IngestError> {
        join(parts, &Limits::default())
    }

    fn known(reading: &Reading, name: &str) -> Vec<(f64, f64)> {
        let times = reading
            .maneuver
            .time()
            .iter()
            .map(|time| (time * 1e6).round() / 1e6);
        let values = reading.maneuver.channels()[name].values.iter().copied();
        times
            .zip(values)
            .filter(|(_, value)| !value.is_nan())
            .collect()
    }

    const IMU: &str =
        "time,q[rad/s],T[K]\n12:00:00.00,1,300\n12:00:00.02,2,300\n12:00:00.04,3,300\n";
    const AIR: &str = "time,alpha[rad],T[K]\n12:00:00.03,7,280\n12:00:00.13,8,281\n";

    #[test]
    fn files_are_put_together_by_their_stamps() {
        let reading = joined(vec![part("imu.csv", IMU, None), part("air.csv", AIR, None)]).unwrap();
        assert_eq!(known(&reading, "q"), [(0.0, 1.0), (0.02, 2.0), (0.04, 3.0)]);
        assert_eq!(known(&reading, "alpha"), [(0.03, 7.0), (0.13, 8.0)]);
        assert_eq!(known(&reading, "T_air"), [(0.03, 280.0), (0.13, 281.0)]);
        let codes: Vec<&str> = reading
            .findings
            .iter()
            .map(|finding| finding.code.as_str())
            .collect();
        assert_eq!(codes, ["renamed"]);
        // a clock that is off
        let late = joined(vec![
            part("imu.csv", IMU, None),
            part("air.csv", AIR, Some(-0.01)),
        ])
        .unwrap();
        assert_eq!(known(&late, "alpha"), [(0.02, 7.0), (0.12, 8.0)]);
        // the earlier one second: the first keeps its zero
        let back = joined(vec![part("air.csv", AIR, None), part("imu.csv", IMU, None)]).unwrap();
        assert_eq!(known(&back, "q"), [(-0.03, 1.0), (-0.01, 2.0), (0.01, 3.0)]);
    }

    #[test]
    fn seconds_are_those_of_one_clock_and_this_is_said() {
        let own = |from: f64| format!("t[s],a{}[rad]\n{},1\n{},2\n", from as i32, from, from + 1.0);
        let reading = joined(vec![
            part("a.csv", &own(5.0), None),
            part("b.csv", &own(5.5), None),
        ])
        .unwrap();
        assert_eq!(reading.maneuver.time(), [5.0, 5.5, 6.0, 6.5]);
        assert!(reading.findings[0].message.contains("one clock"));
        let one = [
            part("a.csv", &own(5.0), None),
            part("b.csv", &own(5.5), Some(0.0)),
        ];
        let said = joined(one.into_iter().collect()).unwrap();
        assert_eq!(said.maneuver, reading.maneuver);
        assert!(
            said.findings
                .iter()
                .all(|finding| !finding.message.contains("one clock"))
        );
        let apart = joined(vec![
            part("a.csv", &own(5.0), None),
            part("b.csv", &own(50.0), None),
        ]);
        assert_eq!(
            places(apart),
            ["other_clock /files/a.csv", "other_clock /files/b.csv"]
        );
    }

    #[test]
    fn other_clocks_need_an_offset() {
        let own = "t[s],alpha[rad]\n0.5,7\n0.6,8\n";
        let refused = joined(vec![part("imu.csv", IMU, None), part("air.csv", own, None)]);
        assert_eq!(places(refused), ["other_clock /files/air.csv"]);
        let reading = joined(vec![
            part("imu.csv", IMU, None),
            part("air.csv", own, Some(-0.5)),
        ])
        .unwrap();
        assert_eq!(known(&reading, "alpha"), [(0.0, 7.0), (0.1, 8.0)]);
        let epochs = "t[s],alpha[rad]\n1795255200.0,7\n1795255200.1,8\n";
        let zulu = "time,q[rad/s]\n2026-11-21T10:00:00.05Z,1\n2026-11-21T10:00:00.15Z,2\n";
        let reading = joined(vec![part("a.csv", epochs, None), part("b.csv", zulu, None)]).unwrap();
        assert_eq!(known(&reading, "q"), [(0.05, 1.0), (0.15, 2.0)]);
        let weeks = "GPS Week,TOW (s),a[m]\n2300,604799.75,1\n2301,0.25,2\n";
        let more = "GPS Week,TOW (s),b[m]\n2301,0,1\n2301,0.5,2\n";
        let reading = joined(vec![part("a.csv", weeks, None), part("b.csv", more, None)]).unwrap();
        let times: Vec<f64> = reading
            .maneuver
            .time()
            .iter()
            .map(|time| time - 604_799.75)
            .collect();
        assert_eq!(times, [0.0, 0.25, 0.5, 0.75]);
    }

    #[test]
    fn limits_hold_for_all_files_together() {
        let limits = Limits {
            max_samples: 4,
            ..Limits::default()
        };
        let refused = join(
            vec![part("imu.csv", IMU, None), part("air.csv", AIR, None)],
            &limits,
        );
        assert_eq!(places(refused), ["too_many_samples "]);
    }
}
