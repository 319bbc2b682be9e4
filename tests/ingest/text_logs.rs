//! Logs of ArduPilot as text, as ground stations write them. All numbers are of our own making.

use trimtab_core::flight::Unit;

use crate::programs::{assert_read, mapping, read, reading, told};

/// Mission Planner's text of a DataFlash log: a line for each message, numbers as they are meant.
#[test]
fn a_log_of_ardupilot_as_text_is_the_log() {
    let mut text = String::from(
        "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\nFMT, 130, 40, IMU, QBff, TimeUS,I,GyrX,GyrY\nFMT, 131, 27, ATT, Qcc, TimeUS,Roll,Pitch\nFMT, 132, 70, MSG, QZ, TimeUS,Message\nFMT, 133, 19, GPS, QLL, TimeUS,Lat,Lng\nFMT, 134, 76, UNIT, QbZ, TimeUS,Id,Label\nFMT, 135, 20, MULT, Qbd, TimeUS,Id,Mult\nFMT, 136, 44, FMTU, QBNN, TimeUS,FmtType,UnitIds,MultIds\n",
    );
    text += "UNIT, 0, 115, s\nUNIT, 0, 100, deg\nMULT, 0, 66, 0.01\nMULT, 0, 70, 1E-06\nFMTU, 0, 131, sdd, FBB\nMSG, 900000, ArduPlane, of our own\n";
    for at in 0..10 {
        let time = 1_000_000 + 20_000 * at;
        text += &format!("IMU, {time}, 0, 0.01, {}\n", 0.1 * f64::from(at));
        if at % 5 == 0 {
            text += &format!("ATT, {}, -1.25, {}.50\n", time + 300, 2 + at);
            text += &format!("GPS, {}, 47.1234567, -8.7654321\n", time + 300);
        }
    }
    text += "IMU, 12000";
    let log = read(&text).maneuver;
    assert_eq!(log.len(), 12);
    let first = |name: &str, unit: &str| {
        let values = &log.channels()[name].values;
        let value = values.iter().find(|value| !value.is_nan()).unwrap();
        value / Unit::parse(unit).unwrap().scale
    };
    assert_eq!(log.channels()["q"].values[0], 0.0);
    for (name, unit, expected) in [
        ("phi", "deg", -1.25),
        ("theta", "deg", 2.5),
        ("lat", "deg", 47.123_456_7),
        ("lon", "deg", -8.765_432_1),
    ] {
        let found = first(name, unit);
        assert!((found - expected).abs() < 1e-9, "{name}: {found}");
    }
    // units are those that the log says
    let own = mapping(r#"{"channels": {"theta": {"from": "ATT.Pitch"}}}"#);
    let own = reading(&text, Some(&own)).unwrap().maneuver;
    assert_read(&own, 2, 0.1, ("theta", 2.5, "deg"));
    let silent = mapping(r#"{"channels": {"p": {"from": "IMU.GyrX"}}}"#);
    let silent = reading(&text, Some(&silent)).unwrap_err();
    assert_eq!(silent.faults()[0].pointer, "/channels/p/unit");
}

/// A log of two messages as text: the angle of roll with two decimals, as `c` is written, and a rate.
fn attitude(rows: &str) -> String {
    format!(
        "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\nFMT, 131, 27, ATT, QcBf, TimeUS,Roll,I,Rate\n{rows}"
    )
}

/// A cell that is no number has no value, and is told; a number is not cut to the size that the binary log has for it.
#[test]
fn a_log_as_text_has_no_number_that_it_does_not_say() {
    let roll = mapping(
        r#"{"channels": {"phi": {"from": "ATT.Roll", "unit": "deg"}, "p": {"from": "ATT.Rate", "unit": "deg/s"}}}"#,
    );
    let text = attitude(
        "ATT, 1000000, 1.25, 0, 2\nATT, 1020000, x1.5, 0, 3\nATT, 1040000, 400.55, 0, 1e999\nATT, 1060000, nan, 0, 5\nATT, 1080000, 2.5, 0, 6\n",
    );
    let log = reading(&text, Some(&roll)).unwrap();
    assert_eq!(log.maneuver.len(), 5);
    let phi = &log.maneuver.channels()["phi"].values;
    assert_eq!(phi[0], 1.25_f64.to_radians());
    assert!(phi[1].is_nan() && phi[3].is_nan());
    assert!((phi[2].to_degrees() - 400.55).abs() < 1e-9, "{}", phi[2]);
    assert!(log.maneuver.channels()["p"].values[2].is_nan());
    let missing = told(&log, "missing_values");
    assert!(missing.starts_with("2 cell(s) are no numbers"), "{missing}");
    assert!(missing.contains("'x1.5' in line 4"), "{missing}");
    // decimal commas part numbers: such a line is not read with its cells shifted
    let commas = attitude(
        "ATT, 1000000, 1.25, 0, 2\nATT, 1020000, 1,5, 0, 3\nATT, 1040000, 1.5, 0, 4\nATT, 1060000, 1.7, 0, 4,\nATT, 108",
    );
    let log = reading(&commas, Some(&roll)).unwrap();
    assert_eq!(log.maneuver.len(), 3);
    assert!(told(&log, "left_out").contains("the first of them line 4"));
    assert!(told(&log, "incomplete_line").contains("line 7"));
    // of which sensor a message is that does not say it is not known
    let unsaid =
        attitude("ATT, 1000000, 1.25, 0, 2\nATT, 1020000, 9.5, ?, 3\nATT, 1040000, 1.5, 0, 4\n");
    let log = reading(&unsaid, Some(&roll)).unwrap();
    assert_eq!(log.maneuver.time(), [1.0, 1.04]);
}
