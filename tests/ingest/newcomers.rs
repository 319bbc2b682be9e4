//! Files as a newcomer has them: what they say is taken, and what they do not say is asked for.

use trimtab_core::flight::Unit;
use trimtab_core::ingest::{Format, Limits, Mapping, Reading, read_recording};

fn read(text: &str) -> Result<Reading, String> {
    read_recording(text.as_bytes(), Format::Csv, None, None, &Limits::default())
        .map_err(|error| error.to_string())
}

/// The channels of a file with their units, and its seconds.
fn told(text: &str) -> (Vec<String>, f64) {
    let reading = read(text).unwrap_or_else(|error| panic!("{text}\n{error}"));
    let maneuver = reading.maneuver;
    let channels = maneuver.channels().iter();
    let channels = channels.map(|(name, channel)| format!("{name}[{}]", channel.recorded_unit));
    let seconds = (maneuver.duration() * 1e6).round() / 1e6;
    (channels.collect(), seconds)
}

#[test]
fn units_mean_what_flight_tests_record() {
    for (written, meant) in [
        ("deg K", "K"),
        ("LB/FT^2", "psf"),
        ("lb/in^2", "psi"),
        ("ft lb", "ft*lbf"),
        ("deg*100", "0.01 deg"),
        ("degE7", "1e-7 deg"),
        ("deg.", "deg"),
        ("deg (TEU +)", "deg"),
        ("rad (0-2pi)", "rad"),
        ("g's", "g"),
        ("per deg", "1/deg"),
        ("decimal degrees", "deg"),
    ] {
        let (written, meant) = (Unit::parse(written), Unit::parse(meant));
        assert_eq!(written.ok(), meant.ok());
    }
    for written in ["n.m.", "deg (", "furlong (long)"] {
        assert!(Unit::parse(written).is_err(), "{written}");
    }
}

#[test]
fn titles_with_units_go_before_short_ones_without() {
    let text = "Lcl Time (hh:mm:ss),True Airspeed (kt),Pitch (deg),Normal Acceleration (G),Fix (enum)\n\
                Lcl Time,TAS,Pitch,NormAc,GPSfix\n10:15:00,100,2,1,3D\n10:15:01,101,3,1,3D\n";
    let channels = ["True_Airspeed[kt]", "Pitch[deg]", "Normal_Acceleration[G]"];
    let mut found = told(text).0;
    found.sort();
    let mut expected = channels.map(str::to_string);
    expected.sort();
    assert_eq!(found, expected);
}

#[test]
fn units_stand_behind_a_dash_a_slash_or_a_word() {
    for title in ["Alpha - deg", "Alpha / deg", "Alpha in deg"] {
        let text = format!("Time - s,{title},Fuel - L\n0,1,2\n0.02,2,3\n");
        let (channels, seconds) = told(&text);
        assert!(channels.contains(&"Alpha[deg]".to_string()), "{channels:?}");
        assert!(channels.contains(&"Fuel_L[-]".to_string()), "{channels:?}");
        assert_eq!(seconds, 0.02);
    }
}

#[test]
fn headers_are_commented_as_programs_do() {
    for head in [
        "// run 3\n// t,alpha\n// s,deg\n",
        "! run 3\n! t,alpha\n! s,deg\n",
        "; run 3\n; t,alpha\n; s,deg\n",
    ] {
        let text = format!("{head}0,1\n0.02,2\n0.04,3\n");
        assert_eq!(
            told(&text),
            (vec!["alpha[deg]".to_string()], 0.04),
            "{head}"
        );
    }
    // a first column without a title
    let numbered = told("; t[s]; alpha[deg]\n0; 0,00; 1,5\n1; 0,02; 2,5\n");
    assert_eq!(numbered, (vec!["alpha[deg]".to_string()], 0.02));
}

#[test]
fn the_second_flysight_says_columns_and_units_by_words() {
    let text = "$FLYS,1\n$VAR,DEVICE_ID,00\n$COL,GNSS,time,lat,velN\n$UNIT,GNSS,,deg,m/s\n$DATA\n\
                $GNSS,2026-05-04T14:00:00.000Z,47.1,40.5\n$GNSS,2026-05-04T14:00:00.200Z,47.2,40.6\n\
                $GNSS,2026-05-04T14:00:00.400Z,47.3,40.7\n";
    let expected = ["lat[deg]", "velN[m/s]"].map(str::to_string);
    assert_eq!(told(text), (expected.to_vec(), 0.4));
}

