//! Times that stand in several columns.

use trimtab_core::ingest::{Format, IngestError, Limits, Mapping, Reading, read_recording};

fn read(text: &str, mapping: Option<&Mapping>) -> Result<Reading, IngestError> {
    let limits = Limits::default();
    read_recording(text.as_bytes(), Format::Csv, None, mapping, &limits)
}

fn mapped(mapping: &str, text: &str) -> Result<Reading, String> {
    let mapping = Mapping::from_toml(mapping).map_err(|fault| fault.to_string())?;
    read(text, Some(&mapping)).map_err(|error| error.to_string())
}

/// The times since the first, and the channels.
fn told(reading: Result<Reading, String>) -> (Vec<f64>, Vec<String>) {
    let maneuver = reading.unwrap_or_else(|error| panic!("{error}")).maneuver;
    let first = maneuver.time()[0];
    let times = maneuver
        .time()
        .iter()
        .map(|time| ((time - first) * 1e9).round() / 1e9);
    (
        times.collect(),
        maneuver.channels().keys().cloned().collect(),
    )
}

fn plain(text: &str) -> Result<Reading, String> {
    read(text, None).map_err(|error| error.to_string())
}

#[test]
fn hours_minutes_and_seconds_are_found_by_their_titles() {
    for text in [
        "Hour,Min,Sec,alpha[deg]\n23,59,59.5,1\n23,59,59.75,2\n0,0,0,3\n",
        "UTC Hours;UTC Minutes;UTC Seconds;alpha[deg]\n23;59;59,5;1\n23;59;59,75;2\n0;0;0,0;3\n",
        "hh,mm,ss,ms,alpha[deg]\n23,59,59,500,1\n23,59,59,750,2\n0,0,0,0,3\n",
        "yyyy,mm,dd,hh,mm,ss,alpha[deg]\n2026,12,31,23,59,59.5,1\n2026,12,31,23,59,59.75,2\n2027,1,1,0,0,0,3\n",
        "Year,DOY,Hour,Minute,Second,alpha[deg]\n26,365,23,59,59.5,1\n26,365,23,59,59.75,2\n27,1,0,0,0,3\n",
        "IRIG Day,IRIG Hour,IRIG Min,IRIG Sec [s],alpha[deg]\n60,23,59,59.5,1\n60,23,59,59.75,2\n61,0,0,0,3\n",
        "year,doy,sod,alpha[deg]\n2026,365,86399.5,1\n2026,365,86399.75,2\n2027,1,0,3\n",
        "DOY,Seconds of Day,alpha[deg]\n60,86399.5,1\n60,86399.75,2\n61,0,3\n",
    ] {
        let (times, channels) = told(plain(text));
        assert_eq!(times, [0.0, 0.25, 0.5], "{text}");
        assert_eq!(channels, ["alpha"], "{text}");
    }
}

#[test]
fn a_time_of_its_own_goes_before_parts_of_one() {
    let text = "time[s],Hour,Min,Sec,alpha[deg]\n0.0,10,0,1,1\n0.1,10,0,1,2\n";
    assert_eq!(told(plain(text)).0, [0.0, 0.1]);
    // and seconds that are no part of a minute are a time
    let text = "Hour,Min,Seconds[s],alpha[deg]\n10,0,100.0,1\n10,0,100.5,2\n";
    assert_eq!(told(plain(text)).0, [0.0, 0.5]);
}

