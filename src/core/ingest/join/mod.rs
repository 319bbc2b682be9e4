//! Several recordings of one flight become one: every channel keeps its samples, at the times of its file.

mod clocks;
mod part;

use indexmap::IndexMap;

use super::name::Names;
use super::union::Union;
use super::{IngestError, Limits, Reading, note};
use crate::flight::{Fault, Finding, Maneuver};
use clocks::{apart, axes, one_clock, one_zone};
pub use part::Part;

/// That files are not too much together, as far as they are read.
///
/// # Errors
/// There are more channels or values than the limits allow.
pub fn check_together(parts: &[Part], limits: &Limits) -> Result<(), IngestError> {
    let maneuvers = parts.iter().map(|part| &part.reading.maneuver);
    let columns = maneuvers.clone().map(|maneuver| maneuver.channels().len());
    let values = maneuvers.map(|maneuver| maneuver.len() * maneuver.channels().len());
    let too_much = [
        limits.columns(columns.sum::<usize>() + 1),
        limits.values(values.sum()),
    ];
    IngestError::refuse(too_much.into_iter().flatten().collect())
}

/// Puts recordings together, on the time of the first. A name that is taken gets that of the file behind it. Nothing is
/// interpolated: a channel has no value at the times of the others.
///
/// # Errors
/// The clocks are of different kinds and no offset is said; a file has no time in common with the others; there is more than
/// the limits allow.
pub fn join(parts: Vec<Part>, limits: &Limits) -> Result<Reading, IngestError> {
    check_together(&parts, limits)?;
    let axes = axes(&parts)?;
    IngestError::refuse(apart(&parts, &axes))?;
    let union = Union::of(&axes, limits)?;
    let channels = parts
        .iter()
        .map(|part| part.reading.maneuver.channels().len());
    let values = union.time.len().saturating_mul(channels.sum());
    limits.values(values).map_or(Ok(()), Err)?;
    let origin = parts.first().and_then(|part| part.reading.origin);
    let mut findings: Vec<Finding> = one_clock(&parts).into_iter().collect();
    findings.extend(one_zone(&parts));
    let mut names = Names::new(limits);
    let mut channels = IndexMap::new();
    let mut renamed = Vec::new();
    for (axis, part) in parts.into_iter().enumerate() {
        let called = free_names(&part, &mut names);
        for (name, channel) in part.reading.maneuver.channels() {
            let free = &called[name];
            if free != name {
                renamed.push((format!("{}/{name}", part.name), free.clone()));
            }
            let mut channel = channel.clone();
            channel.values = union.spread(axis, &channel.values);
            channels.insert(free.clone(), channel);
        }
        let of_file = part.reading.findings.into_iter();
        findings.extend(of_file.map(|finding| Finding {
            message: format!("{}: {}", part.name, finding.message),
            channel: (finding.channel).map(|name| called.get(&name).cloned().unwrap_or(name)),
            ..finding
        }));
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

/// What the channels of a file are called in the recording, by their names in the file.
fn free_names(part: &Part, names: &mut Names) -> IndexMap<String, String> {
    let file = part.name.rsplit(['/', '\\']).next().unwrap_or_default();
    let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    let mut free = |name: &String| match names.take(name) {
        Ok(()) => name.clone(),
        Err(_) => names.take_like(&format!("{name}_{stem}")),
    };
    let all = part.reading.maneuver.channels().keys();
    all.map(|name| (name.clone(), free(name))).collect()
}

#[cfg(test)]
mod tests {
    use super::super::stamp::ClockKind;
    use super::super::{Format, Origin, fault::places, read_recording};
    use super::*;
    use crate::flight::FindingCode;

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
        assert_eq!(said.maneuver.digest(), reading.maneuver.digest());
        assert!(
            said.findings
                .iter()
                .all(|finding| !finding.message.contains("one clock"))
        );
        let apart = joined(vec![
            part("a.csv", &own(5.0), None),
            part("b.csv", &own(50.0), None),
        ]);
        assert_eq!(places(apart), ["other_clock /files/b.csv"]);
        // two that meet each other, and not the first
        let apart = joined(vec![
            part("a.csv", &own(5.0), None),
            part("b.csv", &own(50.0), None),
            part("c.csv", &own(50.5), None),
            part("d.csv", &own(4.5), None),
        ]);
        assert_eq!(
            places(apart),
            ["other_clock /files/b.csv", "other_clock /files/c.csv"]
        );
        // one of which each meets the next
        let chain = [2.8, 0.0, 1.9, 1.0].map(|from| part("x.csv", &own(from), None));
        let times = joined(chain.into_iter().collect()).unwrap();
        assert_eq!(times.maneuver.len(), 7, "1.0 is of two files");
    }

    #[test]
    fn instants_of_typed_tables_are_taken_for_utc_and_this_is_said() {
        let zulu = "time,q[rad/s]\n2026-11-21T10:00:00.05Z,1\n2026-11-21T10:00:00.15Z,2\n";
        let typed = |offset| {
            let mut typed = part("b.parquet", "t[s],alpha[rad]\n0,7\n0.1,8\n", offset);
            // 2026-11-21T10:00:00Z
            let instant = Origin::at(ClockKind::Instant, 1_795_255_200_000_000_000);
            typed.reading.origin = Some(instant);
            typed
        };
        let told = |offset| {
            let reading = joined(vec![part("a.csv", zulu, None), typed(offset)]).unwrap();
            let findings = reading.findings.iter();
            let count = findings.filter(|finding| finding.message.contains("for UTC"));
            (known(&reading, "alpha"), count.count())
        };
        assert_eq!(told(None), (vec![(-0.05, 7.0), (0.05, 8.0)], 1));
        assert_eq!(told(Some(0.0)), (vec![(-0.05, 7.0), (0.05, 8.0)], 0));
        let alike = joined(vec![typed(None), typed(None)]).unwrap();
        let codes = alike.findings.iter().map(|finding| finding.code.as_str());
        assert_eq!(codes.collect::<Vec<_>>(), ["renamed"]);
    }

    #[test]
    fn offsets_that_swallow_the_times_are_refused() {
        let own = "t[s],a[rad]\n0,1\n0.001,2\n";
        let far = [("a.csv", 1e15), ("b.csv", 1e15)].map(|(name, by)| part(name, own, Some(by)));
        let refused = joined(far.into_iter().collect());
        assert_eq!(
            places(refused),
            ["other_clock /files/a.csv", "other_clock /files/b.csv"]
        );
    }

    #[test]
    fn a_finding_of_a_file_names_the_channel_as_it_is_called_here() {
        let mut second = part("in/air.v2.csv", AIR, None);
        let told = Finding {
            channel: Some("T".to_string()),
            ..note::note(FindingCode::LeftOut, "odd".to_string(), "look at it")
        };
        second.reading.findings.push(told);
        let reading = joined(vec![part("in/imu.csv", IMU, None), second]).unwrap();
        let channels: Vec<&String> = reading.maneuver.channels().keys().collect();
        assert_eq!(channels, ["q", "T", "alpha", "T_air_v2"]);
        let finding = &reading.findings[0];
        assert_eq!(finding.channel.as_deref(), Some("T_air_v2"));
        assert_eq!(finding.message, "in/air.v2.csv: odd");
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
        // minutes since 1970; the same moment, half a minute later
        let minutes = "t[min],alpha[rad]\n29920920.0,7\n29920921.0,8\n";
        let zulu = "time,q[rad/s]\n2026-11-21T10:00:30Z,1\n2026-11-21T10:01:30Z,2\n";
        let reading = joined(vec![
            part("a.csv", minutes, None),
            part("b.csv", zulu, None),
        ])
        .unwrap();
        assert_eq!(known(&reading, "q"), [(30.0, 1.0), (90.0, 2.0)]);
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
        // six values and four, before they are put together
        let limits = Limits {
            max_values: 9,
            ..Limits::default()
        };
        let parts = [part("imu.csv", IMU, None), part("air.csv", AIR, None)];
        assert!(check_together(&parts[..1], &limits).is_ok());
        assert_eq!(
            places(check_together(&parts, &limits)),
            ["too_many_values "]
        );
    }
}
