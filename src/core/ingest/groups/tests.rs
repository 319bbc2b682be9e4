//! Groups that a program makes.

use super::super::fault::places;
use super::super::mapping::Mapping;
use super::super::{IngestError, Limits, Reading};
use super::*;
use crate::flight::Fault;

struct Made(Vec<Vec<f64>>);

impl Samples for Made {
    fn values(&mut self, at: usize) -> Result<Vec<f64>, Fault> {
        Ok(self.0[at].clone())
    }
}

fn channel(name: &str, unit: &str, at: usize) -> Channel {
    Channel {
        name: name.to_string(),
        unit: unit.to_string(),
        at,
    }
}

fn group(name: &str, rows: usize, time: Time, channels: Vec<Channel>) -> Group {
    Group {
        name: name.to_string(),
        rows,
        said: rows,
        time,
        channels,
    }
}

fn two_rates(times: &[f64]) -> Groups<Made> {
    let fast = Time::Even {
        start: 0.0,
        step: 0.1,
    };
    let of_fast = vec![channel("q", "deg/s", 0), channel("Alpha (vane)", "deg", 0)];
    let of_slow = vec![
        channel("q", "", 1),
        channel("T [K]", "", 1),
        channel("x", "warp", 1),
    ];
    Groups {
        groups: vec![
            group("IMU", 4, fast, of_fast),
            group("Air Data", 2, Time::Recorded(2), of_slow),
            group("Notes", 9, Time::Unknown, vec![channel("n", "", 0)]),
        ],
        samples: Made(vec![
            vec![1.0, 2.0, 3.0, 4.0],
            vec![5.0, 6.0],
            times.to_vec(),
        ]),
        left_out: vec![("text".to_string(), "it holds words".to_string())],
    }
}

fn reading(mapping: Option<&Mapping>) -> Result<Reading, IngestError> {
    read(two_rates(&[0.05, 0.2]), mapping, &Limits::default())
}

#[test]
fn groups_of_several_rates_are_one_recording() {
    let Reading {
        maneuver, findings, ..
    } = reading(None).unwrap();
    assert_eq!(maneuver.len(), 5);
    let names: Vec<&String> = maneuver.channels().keys().collect();
    assert_eq!(names, ["q", "Alpha_vane", "Air_Data_q", "T"]);
    let slow = &maneuver.channels()["T"].values;
    let there: Vec<usize> = (0..5).filter(|&at| !slow[at].is_nan()).collect();
    assert_eq!(there, [1, 3]);
    let told = |code: &str| {
        findings
            .iter()
            .find(|finding| finding.code == code)
            .unwrap()
    };
    let left_out = &told("left_out").message;
    for expected in [
        "'text' (it holds words)",
        "'Air Data/x'",
        "'Notes/n' (the file says no times",
    ] {
        assert!(left_out.contains(expected), "{left_out}");
    }
    assert!(told("no_unit").message.contains("Air_Data_q"));
    assert!(
        told("renamed")
            .message
            .contains("'Air Data/q' is Air_Data_q")
    );
}

#[test]
fn a_mapping_names_groups_and_channels() {
    let text = r#"{"channels": {"p": {"from": "Air_Data.q", "unit": "rad/s"}, "aoa": {"from": "Alpha_vane", "unit": "deg"}}}"#;
    let Reading { maneuver, .. } = reading(Some(&Mapping::from_json(text).unwrap())).unwrap();
    assert_eq!(maneuver.channels()["p"].values[1], 5.0);
    let ambiguous = Mapping::from_json(&text.replace("Air_Data.q", "q")).unwrap();
    let error = reading(Some(&ambiguous)).unwrap_err();
    assert!(error.to_string().contains("Air_Data.q"), "{error}");
    let even = r#"{"time": {"step": 1, "unit": "s"}, "channels": {"n": {"from": "Notes.n", "unit": "-"}}}"#;
    let Reading { maneuver, .. } = reading(Some(&Mapping::from_json(even).unwrap())).unwrap();
    assert_eq!(maneuver.time()[3], 3.0);
}

#[test]
fn a_mapping_without_units_takes_those_of_the_file() {
    let text = r#"{"channels": {"aoa": {"from": "Alpha_vane"}, "T": {"from": "T_K"}}}"#;
    let Reading { maneuver, .. } = reading(Some(&Mapping::from_json(text).unwrap())).unwrap();
    assert_eq!(maneuver.channels()["aoa"].values[0], 1f64.to_radians());
    assert_eq!(maneuver.channels()["T"].recorded_unit, "K");
    // one that it says holds, and one that nobody says is asked for
    let said = text.replace(r#""Alpha_vane""#, r#""Alpha_vane", "unit": "rad""#);
    let Reading { maneuver, .. } = reading(Some(&Mapping::from_json(&said).unwrap())).unwrap();
    assert_eq!(maneuver.channels()["aoa"].values[0], 1.0);
    let silent = text.replace("Alpha_vane", "Air_Data.q");
    let error = reading(Some(&Mapping::from_json(&silent).unwrap())).unwrap_err();
    assert_eq!(error.faults()[0].pointer, "/channels/aoa/unit");
}

#[test]
fn times_increase_and_limits_hold() {
    let standing = read(two_rates(&[0.2, 0.2]), None, &Limits::default());
    assert_eq!(places(standing), ["time_not_increasing "]);
    let few = Limits {
        max_values: 11,
        ..Limits::default()
    };
    assert_eq!(
        places(read(two_rates(&[0.0, 1.0]), None, &few)),
        ["too_many_values "]
    );
    let mut silent = two_rates(&[]);
    silent.groups.drain(..2);
    assert_eq!(
        places(read(silent, None, &Limits::default())),
        ["no_time_column "]
    );
}
