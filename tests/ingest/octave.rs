//! Variables that Octave saved as text, of every kind: `recordings/make_octave.m` says what each is.

use trimtab_core::flight::Maneuver;
use trimtab_core::ingest::{Format, IngestError, Limits, Mapping, Reading, code, read_recording};

use crate::common::repository;
use crate::programs::{assert_read, mapping, reading};

fn file() -> Vec<u8> {
    let path = repository::path("tests/ingest/recordings/octave.txt");
    std::fs::read(path).expect("the file stands beside the tests")
}

fn read(bytes: &[u8], from: &str) -> Result<Reading, IngestError> {
    let text = format!(
        r#"{{"time": {{"from": "time", "unit": "s"}}, "channels": {{"a": {{"from": "{from}", "unit": "-"}}}}}}"#
    );
    let mapping = Mapping::from_json(&text).unwrap();
    let limits = Limits::default();
    read_recording(bytes, Format::Unstated, None, Some(&mapping), &limits)
}

fn values(maneuver: &Maneuver, name: &str) -> Vec<f64> {
    maneuver.channels()[name].values.clone()
}

/// The expected numbers are those of the expressions in `make_octave.m`.
#[test]
fn real_numbers_of_every_kind_are_read() {
    let file = file();
    for (from, expected) in [
        ("air.q", [2.0, 4.0, 6.0, 8.0, 10.0]),
        ("flap", [7.0, 8.0, 9.0, 10.0, 11.0]),
        ("on(:,1)", [1.0, 1.0, 0.0, 1.0, 0.0]),
        ("on(:,2)", [0.0, 1.0, 1.0, 0.0, 1.0]),
        ("deep(:,2)", [6.0, 7.0, 8.0, 9.0, 10.0]),
        ("half(:,1)", [0.0, 0.0, 0.0, -4.0, 0.0]),
        ("half(:,2)", [0.5, 0.0, 0.0, 0.0, 0.0]),
        ("half(:,3)", [0.0, 0.0, 0.0, 0.0, 5.0]),
        ("scaled(:,1)", [3.0, 0.0, 0.0, 0.0, 0.0]),
        ("scaled(:,2)", [0.0, 3.0, 0.0, 0.0, 0.0]),
        ("found", [1.0, 3.0, 4.0, 5.0, 6.0]),
        ("down", [5.0, 4.0, 3.0, 2.0, 1.0]),
        ("count(:,2)", [2.0, 4.0, 6.0, 8.0, 10.0]),
        ("again", [5.0, 4.0, 3.0, 2.0, 1.0]),
    ] {
        let reading = read(&file, from).unwrap_or_else(|error| panic!("{from}: {error}"));
        assert_eq!(values(&reading.maneuver, "a"), expected, "{from}");
        // the last of a range is its limit, to the last digit
        assert_eq!(reading.maneuver.time()[4], 0.4);
        let told = reading.findings.iter();
        let told: Vec<_> = told.map(|finding| finding.sentence()).collect();
        assert!(told[0].contains("'again' (it was saved again"), "{told:?}");
    }
    let alpha = read(&file, "air.alpha").unwrap().maneuver;
    let alpha = values(&alpha, "a");
    assert_eq!((alpha[1], alpha[4]), (1.25, 0.5));
    assert!(alpha[3].is_nan());
}

#[test]
fn what_is_no_real_matrix_is_named_where_it_is_asked_for() {
    let file = file();
    for (from, expected) in [
        ("air.notes", "1x3 cell"),
        ("air.of", "struct"),
        ("cube", "2x2x2 matrix"),
        ("large", "1000000x1000000 sparse matrix"),
        ("swapped", "5x5 permutation matrix"),
        ("waves", "float complex matrix"),
        ("wave", "complex scalar"),
        ("text", "string"),
        ("rows", "string"),
        ("line", "class"),
    ] {
        let error = read(&file, from).unwrap_err();
        let fault = &error.faults()[0];
        assert_eq!(fault.code, code::UNREADABLE_SOURCE, "{from}: {fault}");
        assert!(fault.message.contains(expected), "{from}: {fault}");
    }
    // what is within a text, a cell or a function is no variable
    let unmapped = read_recording(&file, Format::Unstated, None, None, &Limits::default());
    let unmapped = unmapped.unwrap_err().to_string();
    assert!(unmapped.contains("'air.q' (5x1)"), "{unmapped}");
    assert!(!unmapped.contains("'q'"), "{unmapped}");
    let unknown = read(&file, "q").unwrap_err();
    assert_eq!(unknown.faults()[0].code, code::UNKNOWN_SOURCE);
}

