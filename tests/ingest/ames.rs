//! Files of NASA Ames (FFI 1001) and ICARTT, after Gaines and Hipskind, "Format Specification for Data Exchange". All numbers are
//! of our own making.

use trimtab_core::ingest::{Format, Limits, Mapping, code, inspect};

use crate::programs::{assert_read, mapping, read, reading, told};

/// NASA Ames FFI 1001 (Gaines and Hipskind): numbers are multiplied by what the header says, and one of each stands for no value.
#[test]
fn headers_of_nasa_ames_say_factors_and_missing_values() {
    let text = "20 1001\nOwn, Making\nOwn\nOwn aircraft\nOwn campaign\n1 1\n2026 03 01 2026 03 02\n0.0400\nTime [seconds]; UT seconds from midnight\n3\n1.0 0.1 0.01\n999999.9999 99999 9999\nAngle of attack [deg]\nElevator [deg]\nMach number\n0\n2\nPreliminary Data\nTime ALPHA DE MACH\ns deg deg none\n36900.00 3.0 -10 12\n36900.04 999999.9999 -11 13\n36900.08 3.2 -12 9999\n";
    let flight = read(text).maneuver;
    assert_read(&flight, 3, 0.08, ("ALPHA", 3.0, "deg"));
    assert_read(&flight, 3, 0.08, ("DE", -1.0, "deg"));
    assert_read(&flight, 3, 0.08, ("MACH", 0.12, "-"));
    assert!(flight.channels()["ALPHA"].values[1].is_nan());
    assert!(flight.channels()["MACH"].values[2].is_nan());
    // ICARTT, the same with commas
    let icartt = "17, 1001\nOwn\nOwn\nOwn\nOWN\n1, 1\n2026, 03, 01, 2026, 04, 02\n0.02\nTime_Start, seconds, since midnight UTC\n2\n1, 1\n-9999, -9999\nAlpha, deg, angle of attack\nPs, hPa, static pressure\n0\n1\nTime_Start, Alpha, Ps\n36900.00, 3.0, 870.1\n36900.02, -9999, 870.1\n";
    let flight = read(icartt).maneuver;
    assert_read(&flight, 2, 0.02, ("Ps", 870.1, "hPa"));
    assert!(flight.channels()["Alpha"].values[1].is_nan());
    // a header that is longer than the file is none
    assert!(
        reading(
            &icartt.replace("17, 1001", "18446744073709551615, 1001"),
            None
        )
        .is_err()
    );
    let skipped = mapping(r#"{"skip": 9223372036854775807, "channels": {"a": {"from": "(:,1)"}}}"#);
    assert!(reading(icartt, Some(&skipped)).is_err());
}

/// A header of NASA Ames with this line for time and these for the end of the header, over rows of two variables.
fn ames(time: &str, end: &[&str]) -> String {
    let lines = [
        "Own, Making",
        "Own",
        "Own aircraft",
        "Own campaign",
        "1 1",
        "2026 03 01 2026 03 02",
        "0.02",
        time,
        "2",
        "0.1 1",
        "-9999 -9999",
        "Angle of attack [deg]",
        "Mach number",
        "0",
    ];
    let count = 1 + lines.len() + end.len();
    let header = [&lines[..], end].concat().join("\n");
    format!("{count} 1001\n{header}\n36900.00 30 0.5\n36900.02 -9999 0.6\n36900.04 -8888 0.7\n")
}

const UT: &str = "Elapsed UT seconds from 0 hours on the day given by DATE";

/// Gaines and Hipskind put no meaning into comments: words are no names because there are as many of them.
#[test]
fn comments_of_nasa_ames_are_no_names() {
    let comment = ames(UT, &["1", "Calibrated before flight"]);
    let read = read(&comment);
    assert_read(&read.maneuver, 3, 0.04, ("Angle_of_attack", 3.0, "deg"));
    assert!(told(&read, "no_unit").contains("Mach_number"));
    let named = ames(UT, &["2", "UT alpha M", "s deg none"]);
    let read = reading(&named, None).unwrap();
    assert_read(&read.maneuver, 3, 0.04, ("M", 0.5, "-"));
    assert_eq!(told(&read, "no_unit"), "");
    // a row of other units than the header's is none
    let other = reading(&ames(UT, &["2", "UT alpha M", "s rad none"]), None).unwrap();
    assert_read(&other.maneuver, 3, 0.04, ("Angle_of_attack", 3.0, "deg"));
}

/// The unit of the independent variable is free text in the format: it is found, or asked for, and never made up.
#[test]
fn time_of_nasa_ames_is_in_the_unit_that_it_says() {
    for (time, seconds) in [("Time [ms]", 0.04e-3), ("Hours after midnight (h)", 144.0)] {
        let read = read(&ames(time, &["0"]));
        assert_read(&read.maneuver, 3, seconds, ("Angle_of_attack", 3.0, "deg"));
    }
    let below = read(&ames(
        "Universal time",
        &["2", "UT alpha M", "min deg none"],
    ));
    assert_read(&below.maneuver, 3, 2.4, ("alpha", 3.0, "deg"));
    let unknown = reading(&ames("Time [fortnights]", &["0"]), None).unwrap_err();
    let fault = &unknown.faults()[0];
    assert_eq!(fault.code, code::TIME_UNIT);
    assert!(
        fault.message.starts_with("line 9: 'Time [fortnights]'"),
        "{fault}"
    );
    // with the draft, in which the unit is said, it is read
    let draft = unknown
        .draft()
        .unwrap()
        .replacen('?', "s", 1)
        .replacen('?', "-", 1);
    let read = reading(&ames("Time [fortnights]", &["0"]), Some(&mapping(&draft))).unwrap();
    assert_read(&read.maneuver, 3, 0.04, ("Angle_of_attack", 3.0, "deg"));
    assert!(read.maneuver.channels()["Angle_of_attack"].values[1].is_nan());
    for (from, to, place) in [
        ("\n0.1 1\n", "\n0.1 one\n", "line 11: "),
        ("\n-9999 -9999\n", "\n-9999\n", "line 13: "),
        ("\n2\n0.1", "\ntwo\n0.1", "line 10: "),
    ] {
        let broken = ames(UT, &["0"]).replace(from, to);
        let refused = reading(&broken, None).unwrap_err();
        assert!(refused.to_string().starts_with(place), "{refused}");
    }
}

/// ICARTT's "Format Document", 2.3.2: values beyond the limits of detection have flags of their own.
#[test]
fn flags_of_icartt_are_no_values() {
    let flagged = ames(UT, &["2", "ULOD_FLAG: -7777", "LLOD_FLAG: -8888"]);
    let alpha = read(&flagged).maneuver.channels()["Angle_of_attack"]
        .values
        .clone();
    assert_eq!(alpha[0], 3.0_f64.to_radians());
    assert!(alpha[1].is_nan() && alpha[2].is_nan());
}

/// What is drafted reads the same as the file itself, once what is asked for is said.
#[test]
fn a_draft_of_nasa_ames_has_factors_and_missing_values() {
    let text = ames(UT, &["2", "UT alpha M", "s deg none"]);
    let limits = Limits::default();
    let inspected = inspect(text.as_bytes(), Format::Unstated, None, None, &limits);
    let inspected = inspected.unwrap().unwrap();
    let titles: Vec<_> = inspected
        .columns
        .iter()
        .map(|c| (&*c.title, &*c.unit, &*c.first))
        .collect();
    let first = titles[1..].to_vec();
    assert_eq!(first, [("alpha", "deg", "30"), ("M", "-", "0.5")]);
    let whole = inspected.reading.unwrap().maneuver;
    assert_read(&whole, 3, 0.04, ("alpha", 3.0, "deg"));
    for drafted in [
        Mapping::from_toml(&inspected.draft.to_toml()).unwrap(),
        mapping(&inspected.draft.to_json()),
    ] {
        let drafted = reading(&text, Some(&drafted)).unwrap().maneuver;
        assert_eq!(drafted.digest(), whole.digest());
    }
}
