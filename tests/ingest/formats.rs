//! Recordings as other programs write them, byte for byte; and the same with damage of every kind.

use std::io::Write;

use trimtab_core::flight::Maneuver;
use trimtab_core::ingest::{Format, IngestError, Limits, Mapping, code, read_mapped};

const PLAIN: &[u8] = include_bytes!("recordings/plain.mat");
const COMPRESSED: &[u8] = include_bytes!("recordings/compressed.mat");
const ONE_MATRIX: &[u8] = include_bytes!("recordings/one_matrix.mat");
const BIG_ENDIAN: &[u8] = include_bytes!("recordings/big_endian.mat");

/// A mapping of `(name, source)`, time first.
fn mapping(sources: &[(&str, &str)]) -> Mapping {
    let unit = |name: &str| match name {
        "alpha" => "deg",
        "q" => "deg/s",
        _ => "-",
    };
    let channels = sources[1..].iter().map(|(name, from)| {
        format!(
            r#""{name}": {{"from": "{from}", "unit": "{}"}}"#,
            unit(name)
        )
    });
    let channels: Vec<String> = channels.collect();
    let (_, time) = sources[0];
    let text = format!(
        r#"{{"time": {{"from": "{time}", "unit": "s"}}, "channels": {{{}}}}}"#,
        channels.join(",")
    );
    Mapping::from_json(&text).unwrap()
}

fn by_name() -> Mapping {
    mapping(&[("t", "t"), ("alpha", "alpha"), ("q", "q")])
}

fn mat(bytes: &[u8], mapping: &Mapping) -> Result<Maneuver, IngestError> {
    read_mapped(bytes, Format::Mat, Some(mapping), &Limits::default())
}

/// Code, place and message of the first fault.
fn refused(result: Result<Maneuver, IngestError>) -> (String, String, String) {
    let fault = result.unwrap_err().into_faults().remove(0);
    (fault.code.into_owned(), fault.pointer, fault.message)
}

fn assert_is_the_recording(maneuver: &Maneuver, file: &str) {
    assert_eq!(maneuver.time(), [0.0, 0.04, 0.08, 0.12, 0.16], "{file}");
    let alpha = &maneuver.channels()["alpha"];
    assert_eq!(alpha.values[0], 1.5_f64.to_radians(), "{file}");
    assert!(alpha.values[2].is_nan(), "{file}");
    let q = &maneuver.channels()["q"].values;
    assert_eq!(q[1], (-20.0_f64).to_radians(), "{file}");
}

#[test]
fn mat_files_are_read_whatever_their_layout() {
    let of_data = mapping(&[
        ("t", "data(:,1)"),
        ("alpha", "data(:,2)"),
        ("q", "data(:,3)"),
    ]);
    let of_struct = mapping(&[
        ("t", "rec.t"),
        ("alpha", "rec.alpha"),
        ("q", "rec.q"),
        ("acc", "rec.inner.acc"),
    ]);
    let of_any = mapping(&[("t", "(:,1)"), ("alpha", "(:,2)"), ("q", "(:,3)")]);
    for (file, bytes, mapping) in [
        ("vectors", PLAIN, by_name()),
        ("a compressed matrix", COMPRESSED, of_data),
        ("a compressed struct", COMPRESSED, of_struct),
        ("the only matrix", ONE_MATRIX, of_any),
        ("big-endian", BIG_ENDIAN, by_name()),
    ] {
        let maneuver = mat(bytes, &mapping).unwrap_or_else(|error| panic!("{file}: {error}"));
        assert_is_the_recording(&maneuver, file);
        if let Some(third) = maneuver.channels().get("acc_3") {
            assert_eq!(third.values, [2.0, 5.0, 8.0, 11.0, 14.0]);
        }
    }
    let squeezed = mat(PLAIN, &mapping(&[("t", "t"), ("k", "k")])).unwrap();
    assert_eq!(squeezed.channels()["k"].values, [0.0; 5], "1 x 1 x 5");
}

#[test]
fn what_a_mat_file_does_not_have_is_said_with_what_it_has() {
    let of = |source: &str| {
        refused(mat(
            COMPRESSED,
            &mapping(&[("t", "data(:,1)"), ("a", source)]),
        ))
    };
    for (source, code, expected) in [
        ("dta", code::UNKNOWN_SOURCE, "'data' (5x3 double)"),
        ("data(:,4)", code::UNKNOWN_SOURCE, "3 column(s)"),
        ("(:,1)", code::UNKNOWN_SOURCE, "not have exactly one matrix"),
        ("rec.beta", code::UNKNOWN_SOURCE, "'alpha', 'q'"),
        ("rec", code::UNREADABLE_SOURCE, "1x1 struct"),
        ("data.t", code::UNREADABLE_SOURCE, "not a struct but 5x3"),
        ("recs(9).t", code::UNKNOWN_SOURCE, "no such one"),
        ("note", code::UNREADABLE_SOURCE, "char"),
        ("z", code::UNREADABLE_SOURCE, "complex double"),
        ("cells", code::UNREADABLE_SOURCE, "1x2 cell"),
        ("sparse", code::UNREADABLE_SOURCE, "2x2 sparse"),
    ] {
        let (found, place, message) = of(source);
        assert_eq!(
            (found.as_str(), place.as_str()),
            (code, "/channels/a/from"),
            "{source}: {message}"
        );
        assert!(message.contains(expected), "{source}: {message}");
    }
    let unmapped = read_mapped(COMPRESSED, Format::Mat, None, &Limits::default());
    let (found, _, message) = refused(unmapped);
    assert_eq!(found, code::MAPPING_NEEDED);
    assert!(message.contains("'rec' (1x1 struct)"), "{message}");
}