/// As Octave writes a range of the increment 0: `# base, length, increment`.
#[test]
fn a_range_without_an_increment_has_a_length() {
    let with = |numbers: &str| {
        let text = format!(
            "# Created by Octave 6.4.0\n# name: still\n# type: range\n# base, length, increment\n{numbers}\n\n\n# name: odd\n# type: java object\nwhatever\n\n# name: time\n# type: matrix\n# rows: 3\n# columns: 1\n 0\n 1\n 2\n"
        );
        read(text.as_bytes(), "still")
    };
    let reading = with("1.5 3 0").unwrap();
    assert_eq!(values(&reading.maneuver, "a"), [1.5; 3]);
    let told = reading.findings[0].sentence();
    assert!(
        told.contains("'odd' ('java object' is a kind that is not known)"),
        "{told}"
    );
    for (numbers, code) in [
        ("1.5 NaN 0", code::DAMAGED_FILE),
        ("1.5 3", code::DAMAGED_FILE),
        ("0 1 x", code::DAMAGED_FILE),
        // one that goes the other way has no numbers
        ("0 1 -0.5", code::LENGTH_MISMATCH),
    ] {
        let refused = with(numbers).unwrap_err();
        assert_eq!(refused.faults()[0].code, code, "{numbers}: {refused}");
    }
}

#[test]
fn no_damage_to_a_file_of_octave_panics() {
    let good = file();
    for at in 0..good.len() {
        let _ = read(&good[..at], "air.q");
        for with in [b'9', b'\n', b' ', 0xff] {
            let mut damaged = good.clone();
            damaged[at] = with;
            if let Err(error) = read(&damaged, "half(:,2)") {
                assert!(!error.faults().is_empty());
            }
        }
    }
}

/// Octave's manual, "Simple File I/O", and its ls-oct-text.cc.
#[test]
fn variables_of_octave_are_taken_by_name() {
    let text = "# Created by Octave 8.4.0, Sun Mar 01 10:15:00 2026 UTC <own@own>\n# name: t\n# type: double_range\n# base, limit, increment\n0 0.3 0.1\n\n\n# name: rec\n# type: scalar struct\n# ndims: 2\n 1 1\n# length: 2\n# name: alpha\n# type: matrix\n# rows: 4\n# columns: 1\n 3\n 3.5\n NaN\n NA\n\n\n# name: note\n# type: string\n# elements: 1\n# length: 4\nmade\n\n\n\n\n# name: d\n# type: matrix\n# rows: 4\n# columns: 2\n 0 1\n 1 2\n 2 3\n 3 4\n\n\n# name: n\n# type: int32 matrix\n# ndims: 2\n 2 2\n  1\n  2\n  3\n  4\n\n\n";
    let said = r#"{"time": {"from": "t", "unit": "s"}, "channels": {"alpha": {"from": "rec.alpha", "unit": "deg"}, "q": {"from": "d(:,2)", "unit": "deg/s"}}}"#;
    let octave = reading(text, Some(&mapping(said))).unwrap().maneuver;
    assert_read(&octave, 4, 0.3, ("alpha", 3.0, "deg"));
    assert_read(&octave, 4, 0.3, ("q", 1.0, "deg/s"));
    assert!(octave.channels()["alpha"].values[3].is_nan());
    // integers stand column by column
    let whole = r#"{"time": {"from": "n(:,1)", "unit": "s"}, "channels": {"n": {"from": "n(:,2)", "unit": "-"}}}"#;
    let whole = reading(text, Some(&mapping(whole))).unwrap().maneuver;
    assert_read(&whole, 2, 1.0, ("n", 3.0, "-"));
    let unmapped = reading(text, None).unwrap_err();
    assert_eq!(unmapped.faults()[0].code, code::MAPPING_NEEDED);
    assert!(
        unmapped.to_string().contains("'rec.alpha' (4x1)"),
        "{unmapped}"
    );
    for at in 0..text.len() {
        let _ = reading(&text[..at], Some(&mapping(said)));
    }
    // a matrix without columns has no values, however many rows it says
    let endless = text.replace(" 2 2\n  1\n", " 1000000000000000000 0\n  1\n");
    assert!(reading(&endless, Some(&mapping(said))).is_ok());
}