#[test]
fn a_mapping_names_the_parts() {
    let text = "d,h,m,s,x,a\n60,23,59,59,500000,1\n61,0,0,0,0,2\n";
    let parts = "time = {day = \"d\", hour = \"h\", minute = \"m\", second = \"s\", from = \"x\", unit = \"us\"}\n\
                 [channels]\nalpha = {from = \"a\", unit = \"deg\"}\n";
    assert_eq!(
        told(mapped(parts, text)),
        (vec![0.0, 0.5], vec!["alpha".to_string()])
    );
    let without = parts.replace(", unit = \"us\"", "");
    assert!(mapped(&without, text).unwrap_err().contains("/time/unit"));
    // beside hours alone: minutes where the title or the mapping says so, and else a question
    let text = "hour,min,x,a\n10,59.5,3570,1\n11,0.0,0,2\n11,0.25,15,3\n";
    let hours = |from: &str| {
        format!(
            "time = {{hour = \"hour\", {from}}}\n[channels]\nalpha = {{from = \"a\", unit = \"deg\"}}\n"
        )
    };
    for from in [
        "from = \"min\"",
        "from = \"min\", unit = \"min\"",
        "from = \"x\", unit = \"s\"",
    ] {
        assert_eq!(told(mapped(&hours(from), text)).0, [0.0, 30.0, 45.0]);
    }
    let open = mapped(&hours("from = \"x\""), text).unwrap_err();
    assert!(
        open.contains("/time/unit") && open.contains("unit = \"min\""),
        "{open}"
    );
    // seconds and nanoseconds since 1970, as ROS has them
    let text = "secs,nsecs,a\n1795255200,999999999,1\n1795255201,9,2\n";
    let parts = "time = {second = \"secs\", from = \"nsecs\", unit = \"ns\"}\n\
                 [channels]\nalpha = {from = \"a\", unit = \"deg\"}\n";
    assert_eq!(told(mapped(parts, text)).0, [0.0, 1e-8]);
    let by_title = parts.replace(", unit = \"ns\"", "");
    assert_eq!(told(mapped(&by_title, text)).0, [0.0, 1e-8]);
    for (wrong, expected) in [
        ("time = {hour = \"h\"}\n", "\"from\" for the finest"),
        (
            "time = {year = \"y\", hour = \"h\", from = \"s\"}\n",
            "a year a day",
        ),
        (
            "time = {hour = \"h\", date = \"d\", from = \"s\"}\n",
            "neither",
        ),
    ] {
        let fault = Mapping::from_toml(wrong).unwrap_err();
        assert!(
            fault.pointer == "/time" && fault.message.contains(expected),
            "{fault}"
        );
    }
}

#[test]
fn parts_that_are_none_name_their_line() {
    for (text, expected) in [
        (
            "Hour,Min,Sec,a[deg]\n10,0,1,1\n10,0,2,2\n10,0.5,3,3\n",
            "not whole",
        ),
        (
            "Hour,Min,Sec,a[deg]\n10,0,1,1\n10,0,2,2\n10,75,3,3\n",
            "no minute 75",
        ),
        (
            "Hour,Min,Sec,a[deg]\n10,0,1,1\n10,0,2,2\n10,0,75,3\n",
            "more in its finest part",
        ),
        (
            "Year,Month,Day,Hour,Min,Sec,a[deg]\n2026,2,28,10,0,1,1\n2026,2,29,10,0,2,2\n",
            "no such day",
        ),
    ] {
        let error = plain(text).unwrap_err();
        assert!(
            error.contains(expected) && error.contains("line"),
            "{text}\n{error}"
        );
    }
}

#[test]
fn a_draft_has_the_parts() {
    let text = "Hour,Min,Sec,ms,a\n10,0,1,0,1\n10,0,1,500,2\n";
    let limits = Limits::default();
    let inspected =
        trimtab_core::ingest::inspect(text.as_bytes(), Format::Csv, None, None, &limits);
    let draft = inspected.unwrap().expect("a table").draft.to_toml();
    let filled = Mapping::from_toml(&draft.replace('?', "-")).unwrap();
    let (times, channels) = told(read(text, Some(&filled)).map_err(|error| error.to_string()));
    assert_eq!((times, channels.len()), (vec![0.0, 0.5], 1), "{draft}");
}

#[test]
fn the_clock_of_satellites_is_left_as_it_is_and_said() {
    let reading = plain("GPS Week,TOW (s),a[m]\n2300,604799.75,1\n2301,0.25,2\n").unwrap();
    let said = reading
        .findings
        .iter()
        .find(|finding| finding.code == "recognised");
    assert!(said.unwrap().message.contains("leap seconds"));
}