#[test]
fn other_versions_and_other_files_get_their_remedy() {
    let hdf5 = b"MATLAB 7.3 MAT-file, Platform: GLNXA64";
    for (bytes, code, remedy) in [
        (&hdf5[..], code::DAMAGED_FILE, "cut off"),
        (b"t[s],a\n0,1\n1,2\n", code::NOT_A_MAT_FILE, "text/plain"),
        (b"", code::EMPTY_BODY, "send"),
    ] {
        let (found, _, message) = refused(mat(bytes, &by_name()));
        assert_eq!(found, code, "{message}");
        assert!(message.contains(remedy), "{message}");
    }
}

#[test]
fn no_damage_to_a_mat_file_panics() {
    let all = mapping(&[
        ("t", "data(:,1)"),
        ("a", "rec.inner.acc"),
        ("b", "rec.q"),
        ("c", "note"),
        ("d", "cells"),
    ]);
    let any = mapping(&[("t", "(:,1)"), ("alpha", "(:,2)")]);
    let plain = mapping(&[("t", "t"), ("alpha", "alpha"), ("q", "q"), ("k", "k")]);
    for (bytes, mapping) in [
        (PLAIN, plain),
        (COMPRESSED, all),
        (ONE_MATRIX, any),
        (BIG_ENDIAN, by_name()),
    ] {
        for at in 0..bytes.len() {
            let cut = mat(&bytes[..at], &mapping);
            assert!(
                cut.is_err() || at + 8 > bytes.len(),
                "only padding may be missing: {at}"
            );
            for with in [0, 1, 0x7f, 0x80, 0xff, bytes[at] ^ 1, bytes[at] ^ 4] {
                let mut damaged = bytes.to_vec();
                damaged[at] = with;
                if let Err(error) = mat(&damaged, &mapping) {
                    assert!(!error.faults().is_empty());
                }
            }
        }
    }
}

/// A MAT file of one variable, compressed, of `rows` x 1 zeros, whatever its length says.
fn bomb(rows: u32, declared: u32) -> Vec<u8> {
    let words = |words: &[u32]| {
        words
            .iter()
            .flat_map(|word| word.to_le_bytes())
            .collect::<Vec<u8>>()
    };
    let length = rows as usize * 8;
    let mut matrix = words(&[14, declared, 6, 8, 6, 0, 5, 8, rows, 1, 0x1_0001]);
    matrix.extend_from_slice(b"t\0\0\0");
    matrix.extend(words(&[9, length as u32]));
    matrix.resize(matrix.len() + length, 0);
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    encoder.write_all(&matrix).unwrap();
    let packed = encoder.finish().unwrap();
    let mut file = PLAIN[..128].to_vec();
    file.extend(words(&[15, packed.len() as u32]));
    file.extend(packed);
    file
}

#[test]
fn what_unpacks_to_more_than_the_limits_is_refused() {
    let limits = Limits {
        max_values: 1_000_000,
        ..Limits::default()
    };
    let read = |bytes: &[u8]| {
        read_mapped(
            bytes,
            Format::Mat,
            Some(&mapping(&[("t", "t"), ("a", "t")])),
            &limits,
        )
    };
    let small = bomb(1000, 8048);
    assert_eq!(
        refused(read(&small)).0,
        code::TIME_NOT_INCREASING,
        "it is well-formed"
    );
    let large = bomb(2_000_000, 16_000_048);
    assert!(large.len() < 100_000);
    assert_eq!(refused(read(&large)).0, code::TOO_MANY_VALUES);
    let lying = bomb(2_000_000, 64);
    assert_eq!(refused(read(&lying)).0, code::TOO_MANY_VALUES);
}

#[test]
fn a_bundled_mapping_reads_its_matrix() {
    let row = |k: usize| {
        let cells: Vec<String> = (1..=45)
            .map(|column| format!("{:e}", (k * column) as f64))
            .collect();
        format!("  {}\n", cells.join("  "))
    };
    let text: String = (0..3).map(row).collect();
    let attas = Mapping::named_or_json("fvsysid-attas").unwrap();
    let maneuver = read_mapped(
        text.as_bytes(),
        Format::Ascii,
        Some(&attas),
        &Limits::default(),
    )
    .unwrap();
    assert_eq!(maneuver.time(), [0.0, 1.0, 2.0]);
    assert_eq!(maneuver.channels()["de"].values[2], 44.0_f64.to_radians());
    assert!(
        !maneuver.channels().contains_key("alphadot"),
        "a column that most files do not have"
    );
}
