//! Files as programs and devices write them that say names, times or factors elsewhere than over their columns. All numbers are of our
//! own making; where the facts of a layout come from stands beside each.

use trimtab_core::flight::{Maneuver, Unit};
use trimtab_core::ingest::{Format, IngestError, Limits, Mapping, Reading, code, read_recording};

use crate::common::layouts::layouts;

pub(crate) fn reading(text: &str, mapping: Option<&Mapping>) -> Result<Reading, IngestError> {
    let limits = Limits::default();
    read_recording(text.as_bytes(), Format::Unstated, None, mapping, &limits)
}

pub(crate) fn read(text: &str) -> Reading {
    reading(text, None).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

/// The file of a layout.
fn file(name: &str) -> &'static str {
    let mut layouts = layouts().into_iter();
    let found = layouts.find(|layout| layout.name == name);
    found.expect("a layout of this name").file
}

pub(crate) fn mapping(text: &str) -> Mapping {
    Mapping::from_json(text).unwrap()
}

/// A channel has this first value in this unit, and the recording so many samples over so many seconds.
pub(crate) fn assert_read(
    maneuver: &Maneuver,
    samples: usize,
    seconds: f64,
    channel: (&str, f64, &str),
) {
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

pub(crate) fn told(reading: &Reading, code: &str) -> String {
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
    let chart = read(file("LabChart")).maneuver;
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
    let flight = read(file("CloudAhoy")).maneuver;
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
    let text = file("VBOX");
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
    let one_line = "TITLE = \"run\"\nvariables=\"t [s]\", \"alpha [deg]\", \"q [deg/s]\"\nZONE T=\"run 1\", I=3, F=POINT\n 0.00 3.0 0.5\n 0.02 3.1 0.6\n 0.04 3.2 0.7\n";
    for text in [file("Tecplot"), one_line] {
        assert_read(&read(text).maneuver, 3, 0.04, ("q", 0.5, "deg/s"));
    }
}

/// R's `write.table` and pandas' `to_csv(sep=" ")`: rows have a number that has no title.
#[test]
fn numbers_of_rows_need_no_title() {
    for text in [
        file("R, write.table"),
        "t[s] alpha_deg\n0 0.0 3.0\n1 0.1 4.0\n2 0.2 5.0\n",
    ] {
        let maneuver = read(text).maneuver;
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
