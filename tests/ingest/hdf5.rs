//! HDF5 files as MATLAB, pandas and h5py write them; `recordings/make_hdf5.py` says what is in each.

use trimtab_core::flight::Maneuver;
use trimtab_core::ingest::{Format, IngestError, Limits, Mapping, Reading, code, read_recording};

use crate::common::repository;

fn bytes(name: &str) -> Vec<u8> {
    let path = repository::path(&format!("tests/ingest/recordings/{name}"));
    std::fs::read(path).expect("a recording")
}

fn read(bytes: &[u8], mapping: Option<&Mapping>) -> Result<Reading, IngestError> {
    read_recording(bytes, Format::Mat, None, mapping, &Limits::default())
}

/// A mapping of time and two angles from these sources.
fn mapping(time: &str, alpha: &str, q: &str) -> Mapping {
    let text = format!(
        r#"{{"time": {{"from": "{time}", "unit": "s"}}, "channels": {{"alpha": {{"from": "{alpha}", "unit": "deg"}}, "q": {{"from": "{q}", "unit": "deg/s"}}}}}}"#
    );
    Mapping::from_json(&text).unwrap()
}

fn assert_is_the_recording(maneuver: &Maneuver, file: &str) {
    for (time, expected) in maneuver.time().iter().zip([0.0, 0.04, 0.08, 0.12, 0.16]) {
        assert!((time - expected).abs() < 1e-12, "{file}");
    }
    let alpha = &maneuver.channels()["alpha"].values;
    assert_eq!(alpha[0], 1.5_f64.to_radians(), "{file}");
    assert!(alpha[2].is_nan(), "{file}");
    let q = &maneuver.channels()["q"].values;
    assert_eq!(q[1], (-20.0_f64).to_radians(), "{file}");
    assert_eq!(q.len(), 5, "{file}");
}

#[test]
fn datasets_are_read_however_they_are_stored() {
    for (file, sources) in [
        ("v73.mat", ["t", "rec.alpha", "rec.q"]),
        ("v73.mat", ["data(:,1)", "data(:,2)", "data(:,3)"]),
        ("v73.mat", ["t", "/rec/alpha", "rec/inner/q"]),
        ("datasets.h5", ["time", "air/alpha", "air/pitch_rate"]),
        ("datasets.h5", ["time", "gzip(:,2)", "lzf(:,3)"]),
        ("datasets.h5", ["time", "shuffled(:,2)", "big_endian(:,3)"]),
        ("latest.h5", ["time", "air/alpha", "air/pitch_rate"]),
        ("latest.h5", ["time", "gzip(:,2)", "single(:,3)"]),
        ("latest.h5", ["time", "implicit(:,2)", "fixed(:,3)"]),
    ] {
        let [time, alpha, q] = sources;
        let reading = read(&bytes(file), Some(&mapping(time, alpha, q)));
        let reading = reading.unwrap_or_else(|error| panic!("{file} {sources:?}: {error}"));
        assert_is_the_recording(&reading.maneuver, &format!("{file} {sources:?}"));
    }
    let long =
        r#"{"time": {"step": 1, "unit": "s"}, "channels": {"n": {"from": "paged", "unit": "-"}}}"#;
    let long = read(
        &bytes("latest.h5"),
        Some(&Mapping::from_json(long).unwrap()),
    )
    .unwrap();
    let n = &long.maneuver.channels()["n"].values;
    assert!((0..1100).all(|at| n[at] == at as f64), "pages of chunks");
}

#[test]
fn frames_of_pandas_are_read_as_their_titles_say() {
    for file in ["fixed.h5", "packed.h5", "fields.h5"] {
        let reading = read(&bytes(file), None).unwrap_or_else(|error| panic!("{file}: {error}"));
        assert_is_the_recording(&reading.maneuver, file);
    }
}

#[test]
fn what_a_file_does_not_have_is_said_with_what_it_has() {
    let unmapped = read(&bytes("v73.mat"), None).unwrap_err();
    let fault = &unmapped.faults()[0];
    assert_eq!(fault.code, code::MAPPING_NEEDED);
    assert!(fault.message.contains("'data' (5x3 double)"), "{fault}");
    for (source, code, expected) in [
        ("beta", code::UNKNOWN_SOURCE, "'rec/alpha' (5x1 double)"),
        ("rec", code::UNREADABLE_SOURCE, "is a group"),
        ("note", code::UNREADABLE_SOURCE, "char"),
        ("nothing", code::UNREADABLE_SOURCE, "is empty"),
        ("z", code::UNREADABLE_SOURCE, "'real', 'imag'"),
    ] {
        let error = read(&bytes("v73.mat"), Some(&mapping("t", source, "rec.q"))).unwrap_err();
        let fault = &error.faults()[0];
        assert_eq!(fault.code, code, "{source}: {fault}");
        assert_eq!(fault.pointer, "/channels/alpha/from", "{source}");
        assert!(fault.message.contains(expected), "{source}: {fault}");
    }
    let real = read(&bytes("v73.mat"), Some(&mapping("t", "z.imag", "rec.q"))).unwrap();
    assert_eq!(
        real.maneuver.channels()["alpha"].values[1],
        1f64.to_radians()
    );
}

#[test]
fn the_limits_hold() {
    let refused = |file: &str, mapping: Option<&Mapping>, limits: Limits| {
        let read = read_recording(&bytes(file), Format::Unstated, None, mapping, &limits);
        read.unwrap_err().faults()[0].code.to_string()
    };
    let usual = Limits::default();
    let mapped = mapping("time", "bomb", "air/pitch_rate");
    let found = refused("datasets.h5", Some(&mapped), usual);
    assert_eq!(found, code::TOO_MANY_VALUES, "10^9 values in a few bytes");
    let max_columns = 3;
    let found = refused(
        "datasets.h5",
        Some(&mapped),
        Limits {
            max_columns,
            ..usual
        },
    );
    assert_eq!(found, code::TOO_MANY_COLUMNS);
    let max_samples = 4;
    let found = refused(
        "fixed.h5",
        None,
        Limits {
            max_samples,
            ..usual
        },
    );
    assert_eq!(found, code::TOO_MANY_SAMPLES);
}

#[test]
fn no_damage_to_an_hdf5_file_panics() {
    let limits = Limits {
        max_columns: 100,
        max_samples: 4000,
        max_values: 20_000,
        ..Limits::default()
    };
    let by_name = mapping("time", "gzip(:,2)", "lzf(:,3)");
    let latest = mapping("time", "fixed(:,2)", "single(:,3)");
    let matlab = mapping("t", "rec.alpha", "data(:,3)");
    let look = |bytes: &[u8], mapping: Option<&Mapping>| {
        let read = read_recording(bytes, Format::Unstated, None, mapping, &limits);
        if let Err(error) = read {
            assert!(!error.faults().is_empty());
        }
    };
    for (file, mapping, step) in [
        ("datasets.h5", Some(&by_name), 11),
        ("latest.h5", Some(&latest), 11),
        ("v73.mat", Some(&matlab), 11),
        ("fixed.h5", None, 11),
        ("fields.h5", None, 5),
    ] {
        let good = bytes(file);
        for at in (0..good.len()).step_by(step) {
            look(&good[..at], mapping);
            for with in [0, 0x7f, 0xff] {
                if good[at] != with {
                    let mut damaged = good.clone();
                    damaged[at] = with;
                    look(&damaged, mapping);
                }
            }
        }
    }
}
