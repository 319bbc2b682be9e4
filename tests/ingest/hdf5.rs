//! HDF5 files as MATLAB, pandas and h5py write them; `recordings/make_hdf5.py` says what is in each.

use trimtab_core::flight::Maneuver;
use trimtab_core::ingest::{Format, IngestError, Limits, Mapping, Reading, code, read_recording};

use crate::common::repository;

fn bytes(name: &str) -> Vec<u8> {
    let path = repository::path(&format!("tests/ingest/recordings/{name}"));
    std::fs::read(path).expect("a recording")
}

fn unpacked(name: &str) -> Vec<u8> {
    let mut unpacked = Vec::new();
    let packed = bytes(name);
    let mut packed = flate2::read::GzDecoder::new(packed.as_slice());
    std::io::Read::read_to_end(&mut packed, &mut unpacked).expect("it is whole");
    unpacked
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

/// Groups with many members have them in a heap with a tree: here of two levels above the leaves, by name and by age.
#[test]
fn groups_with_many_members_are_read() {
    let file = unpacked("dense.h5.gz");
    for alpha in ["air/alpha", "air/alpha again, 0", "air/alpha again, 1299"] {
        let sources = ["air/time", alpha, "air/q"];
        let [time, alpha, q] =
            sources.map(|source| source.replace([' ', ','], "_").replace("__", "_"));
        let reading = read(&file, Some(&mapping(&time, &alpha, &q)));
        let reading = reading.unwrap_or_else(|error| panic!("{alpha}: {error}"));
        assert_is_the_recording(&reading.maneuver, &alpha);
    }
    // units stand beside datasets, as netCDF has them
    let text = r#"{"time": {"from": "air.time", "unit": "s"}, "channels": {"alpha": {"from": "air.alpha"}}}"#;
    let own = read(&file, Some(&Mapping::from_json(text).unwrap())).unwrap();
    let alpha = &own.maneuver.channels()["alpha"].values;
    assert_eq!(alpha[0], 1.5_f64.to_radians());
    let limits = Limits {
        max_columns: 1000,
        ..Limits::default()
    };
    let refused = read_recording(&file, Format::Unstated, None, None, &limits).unwrap_err();
    assert_eq!(refused.faults()[0].code, code::TOO_MANY_COLUMNS);
}

/// `save -v7.3` of arrays of structs, and of cells.
#[test]
fn arrays_of_structs_and_cells_of_matlab_are_read() {
    let file = bytes("v73_structs.mat");
    for [time, alpha, q] in [
        ["run(1).t", "run(2).alpha", "run(2).inner.q"],
        ["sample.t", "sample.alpha", "sample.q"],
        ["c[0]", "c[1]", "c[2]"],
    ] {
        let reading = read(&file, Some(&mapping(time, alpha, q)));
        let reading = reading.unwrap_or_else(|error| panic!("{alpha}: {error}"));
        assert_is_the_recording(&reading.maneuver, alpha);
    }
    let other = read(
        &file,
        Some(&mapping("run(1).t", "run(1).alpha", "run(2).inner.q")),
    )
    .unwrap();
    let first = other.maneuver.channels()["alpha"].values[0];
    assert_eq!(first, (-1.5_f64).to_radians());
    for (source, expected) in [
        ("run.inner", "each of 2 structs"),
        ("run(3).alpha", "to rec(2).alpha"),
        ("c[7]", "to c[2] of cells"),
        ("run(2).beta", "there is no 'run/beta'"),
        ("run(1).inner.q", "is not a struct"),
        ("sample.note", "not numbers"),
        ("sample(2).note", "char"),
        ("c(2).x", "is not a struct"),
    ] {
        let error = read(&file, Some(&mapping("c[0]", source, "c[2]"))).unwrap_err();
        let fault = &error.faults()[0];
        assert_eq!(fault.pointer, "/channels/alpha/from", "{source}");
        assert!(fault.message.contains(expected), "{source}: {fault}");
    }
}

/// By the conventions of netCDF: what is stored times `scale_factor`, and `add_offset` more; `_FillValue` is no value.
#[test]
fn packed_numbers_are_unpacked_as_the_file_says() {
    let file = bytes("packed.nc");
    let text = r#"{"time": {"from": "time", "unit": "s"}, "channels": {"alpha": {"from": "alpha"}, "q": {"from": "q"}}}"#;
    let reading = read(&file, Some(&Mapping::from_json(text).unwrap())).unwrap();
    let channel = |name: &str| &reading.maneuver.channels()[name].values;
    for (name, expected) in [
        ("alpha", [1.5, 2.5, f64::NAN, 3.5, 4.5]),
        ("q", [10.0, -20.0, 30.0, -40.0, 50.0]),
    ] {
        for (value, expected) in channel(name).iter().zip(expected) {
            let off = value.to_degrees() - expected;
            assert!(
                off.abs() < 1e-12 || (value.is_nan() && expected.is_nan()),
                "{name}: {off}"
            );
        }
    }
    let told = &reading.findings[0].message;
    assert!(told.contains("'alpha', 'q'"), "{told}");
}

/// A reference to nothing keeps its place: h5py reads the elements of `run/alpha` as -alpha, none, alpha.
#[test]
fn references_to_nothing_keep_their_places() {
    let file = bytes("v73_nothing.mat");
    let third = mapping("run(3).t", "run(3).alpha", "run(3).q");
    let reading = read(&file, Some(&third)).unwrap();
    assert_is_the_recording(&reading.maneuver, "run(3)");
    for (source, expected) in [
        ("run(2).alpha", "'run/alpha' has nothing at its element 2"),
        ("run(4).alpha", "to rec(3).alpha"),
        ("run.single", "each of 3 structs"),
    ] {
        let error = read(&file, Some(&mapping("run(3).t", source, "run(3).q"))).unwrap_err();
        let fault = &error.faults()[0];
        assert_eq!(fault.pointer, "/channels/alpha/from", "{source}");
        assert!(fault.message.contains(expected), "{source}: {fault}");
    }
}

/// Whatever byte is another, the answer is a recording or a fault.
#[test]
fn no_damage_to_heaps_and_references_panics() {
    let structs = bytes("v73_structs.mat");
    let of_structs = mapping("sample.t", "run(2).alpha", "c[2]");
    for at in (512..structs.len()).step_by(17) {
        for with in [0, 1, 0xff] {
            let mut damaged = structs.clone();
            damaged[at] = with;
            let _ = read(&damaged, Some(&of_structs));
        }
        let _ = read(&structs[..at], Some(&of_structs));
    }
    // the first blocks of each kind, of which there are many
    let dense = unpacked("dense.h5.gz");
    let of_dense = mapping("air/time", "air/alpha", "air/q");
    for mark in [b"FRHP", b"FHIB", b"FHDB", b"BTHD", b"BTIN", b"BTLF"] {
        let mut found = dense.windows(4).enumerate();
        let begins = found.find(|(_, word)| word == mark).map(|(at, _)| at);
        let begins = begins.expect("a block of each kind");
        for at in (begins..begins + 150).step_by(3) {
            let mut damaged = dense.clone();
            damaged[at] ^= 0xff;
            let _ = read(&damaged, Some(&of_dense));
        }
    }
}
