//! Files as programs and devices write them that say names, times or factors elsewhere than over their columns. All numbers are of our
//! own making; where the facts of a layout come from stands beside each.

use trimtab_core::flight::{Maneuver, Unit};
use trimtab_core::ingest::{
    Format, IngestError, Limits, Mapping, Reading, code, inspect, read_recording,
};

fn reading(text: &str, mapping: Option<&Mapping>) -> Result<Reading, IngestError> {
    let limits = Limits::default();
    read_recording(text.as_bytes(), Format::Unstated, None, mapping, &limits)
}

fn read(text: &str) -> Reading {
    reading(text, None).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

fn mapping(text: &str) -> Mapping {
    Mapping::from_json(text).unwrap()
}

/// A channel has this first value in this unit, and the recording so many samples over so many seconds.
fn assert_read(maneuver: &Maneuver, samples: usize, seconds: f64, channel: (&str, f64, &str)) {
    assert_eq!(maneuver.len(), samples);
    let duration = maneuver.duration();
    assert!((duration - seconds).abs() < 1e-9, "{duration} s");
    let (name, first, unit) = channel;
    let names: Vec<&String> = maneuver.channels().keys().collect();
    let found = maneuver.channels().get(name);
    let found = found.unwrap_or_else(|| panic!("{name} is not among {names:?}"));
    let expected = Unit::parse(unit).unwrap().to_si(first);
    let value = found.values[0];
    assert!(
        (value - expected).abs() < 1e-12,
        "{value} is not {expected}"
    );
}

fn told(reading: &Reading, code: &str) -> String {
    let mut findings = reading.findings.iter();
    let found = findings.find(|finding| finding.code == code);
    found.map_or(String::new(), |finding| finding.message.clone())
}

/// LabVIEW's "Specification for the LabVIEW Measurement File": without a column of X, `Delta_X` says the step.
#[test]
fn a_step_that_the_header_says_is_taken_where_no_column_has_times() {
    let labview = |step: &str| {
        format!(
            "LabVIEW Measurement\t\nX_Columns\tNo\n***End_of_Header***\t\n\t\nChannels\t2\t\t\nSamples\t3\t3\t\nY_Unit_Label\tdeg\tdeg/s\t\nX_Dimension\tTime\tTime\t\nX0\t0.0\t0.0\t\nDelta_X\t{step}\t\n***End_of_Header***\t\t\t\nX_Value\tAlpha\tPitch rate\tComment\n\t3.0\t0.5\n\t3.1\t0.6\n\t3.2\t0.7\n"
        )
    };
    let even = read(&labview("0.040000\t0.040000"));
    assert_read(&even.maneuver, 3, 0.08, ("Alpha", 3.0, "deg"));
    assert_eq!(even.maneuver.channels().len(), 2);
    assert!(told(&even, "recognised").contains("labview"));
    // two rates in one table are no recording with one step
    assert!(reading(&labview("0.040000\t0.020000"), None).is_err());
    // MT Manager (Xsens) writes the rate in a comment
    let counted = "// Start Time: Unknown\n// Sample rate: 50.0Hz\nPacketCounter\tAcc_X\tGyr_X\tGyr_Y\n07000\t0.3\t0.01\t0.2\n07001\t0.3\t0.01\t0.3\n07002\t0.3\t0.01\t0.4\n";
    let counted = read(counted);
    assert_read(&counted.maneuver, 3, 0.04, ("q", 0.2, "rad/s"));
    let said = counted
        .findings
        .iter()
        .any(|finding| finding.message.contains("as line 2 says"));
    assert!(said, "{:?}", counted.findings);
    // a comma in it may stand between thousands: the numbers of the table tell, or it is asked for
    let rate = |rate: &str, row: &str| {
        let rows = [row; 3].map(|row| format!("{row}\n")).concat();
        reading(
            &format!("Sample rate: {rate} Hz\n\na [deg];b [deg]\n{rows}"),
            None,
        )
    };
    for (said, row, seconds) in [
        ("1,000", "1.5;2", 0.002),
        ("1,000", "1,5;2", 2.0),
        ("1.000", "1,5;2", 0.002),
        ("1.000", "1;2", 2.0),
        ("1,000.0", "1;2", 0.002),
        ("12,5", "1;2", 0.16),
    ] {
        let duration = rate(said, row).unwrap().maneuver.duration();
        assert!(
            (duration - seconds).abs() < 1e-9,
            "{said}, {row}: {duration}"
        );
    }
    let doubtful = rate("1,000", "1;2").unwrap_err();
    assert_eq!(doubtful.faults()[0].code, code::AMBIGUOUS_NUMBER);
    assert!(
        doubtful.to_string().starts_with("line 1: the comma"),
        "{doubtful}"
    );
    // a column of times goes before what the header says
    let both = read("Sample rate;50\n\nt [s];a [deg]\n0;1\n0.1;2\n0.2;3\n");
    assert_read(&both.maneuver, 3, 0.2, ("a", 1.0, "deg"));
    // and a rate of something else is none
    assert!(reading("Rate: 50 deg/s\n\na [deg];b [deg]\n0;1\n1;2\n2;3\n", None).is_err());
}

/// `X_Columns Multi` of the same specification: the times stand before each channel.
#[test]
fn times_that_stand_again_are_no_channel() {
    let multi = "LabVIEW Measurement\t\nX_Columns\tMulti\n***End_of_Header***\t\n\t\nChannels\t2\t\t\t\nY_Unit_Label\tdeg\t\tdeg/s\t\nX_Dimension\tTime\t\tTime\t\nDelta_X\t0.02\t\t0.02\t\n***End_of_Header***\t\t\t\t\nX_Value\talpha\tX_Value\tq\tComment\n0.00\t3.0\t0.00\t0.5\n0.02\t3.1\t0.02\t0.6\n0.04\t3.2\t0.04\t0.7\n";
    let multi = read(multi).maneuver;
    assert_read(&multi, 3, 0.04, ("q", 0.5, "deg/s"));
    let names: Vec<&String> = multi.channels().keys().collect();
    assert_eq!(names, ["alpha", "q"]);
}

/// LabChart's text export (ADInstruments' knowledge base, "How can channel titles, ranges, intervals ... be imported").
#[test]
fn labchart_says_in_the_first_cell_what_a_line_is() {
    let chart = "Interval=\t0.02 s\nTimeFormat=\tStartOfBlock\nDateFormat=\t\nChannelTitle=\tElevator\tPitch rate\nRange=\t10.000 V\t100.0 V\nUnitName=\tdeg\tdeg/s\n7.00\t-1.5\t0.5\t#1 doublet\n7.02\t-1.5\t0.6\n7.04\t-1.5\t0.7\n";
    let chart = read(chart).maneuver;
    assert_read(&chart, 3, 0.04, ("Elevator", -1.5, "deg"));
    assert_eq!(chart.channels().len(), 2);
}

/// Recorders of flights in MSFS, and phones: the title of the times is their unit.
#[test]
fn a_title_may_be_a_unit_of_time() {
    for (title, step, seconds) in [
        ("Milliseconds", 50, 0.1),
        ("Seconds", 1, 2.0),
        ("usec", 4000, 0.008),
    ] {
        let row = |at: i32| format!("{},{},0.1\n", 1000 + step * at, 5 + at);
        let text = format!(
            "{title},Pitch [deg],AngleOfAttack [rad]\n{}{}{}",
            row(0),
            row(1),
            row(2)
        );
        assert_read(&read(&text).maneuver, 3, seconds, ("Pitch", 5.0, "deg"));
    }
    // beside a time it is a channel
    let both = read("t [s],Seconds\n0,7\n1,8\n2,9\n").maneuver;
    assert_read(&both, 3, 2.0, ("Seconds", 7.0, "-"));
}

/// CloudAhoy's CSV: units stand before the names.
#[test]
fn units_may_stand_before_names() {
    let text = "Metadata,CA_CSV.3\nTAIL,OWN\nDATA,\nseconds/t,degrees/Pitch,feet/ALT (GPS),knots/IAS,G/G-load\n0.0,2.5,4200,95,1.0\n0.5,2.6,4201,95,1.0\n1.0,2.7,4202,95,1.1\n";
    let flight = read(text).maneuver;
    assert_read(&flight, 3, 1.0, ("Pitch", 2.5, "deg"));
    assert_read(&flight, 3, 1.0, ("IAS", 95.0, "kt"));
    // a title with a slash in it is no unit and a name
    let other = read("t [s],q [deg/s],L/D [-]\n0,1,12\n1,2,13\n").maneuver;
    assert_read(&other, 2, 1.0, ("L_D", 12.0, "-"));
}

/// MT Manager's UTC columns: nanoseconds stand before the year, and columns that the device does not fill are empty.
#[test]
fn parts_of_a_time_stand_in_any_order() {
    let row = |nano: i64, second: i32, rate: f64| {
        format!("31000\t\t\t\t\t{nano}\t2026\t3\t1\t10\t15\t{second}\t23\t0.3\t0.1\t{rate}\n")
    };
    let text = format!(
        "// General information:\nPacketCounter\tYear\tMonth\tDay\tSecond\tUTC_Nano\tUTC_Year\tUTC_Month\tUTC_Day\tUTC_Hour\tUTC_Minute\tUTC_Second\tUTC_Valid\tAcc_X\tGyr_X\tGyr_Y\n{}{}{}",
        row(980_000_000, 59, 0.2),
        row(990_000_000, 59, 0.3),
        row(10_000_000, 60, 0.4).replace("\t15\t60", "\t16\t0"),
    );
    assert_read(&read(&text).maneuver, 3, 0.03, ("q", 0.2, "rad/s"));
}

/// VBOX files (Racelogic, "VBO file format"): sections, time of day as one number, minutes of arc, west positive.
#[test]
fn a_vbox_file_says_its_columns_in_a_section() {
    let text = "File created on 01/03/2026 at 10:15:00\n\n[header]\nsatellites\ntime\n\n[comments]\nown\n\n[column names]\nsats time lat long velocity heading height Pitch\n\n[data]\n012 095959.90 +02826.000000 -00486.000000 172.800 084.10 +01311.20 +2.5\n012 100000.00 +02826.000120 -00486.000060 172.900 084.10 +01311.30 +2.6\n012 100000.10 +02826.000240 -00486.000120 173.000 084.10 +01311.40 +2.7\n";
    let drive = read(text);
    assert_read(&drive.maneuver, 3, 0.2, ("V_ground", 48.0, "m/s"));
    assert_read(&drive.maneuver, 3, 0.2, ("lat", 47.1, "deg"));
    assert_read(&drive.maneuver, 3, 0.2, ("lon", 8.1, "deg"));
    assert!(told(&drive, "recognised").contains("vbox"));
    // of the vertical velocity the file does not say the unit, and firmware differs in it
    let climbing = text.replace("height Pitch", "height vert-vel");
    let climbing = read(&climbing);
    assert_read(&climbing.maneuver, 3, 0.2, ("vert_vel", 2.5, "-"));
    assert!(told(&climbing, "no_unit").contains("vert_vel"));
}

/// Tecplot's "Data Format Guide": `VARIABLES` over one or several lines.
#[test]
fn tecplot_names_its_variables_before_the_zone() {
    for variables in [
        "VARIABLES = \"t [s]\"\n\"alpha [deg]\"\n\"q [deg/s]\"",
        "variables=\"t [s]\", \"alpha [deg]\", \"q [deg/s]\"",
    ] {
        let text = format!(
            "TITLE = \"run\"\n{variables}\nZONE T=\"run 1\", I=3, F=POINT\n 0.00 3.0 0.5\n 0.02 3.1 0.6\n 0.04 3.2 0.7\n"
        );
        assert_read(&read(&text).maneuver, 3, 0.04, ("q", 0.5, "deg/s"));
    }
}

/// R's `write.table` and pandas' `to_csv(sep=" ")`: rows have a number that has no title.
#[test]
fn numbers_of_rows_need_no_title() {
    for text in [
        "\"t_s\" \"alpha_deg\"\n\"1\" 0 3\n\"2\" 0.1 4\n\"3\" 0.2 5\n",
        "t[s] alpha_deg\n0 0.0 3.0\n1 0.1 4.0\n2 0.2 5.0\n",
    ] {
        let maneuver = read(&text.replace("t_s", "t [s]")).maneuver;
        assert_read(&maneuver, 3, 0.2, ("alpha_deg", 3.0, "deg"));
    }
    // what is not counted may be a value without a title
    assert!(
        reading(
            "t[s] alpha_deg\n0.5 0.0 3.0\n1.7 0.1 4.0\n2.1 0.2 5.0\n",
            None
        )
        .is_err()
    );
}

/// A line of nothing but units in brackets has no names.
#[test]
fn units_alone_are_no_names() {
    let text = "     TIME     ANGLE OF     PITCH\n              ATTACK       RATE\n     (SEC)    (DEG)      (DEG/SEC)\n  -------- ---------- ----------\n    0.0000     3.0000     4.1000\n    0.0200     3.1000     4.2000\n";
    let error = reading(text, None).unwrap_err();
    assert_eq!(error.faults()[0].code, code::MAPPING_NEEDED, "{error}");
    let by_number = r#"{"time": {"from": "(:,1)"}, "channels": {"alpha": {"from": "(:,2)"}, "q": {"from": "(:,3)"}}}"#;
    let read = reading(text, Some(&mapping(by_number))).unwrap();
    assert_read(&read.maneuver, 2, 0.02, ("q", 4.1, "deg/s"));
}

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

/// What has no columns of samples is refused by its name, with what makes CSV of it.
#[test]
fn other_logs_are_refused_by_name() {
    for (text, expected) in [
        (
            "$GPGGA,101500.00,4706.0,N,00806.0,E,1,12,0.8,1311.2,M,48.0,M,,*55\n",
            "NMEA",
        ),
        (
            "$GNRMC,101500.00,A,4706.0,N,00806.0,E,93.3,84.4,010326,,,A*55\n",
            "gpsbabel",
        ),
        (
            "AXXXOWN\r\nHFDTE010326\r\nB1015004706000N00806000EA0131101351\r\n",
            ".igc",
        ),
        (
            "date Sun Mar 1 10:15:00.513 am 2026\nbase hex  timestamps absolute\n   0.000000 1  120  Rx   d 2 01 02\n",
            "CAN bus",
        ),
        (
            "IGOR\r\nWAVES/D a\r\nBEGIN\r\n1\r\nEND\r\nWAVES/D b\r\nBEGIN\r\n1\r\nEND\r\n",
            "Igor",
        ),
    ] {
        let error = reading(text, None).unwrap_err();
        assert_eq!(error.faults()[0].code, code::FORMAT_NOT_READ, "{text}");
        assert!(error.to_string().contains(expected), "{error}");
    }
}

/// `--.--` is what a ground station shows where it has no value.
#[test]
fn dashes_with_points_are_no_value() {
    let text = "t [s],V [m/s],h [m]\n0,48,--.--\n1,49,120.5\n2,--.--,121.5\n";
    let flight = read(text).maneuver;
    assert!(flight.channels()["h"].values[0].is_nan());
    assert!(flight.channels()["V"].values[2].is_nan());
    assert_eq!(flight.channels()["h"].values[1], 120.5);
}