#[test]
fn labview_repeats_time_before_each_channel_and_says_units() {
    let text = "LabVIEW Measurement\t\nX_Columns\tMulti\n***End_of_Header***\t\n\t\n\
                Channels\t2\t\t\t\nY_Unit_Label\tdeg\t\tdeg/s\t\nX0\t0.0\t\t0.0\t\nDelta_X\t0.01\t\t0.01\t\n***End_of_Header***\t\t\t\t\n\
                X_Value\tAlpha\tX_Value\tRate\tComment\n0.00\t3\t0.00\t1\n0.01\t4\t0.01\t2\n0.02\t5\t0.02\t3\n0.03\t6\t0.03\t4\n";
    let (channels, seconds) = told(text);
    assert_eq!(seconds, 0.03);
    for channel in ["Alpha[deg]", "Rate[deg/s]"] {
        assert!(channels.contains(&channel.to_string()), "{channels:?}");
    }
    // times that differ are not taken for one another
    let other = text.replace("5\t0.02", "5\t0.025");
    assert!(read(&other).unwrap_err().contains("several columns"));
}

#[test]
fn stamps_of_other_programs_are_read() {
    for (first, second) in [
        ("0 days 00:00:01", "0 days 00:00:01.500000"),
        ("1 day, 0:00:01.0", "1 day, 0:00:01.5"),
        ("325:10:15:00:000", "325:10:15:00:500"),
        ("26:325:10:15:00.0", "26:325:10:15:00.5"),
        ("325/10:15:00.0", "325/10:15:00.5"),
        ("2026-11-21_10-15-00.0", "2026-11-21_10-15-00.5"),
        ("20261121 101500.0", "20261121 101500.5"),
        ("21NOV2026:10:15:00.0", "21NOV2026:10:15:00.5"),
    ] {
        let text = format!("time,q[deg/s]\n\"{first}\",1\n\"{second}\",2\n");
        assert_eq!(told(&text).1, 0.5, "{first}");
    }
    let weeks = "week,tow_ms,q[deg/s]\n2417,604799900,1\n2418,100,2\n";
    assert_eq!(told(weeks).1, 0.2);
}

#[test]
fn a_step_that_no_one_said_is_asked_for() {
    let text = "Sample,q[deg/s]\n0,1\n1,2\n2,3\n";
    let limits = Limits::default();
    let refused = read_recording(text.as_bytes(), Format::Csv, None, None, &limits).unwrap_err();
    let draft = Mapping::from_json(refused.draft().unwrap())
        .unwrap()
        .to_toml();
    assert!(draft.contains("unit = \"?\""), "{draft}");
    let as_drafted = Mapping::from_toml(&draft).unwrap();
    assert!(
        read_recording(
            text.as_bytes(),
            Format::Csv,
            None,
            Some(&as_drafted),
            &limits
        )
        .is_err()
    );
    let filled = draft.replace("unit = \"?\", step = 1.0", "unit = \"ms\", step = 20.0");
    let filled = Mapping::from_toml(&filled.replace('?', "-")).unwrap();
    let read = read_recording(text.as_bytes(), Format::Csv, None, Some(&filled), &limits).unwrap();
    assert!((read.maneuver.duration() - 0.04).abs() < 1e-12);
}

#[test]
fn a_text_log_of_ardupilot_without_messages_is_refused_with_its_name() {
    let refused = read("FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\nATT, 1, 2\n");
    let refused = refused.unwrap_err();
    assert!(
        refused.contains("ArduPilot") && refused.contains(".bin"),
        "{refused}"
    );
}

#[test]
fn a_second_column_of_times_is_told() {
    let text = "t_imu[s],q[deg/s],t_air[s],alpha[deg]\n0.00,1,0.001,3\n0.01,2,0.021,4\n0.02,3,,\n0.03,4,,\n";
    let codes = |text: &str| -> Vec<String> {
        let findings = read(text).unwrap().findings;
        let codes = findings
            .iter()
            .map(|finding| finding.code.as_str().to_string());
        codes.collect()
    };
    assert_eq!(codes(text), ["other_times"]);
    // times beside the first in every row are those of a second clock
    let full = text
        .replace("0.02,3,,", "0.02,3,0.041,5")
        .replace("0.03,4,,", "0.03,4,0.061,6");
    assert!(codes(&full).is_empty());
}
