//! MAT files with arrays of structs and with tables of different rates, written here as the format's description has them.

use std::io::Write;

use trimtab_core::flight::Maneuver;
use trimtab_core::ingest::{Format, IngestError, Limits, Mapping, code, read_mapped};

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// A tag, bytes, and padding to eight.
fn element(kind: u32, content: &[u8]) -> Vec<u8> {
    let mut bytes = words(&[kind, content.len() as u32]);
    bytes.extend(content);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

fn array(name: &str, class: u32, rows: u32, columns: u32, content: &[u8]) -> Vec<u8> {
    let parts = [
        element(6, &words(&[class, 0])),
        element(5, &words(&[rows, columns])),
        element(1, name.as_bytes()),
        content.to_vec(),
    ];
    element(14, &parts.concat())
}

/// Column by column.
fn matrix(name: &str, columns: u32, values: &[f64]) -> Vec<u8> {
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    array(
        name,
        6,
        values.len() as u32 / columns,
        columns,
        &element(9, &bytes),
    )
}

/// An array of structs, one behind the other, each with a value in every field.
fn structs(name: &str, fields: &[&str], values: &[Vec<Vec<u8>>]) -> Vec<u8> {
    let mut names = Vec::new();
    for field in fields {
        names.extend(field.as_bytes());
        names.resize(names.len().next_multiple_of(32), 0);
    }
    let parts = [
        element(5, &words(&[32])),
        element(1, &names),
        values.concat().concat(),
    ];
    array(name, 2, 1, values.len() as u32, &parts.concat())
}

fn file(variables: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = b"MATLAB 5.0 MAT-file".to_vec();
    bytes.resize(124, b' ');
    bytes.extend([0, 1, b'I', b'M']);
    bytes.extend(variables.concat());
    bytes
}

/// A struct for each sample, as `load` of a logger's struct array has it; with a vector in one field.
fn samples() -> Vec<u8> {
    let sample = |k: u32| {
        let k = f64::from(k);
        vec![
            matrix("", 1, &[0.02 * k]),
            matrix("", 1, &[k]),
            matrix("", 3, &[k, 10.0 * k, 100.0 * k]),
            matrix("", 1, &[1.0, 2.0, 3.0][..if k > 4.0 { 2 } else { 3 }]),
        ]
    };
    let samples: Vec<_> = (0..12).map(sample).collect();
    file(&[structs("rec", &["time", "alpha", "gyro", "odd"], &samples)])
}

/// What a scope writes to the workspace, as a structure with time.
fn scope() -> Vec<u8> {
    let signal = |values: &[f64], columns| vec![matrix("", columns, values), matrix("", 1, &[1.0])];
    let signals = structs(
        "",
        &["values", "dimensions"],
        &[
            signal(&[1.0, 2.0, 3.0], 1),
            signal(&[4.0, 5.0, 6.0, 7.0, 8.0, 9.0], 2),
        ],
    );
    let time = matrix("", 1, &[0.0, 0.1, 0.2]);
    file(&[structs(
        "scope",
        &["time", "signals"],
        &[vec![time, signals]],
    )])
}

/// A gyro at 50 Hz and air data at 10 Hz.
fn rates() -> Vec<u8> {
    let times = |count: u32, step: f64| (0..count).map(move |k| f64::from(k) * step);
    let table = |name: &str, count: u32, step: f64| {
        let values: Vec<f64> = times(count, step).chain(times(count, 1.0)).collect();
        matrix(name, 2, &values)
    };
    file(&[table("IMU", 50, 0.02), table("AIR", 10, 0.1)])
}

fn read(bytes: &[u8], time: &str, channels: &[(&str, &str)]) -> Result<Maneuver, IngestError> {
    let channels: Vec<String> = channels
        .iter()
        .map(|(name, rest)| format!(r#""{name}": {{"unit": "-", "from": {rest}}}"#))
        .collect();
    let text = format!(
        r#"{{"time": {{"from": "{time}", "unit": "s"}}, "channels": {{{}}}}}"#,
        channels.join(",")
    );
    let mapping = Mapping::from_json(&text).unwrap();
    read_mapped(bytes, Format::Mat, Some(&mapping), &Limits::default())
}

#[test]
fn a_field_of_an_array_of_structs_is_a_time_history() {
    let channels = [
        ("alpha", r#""rec.alpha""#),
        ("q", r#""rec.gyro(:,2)""#),
        ("all", r#""rec.gyro""#),
    ];
    let maneuver = read(&samples(), "rec.time", &channels).unwrap();
    assert_eq!(maneuver.len(), 12);
    assert_eq!(maneuver.time()[11], 0.02 * 11.0);
    assert_eq!(maneuver.channels()["alpha"].values[7], 7.0);
    assert_eq!(maneuver.channels()["q"].values[7], 70.0);
    assert_eq!(maneuver.channels()["all_3"].values[7], 700.0);

    let refused = |source: &str, code: &str, expected: &str| {
        let error = read(&samples(), "rec.time", &[("a", source)]).unwrap_err();
        assert_eq!(error.faults()[0].code, code, "{error}");
        assert!(error.to_string().contains(expected), "{error}");
    };
    refused(r#""rec.odd""#, code::UNREADABLE_SOURCE, "as rec(1).odd");
    refused(
        r#""rec(13).alpha""#,
        code::UNKNOWN_SOURCE,
        "from rec(1).alpha to rec(12).alpha",
    );
    refused(
        r#""rec.beta""#,
        code::UNKNOWN_SOURCE,
        "it has 'time', 'alpha', 'gyro', 'odd'",
    );
    refused(
        r#""rec.alpha.x""#,
        code::UNKNOWN_SOURCE,
        "say which, from rec(1).alpha",
    );
    refused(
        r#""rec(2).alpha.x""#,
        code::UNREADABLE_SOURCE,
        "not a struct but 1x1 double",
    );
    refused(r#""rec""#, code::UNREADABLE_SOURCE, "1x12 struct");
}

#[test]
fn signals_of_a_scope_are_taken_by_number() {
    let channels = [
        ("a", r#""scope.signals(1).values""#),
        ("b", r#""scope.signals(2).values(:,2)""#),
        ("c", r#""scope.signals(2).values""#),
    ];
    let maneuver = read(&scope(), "scope.time", &channels).unwrap();
    assert_eq!(maneuver.channels()["a"].values, [1.0, 2.0, 3.0]);
    assert_eq!(maneuver.channels()["b"].values, [7.0, 8.0, 9.0]);
    assert_eq!(maneuver.channels()["c_1"].values, [4.0, 5.0, 6.0]);
    let error = read(
        &scope(),
        "scope.time",
        &[("a", r#""scope.signals.values""#)],
    )
    .unwrap_err();
    assert!(
        error.to_string().contains("as scope.signals(1).values"),
        "{error}"
    );
}

#[test]
fn tables_of_other_rates_keep_their_samples() {
    let q = ("q", r#""IMU(:,2)""#);
    let own = r#""AIR(:,2)", "time": "AIR(:,1)""#;
    let maneuver = read(&rates(), "IMU(:,1)", &[q, ("alpha", own)]).unwrap();
    let alpha = &maneuver.channels()["alpha"].values;
    assert_eq!(maneuver.len(), 50);
    let there: Vec<usize> = (0..50).filter(|&k| !alpha[k].is_nan()).collect();
    assert_eq!(there, (0..50).step_by(5).collect::<Vec<_>>());
    assert_eq!(alpha[45], 9.0);
    assert!(maneuver.sampling().even);

    let held = r#""AIR(:,2)", "time": "AIR(:,1)", "between": "held""#;
    let held = read(&rates(), "IMU(:,1)", &[q, ("alpha", held)]).unwrap();
    assert_eq!(held.channels()["alpha"].values[44..47], [8.0, 9.0, 9.0]);
    let error = read(&rates(), "IMU(:,1)", &[q, ("alpha", r#""AIR(:,2)""#)]).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("has 10 values where the time axis has 50; where it has"),
        "{error}"
    );
}

/// A name of one byte each, none of which is there: lists of them are much larger than the file.
#[test]
fn a_struct_has_no_more_fields_than_any() {
    let parts = [element(5, &words(&[1])), element(1, &vec![0; 70_000])];
    let bytes = file(&[array("rec", 2, 1, 1, &parts.concat())]);
    let error = read(&bytes, "rec.time", &[("a", r#""rec.alpha""#)]).unwrap_err();
    assert_eq!(error.faults()[0].code, code::DAMAGED_FILE, "{error}");
    assert!(
        error.to_string().contains("more fields than any"),
        "{error}"
    );
}

/// The variable as `save -v7` writes it.
fn compressed(variable: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(variable).unwrap();
    let packed = encoder.finish().unwrap();
    [words(&[15, packed.len() as u32]), packed].concat()
}

/// What is unpacked counts once, however often a mapping looks into it.
#[test]
fn sources_to_choose_from_do_not_use_up_the_limit() {
    const ROWS: u32 = 20_000;
    let series: Vec<f64> = (0..ROWS).map(f64::from).collect();
    let column = || matrix("", 1, &series);
    let fields = ["time", "alpha"];
    let first = structs("first", &fields, &[vec![column(), column()]]);
    let second = matrix("second", 1, &series);
    let bytes = file(&[compressed(&first), compressed(&second)]);
    let channels: Vec<String> = (0..7)
        .map(|at| format!(r#""c{at}": {{"unit": "-", "from": ["first.beta", "second"]}}"#))
        .collect();
    let text = format!(
        r#"{{"time": {{"from": "first.time", "unit": "s"}}, "channels": {{{}}}}}"#,
        channels.join(",")
    );
    let mapping = Mapping::from_json(&text).unwrap();
    let limits = Limits {
        max_values: 8 * ROWS as usize,
        ..Limits::default()
    };
    let maneuver = read_mapped(&bytes, Format::Mat, Some(&mapping), &limits).unwrap();
    assert_eq!(maneuver.channels()["c6"].values, series);
}

#[test]
fn no_damage_panics() {
    for (good, time, channel) in [
        (samples(), "rec.time", r#""rec.gyro""#),
        (scope(), "scope.time", r#""scope.signals(2).values""#),
    ] {
        for at in (0..good.len()).step_by(if good.len() > 3000 { 7 } else { 1 }) {
            let _ = read(&good[..at], time, &[("a", channel)]);
            for with in [0, 1, 0x7f, 0xff] {
                let mut damaged = good.clone();
                damaged[at] = with;
                let _ = read(&damaged, time, &[("a", channel)]);
            }
        }
    }
}
