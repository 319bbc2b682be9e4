//! Parquet files as pandas and pyarrow write them; `recordings/make_tables.py` says what is in each.

use trimtab_core::flight::Maneuver;
use trimtab_core::ingest::{
    Format, IngestError, Limits, Mapping, Reading, code, inspect, read_recording,
};

use crate::common::repository;

fn bytes(name: &str) -> Vec<u8> {
    let path = repository::path(&format!("tests/ingest/recordings/{name}.parquet"));
    std::fs::read(path).expect("a recording")
}

fn reading(name: &str) -> Reading {
    read(&bytes(name), None).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn read(bytes: &[u8], mapping: Option<&Mapping>) -> Result<Reading, IngestError> {
    read_recording(bytes, Format::Unstated, None, mapping, &Limits::default())
}

fn values(maneuver: &Maneuver, name: &str) -> Vec<f64> {
    let channel = &maneuver.channels()[name];
    channel
        .values
        .iter()
        .map(|value| (value / channel.unit.scale * 1e9).round() / 1e9)
        .collect()
}

/// The same, -1 for no value.
fn known(maneuver: &Maneuver, name: &str) -> Vec<f64> {
    let known = |value: f64| if value.is_nan() { -1.0 } else { value };
    values(maneuver, name).into_iter().map(known).collect()
}

const TIME: [f64; 5] = [0.0, 0.04, 0.08, 0.12, 0.16];
const ALPHA: [f64; 5] = [1.5, 2.5, -1.0, 3.5, 4.5];

#[test]
fn every_way_to_pack_and_to_write_is_read() {
    for name in [
        "snappy",
        "gzip",
        "lz4",
        "kinds",
        "durations",
        "nested",
        "delta",
    ] {
        let Reading { maneuver, .. } = reading(name);
        for (time, expected) in maneuver.time().iter().zip(TIME) {
            assert!((time - expected).abs() < 1e-12, "{name}");
        }
        assert_eq!(known(&maneuver, "alpha"), ALPHA, "{name}");
        if let Some(q) = maneuver.channels().get("q") {
            assert_eq!(q.values[1], (-20f64).to_radians(), "{name}");
        }
    }
}

#[test]
fn numbers_of_every_kind_are_read() {
    let Reading {
        maneuver, findings, ..
    } = reading("kinds");
    assert_eq!(known(&maneuver, "gear"), [1.0, 0.0, -1.0, 1.0, 0.0]);
    assert_eq!(known(&maneuver, "mode"), [1.0, 2.0, -1.0, 4.0, 255.0]);
    assert_eq!(values(&maneuver, "count")[4], 2f64.powi(63));
    assert_eq!(values(&maneuver, "torque"), [1.0, 2.0, 3.0, 4.0, 5.5]);
    let left_out: Vec<&str> = findings
        .iter()
        .map(|finding| finding.code.as_ref())
        .collect();
    assert!(left_out.contains(&"left_out"), "words are: {left_out:?}");
    let counts = [
        2f64.powi(32) - 1.0,
        0.0,
        2f64.powi(31),
        5.0,
        2f64.powi(31) - 1.0,
    ];
    let Reading { maneuver, .. } = reading("delta");
    assert_eq!(values(&maneuver, "count"), counts);
    assert_eq!(
        values(&maneuver, "total"),
        counts.map(|count| count * 2f64.powi(32))
    );
    let Reading {
        maneuver, findings, ..
    } = reading("nested");
    assert_eq!(known(&maneuver, "air_p"), [1.0, 2.0, -1.0, 4.0, 5.0]);
    assert_eq!(known(&maneuver, "air_T"), [-1.0, 5.0, -1.0, 1.0, 2.0]);
    assert_eq!(values(&maneuver, "mass"), [1.0, 2.0, 3.0, 4.0, 5.0]);
    assert_eq!(values(&maneuver, "half")[4], -5.5);
    let left_out = findings.iter().find(|finding| finding.code == "left_out");
    let message = &left_out.unwrap().message;
    assert!(message.contains("it is a list in each row"), "{message}");
    assert!(message.contains("'photo' (it holds bytes"), "{message}");
}

#[test]
fn times_are_read_to_their_last_digit() {
    for name in ["epoch", "int96"] {
        let Reading { maneuver, .. } = reading(name);
        for (time, expected) in maneuver.time().iter().zip(TIME) {
            assert!((time - expected).abs() < 1e-15, "{name}");
        }
    }
    let Reading {
        maneuver, findings, ..
    } = reading("texts");
    assert_eq!(maneuver.time()[4], 0.16);
    assert_eq!(known(&maneuver, "alpha"), [1.5, 2.5, -1.0, -1.0, 4.5]);
    let left_out = findings.iter().find(|finding| finding.code == "left_out");
    assert!(left_out.unwrap().message.contains("note"));
}

#[test]
fn a_mapping_names_titles_as_in_a_table_of_text() {
    let text = r#"{"time": {"step": 0.5, "unit": "s"}, "channels": {"aoa": {"from": "alpha", "unit": "rad", "scale": 2}}}"#;
    let mapping = Mapping::from_json(text).unwrap();
    let Reading { maneuver, .. } = read(&bytes("snappy"), Some(&mapping)).unwrap();
    assert_eq!(maneuver.time()[4], 2.0);
    assert_eq!(known(&maneuver, "aoa")[4], 9.0);
    let missing = text.replace("alpha", "beta");
    let mapping = Mapping::from_json(&missing).unwrap();
    let error = read(&bytes("snappy"), Some(&mapping)).unwrap_err();
    assert_eq!(error.faults()[0].code, code::UNKNOWN_SOURCE);
    let inspected = inspect(
        &bytes("kinds"),
        Format::Unstated,
        None,
        None,
        &Limits::default(),
    );
    let inspected = inspected.unwrap().expect("a table");
    assert_eq!(inspected.columns[1].unit, "deg");
    assert_eq!(inspected.columns[0].first, "2026-11-21T10:00:00Z");
    assert!(inspected.draft.to_toml().contains("alpha [deg]"));
}

#[test]
fn what_is_not_read_says_so() {
    let refused = |bytes: &[u8]| {
        let error = read(bytes, None).unwrap_err();
        let fault = &error.faults()[0];
        (fault.code.to_string(), fault.message.clone())
    };
    let (found, message) = refused(&bytes("brotli"));
    assert_eq!(found, code::FORMAT_NOT_READ);
    assert!(
        message.contains("Brotli") && message.contains("snappy"),
        "{message}"
    );
    let (found, message) = refused(b"PARE\0\0");
    assert_eq!(found, code::FORMAT_NOT_READ);
    assert!(message.contains("encrypted"), "{message}");
    let whole = bytes("snappy");
    let (found, message) = refused(&whole[..whole.len() - 1]);
    assert_eq!(found, code::DAMAGED_FILE);
    assert!(message.contains("cut off"), "{message}");
}

#[test]
fn the_limits_hold_before_anything_is_unpacked() {
    let refused = |limits: Limits| {
        let read = read_recording(&bytes("kinds"), Format::Unstated, None, None, &limits);
        read.unwrap_err().faults()[0].code.to_string()
    };
    let usual = Limits::default();
    let max_bytes = 40;
    assert_eq!(
        refused(Limits { max_bytes, ..usual }),
        code::UNPACKED_TOO_LARGE
    );
    let max_samples = 4;
    assert_eq!(
        refused(Limits {
            max_samples,
            ..usual
        }),
        code::TOO_MANY_SAMPLES
    );
    let max_values = 39;
    assert_eq!(
        refused(Limits {
            max_values,
            ..usual
        }),
        code::TOO_MANY_VALUES
    );
    let max_columns = 7;
    assert_eq!(
        refused(Limits {
            max_columns,
            ..usual
        }),
        code::TOO_MANY_COLUMNS
    );
}

#[test]
fn no_damage_to_a_parquet_file_panics() {
    let limits = Limits {
        max_samples: 1000,
        max_values: 10_000,
        max_bytes: 100_000,
        ..Limits::default()
    };
    let look = |bytes: &[u8]| {
        let read = read_recording(bytes, Format::Unstated, None, None, &limits);
        if let Err(error) = read {
            assert!(!error.faults().is_empty());
        }
    };
    for (name, step) in [("kinds", 7), ("nested", 3), ("delta", 1), ("texts", 1)] {
        let good = bytes(name);
        for at in (0..good.len()).step_by(step) {
            look(&good[..at]);
            for with in [0, 0x7f, 0xff] {
                let mut damaged = good.clone();
                damaged[at] = with;
                look(&damaged);
            }
        }
    }
}
