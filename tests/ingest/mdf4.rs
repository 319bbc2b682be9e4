//! MDF 4 files; `recordings/make_mdf.py` says what is in each.

use trimtab_core::flight::{Finding, Maneuver};
use trimtab_core::ingest::{Format, IngestError, Limits, Mapping, Reading, code, read_recording};

use crate::common::repository;

fn bytes(name: &str) -> Vec<u8> {
    let path = repository::path(&format!("tests/ingest/recordings/{name}.mf4"));
    std::fs::read(path).expect("a recording")
}

fn read(bytes: &[u8], mapping: Option<&Mapping>) -> Result<Reading, IngestError> {
    read_recording(bytes, Format::Unstated, None, mapping, &Limits::default())
}

fn reading(name: &str) -> Reading {
    read(&bytes(name), None).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The values that there are.
fn known(maneuver: &Maneuver, name: &str) -> Vec<f64> {
    let values = maneuver.channels()[name].values.iter();
    values.copied().filter(|value| !value.is_nan()).collect()
}

fn degrees(maneuver: &Maneuver, name: &str) -> Vec<f64> {
    let rounded = |value: f64| (value.to_degrees() * 1e9).round() / 1e9;
    known(maneuver, name).into_iter().map(rounded).collect()
}

#[test]
fn channels_say_their_units_and_groups_their_times() {
    let Reading {
        maneuver, findings, ..
    } = reading("groups");
    assert_eq!(maneuver.len(), 6, "two rates, of which one time is one");
    assert_eq!(degrees(&maneuver, "alpha"), [1.5, 2.5, 3.5, 4.5]);
    assert_eq!(degrees(&maneuver, "q"), [10.0, -20.0, 30.0, -40.0, 50.0]);
    assert_eq!(known(&maneuver, "gear"), [1.0, 0.0, 1.0, 0.0, 1.0]);
    assert_eq!(
        known(&maneuver, "stick_force"),
        [0.0, 5.0, 10.0, 11.0, 12.0]
    );
    assert_eq!(
        known(&maneuver, "V"),
        [10.0, -20.0, -40.0, 50.0],
        "one is invalid"
    );
    assert_eq!(known(&maneuver, "mass"), [100.0, 99.5]);
    let left_out = findings.iter().find(|finding| finding.code == "left_out");
    let message = &left_out.unwrap().message;
    assert!(
        message.contains("'IMU/phase' (it does not hold numbers"),
        "{message}"
    );
}

#[test]
fn packed_data_are_unpacked() {
    for name in ["deflated", "transposed"] {
        let Reading { maneuver, .. } = reading(name);
        assert_eq!(maneuver.len(), 3000, "{name}");
        let alpha = degrees(&maneuver, "alpha");
        let expected = |k: usize| (maneuver.time()[k] * 2.0).round_ties_even();
        assert!((0..3000).all(|k| alpha[k] == expected(k)), "{name}");
        let limits = Limits {
            max_bytes: 20_000,
            ..Limits::default()
        };
        let refused = read_recording(&bytes(name), Format::Unstated, None, None, &limits);
        assert_eq!(
            refused.unwrap_err().faults()[0].code,
            code::UNPACKED_TOO_LARGE
        );
    }
}

#[test]
fn records_of_several_kinds_may_stand_between_each_other() {
    let Reading { maneuver, .. } = reading("unsorted");
    assert_eq!(degrees(&maneuver, "alpha"), [1.5, 2.5, 3.5, 4.5]);
    assert_eq!(degrees(&maneuver, "q"), [10.0, -20.0, 30.0, -40.0, 50.0]);
    assert_eq!(known(&maneuver, "mass"), [100.0, 97.0]);
    assert_eq!(maneuver.len(), 7);
    let text = r#"{"channels": {"m": {"from": "Fuel.mass", "unit": "kg"}, "rate": {"from": "q", "unit": "rad/s"}}}"#;
    let mapping = Mapping::from_json(text).unwrap();
    let Reading { maneuver, .. } = read(&bytes("unsorted"), Some(&mapping)).unwrap();
    assert_eq!(known(&maneuver, "rate")[4], 50.0);
    assert_eq!(known(&maneuver, "m"), [100.0, 97.0]);
}

#[test]
fn what_a_table_of_texts_converts_are_numbers() {
    // as asammdf reads them
    let Reading {
        maneuver, findings, ..
    } = reading("texts");
    assert_eq!(maneuver.len(), 5);
    assert_eq!(degrees(&maneuver, "alpha"), [-4.0, -3.0, -2.0]);
    assert_eq!(degrees(&maneuver, "beta"), [3.0, 5.0, 7.0]);
    assert!(findings.is_empty(), "{findings:?}");
}

#[test]
fn a_file_that_is_cut_off_has_what_is_there() {
    let mut bytes = bytes("groups");
    let of_group = memmem(&bytes, b"##CG");
    // behind the head, six links and the number of its records; it has five
    let count = of_group + 24 + 6 * 8 + 8;
    assert_eq!(bytes[count..count + 8], 5u64.to_le_bytes());
    bytes[count] = 50;
    let Reading {
        maneuver, findings, ..
    } = read(&bytes, None).unwrap();
    assert_eq!(degrees(&maneuver, "q"), [10.0, -20.0, 30.0, -40.0, 50.0]);
    let cut_off = |findings: &[Finding]| {
        let found = findings.iter().find(|finding| finding.code == "cut_off");
        found.map(|finding| finding.message.clone())
    };
    let told = cut_off(&findings).expect("it is told");
    assert!(told.contains("'IMU' has 5 of 50 samples"), "{told}");
    let text = r#"{"channels": {"q": {"from": "IMU.q", "unit": "deg/s"}}}"#;
    let mapping = Mapping::from_json(text).unwrap();
    let Reading {
        maneuver, findings, ..
    } = read(&bytes, Some(&mapping)).unwrap();
    assert_eq!(maneuver.len(), 5);
    assert_eq!(cut_off(&findings), Some(told));
    let whole = reading("groups").findings;
    assert_eq!(cut_off(&whole), None);
}

/// Records of several kinds between each other: how many there are is known only when they are read.
#[test]
fn an_unsorted_file_that_is_cut_off_says_so_with_a_mapping_too() {
    let mut bytes = bytes("unsorted");
    let groups: Vec<usize> = (0..bytes.len())
        .filter(|&at| bytes[at..].starts_with(b"##CG"))
        .collect();
    let count = |of: &usize| of + 24 + 6 * 8 + 8;
    let of_five = groups.iter().map(count).find(|&at| bytes[at] == 5);
    let of_five = of_five.expect("a group of five records");
    assert_eq!(bytes[of_five..of_five + 8], 5u64.to_le_bytes());
    bytes[of_five] = 50;
    let cut_off = |mapping: Option<&Mapping>| {
        let Reading { findings, .. } = read(&bytes, mapping).unwrap();
        let found = findings
            .into_iter()
            .find(|finding| finding.code == "cut_off");
        found.map(|finding| finding.message)
    };
    let told = cut_off(None).expect("it is told");
    assert!(told.contains("has 5 of 50 samples"), "{told}");
    let text = r#"{"channels": {"rate": {"from": "q", "unit": "rad/s"}}}"#;
    assert_eq!(
        cut_off(Some(&Mapping::from_json(text).unwrap())),
        Some(told)
    );
    // what is not asked for is not looked at
    let text = r#"{"channels": {"m": {"from": "Fuel.mass", "unit": "kg"}}}"#;
    assert_eq!(cut_off(Some(&Mapping::from_json(text).unwrap())), None);
}

fn memmem(bytes: &[u8], part: &[u8]) -> usize {
    let mut windows = bytes.windows(part.len());
    windows
        .position(|window| window == part)
        .expect("it is there")
}

#[test]
fn what_is_not_read_says_so() {
    for (bytes, code, expected) in [
        (
            &b"MDF     3.30    x\0\0"[..],
            code::FORMAT_NOT_READ,
            "MDF 3",
        ),
        (
            b"MDF     4.10    x\0\0",
            code::DAMAGED_FILE,
            "copy it again",
        ),
    ] {
        let error = read(bytes, None).unwrap_err();
        let fault = &error.faults()[0];
        assert_eq!(fault.code, code);
        assert!(fault.message.contains(expected), "{fault}");
    }
    let max_samples = 4;
    let limits = Limits {
        max_samples,
        ..Limits::default()
    };
    let refused = read_recording(&bytes("groups"), Format::Unstated, None, None, &limits);
    assert_eq!(
        refused.unwrap_err().faults()[0].code,
        code::TOO_MANY_SAMPLES
    );
}

#[test]
fn no_damage_to_an_mdf_file_panics() {
    let limits = Limits {
        max_columns: 100,
        max_samples: 4000,
        max_values: 20_000,
        max_bytes: 100_000,
        ..Limits::default()
    };
    for (name, step) in [
        ("groups", 3),
        ("texts", 2),
        ("unsorted", 1),
        ("transposed", 7),
    ] {
        let good = bytes(name);
        for at in (0..good.len()).step_by(step) {
            let mut damaged: Vec<Vec<u8>> = vec![good[..at].to_vec()];
            damaged.extend([0, 1, 0x7f, 0xff].map(|with| {
                let mut bytes = good.clone();
                bytes[at] = with;
                bytes
            }));
            for bytes in damaged {
                let read = read_recording(&bytes, Format::Unstated, None, None, &limits);
                if let Err(error) = read {
                    assert!(!error.faults().is_empty());
                }
            }
        }
    }
}
