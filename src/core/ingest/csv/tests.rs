//! Tables of text as they are written by whoever.

use super::super::fault::places;
use super::super::{IngestError, Limits, Mapping, Reading, code};
use super::read;
use crate::flight::Maneuver;

fn reading(text: &str, mapping: Option<&str>) -> Result<Reading, IngestError> {
    let mapping =
        mapping.map(|text| Mapping::from_toml(text).unwrap_or_else(|fault| panic!("{fault}")));
    read(text.as_bytes(), None, mapping.as_ref(), &Limits::default())
}

fn read_text(text: &str) -> Result<Maneuver, IngestError> {
    reading(text, None).map(|reading| reading.maneuver)
}

fn faults(text: &str) -> Vec<String> {
    places(read_text(text))
}

/// The codes of what is told of a file.
fn told(text: &str) -> Vec<String> {
    let reading = reading(text, None).unwrap_or_else(|error| panic!("{text}: {error}"));
    reading
        .findings
        .into_iter()
        .map(|finding| finding.code)
        .collect()
}

#[test]
fn reads_names_units_and_missing_values() {
    let text = "\u{feff}\"alpha [deg]\" , t[ms],mach\r\n\r\n180,0, 0.5 \r\n\"\",40,NaN\r\n -Inf ,80,n/a\r\n90,120,1e-3\r\n";
    let maneuver = read_text(text).unwrap();
    assert_eq!(maneuver.time(), [0.0, 0.04, 0.08, 0.12]);
    let alpha = &maneuver.channels()["alpha"];
    assert_eq!(alpha.recorded_unit, "deg");
    assert_eq!(alpha.values[0], std::f64::consts::PI);
    assert!(alpha.values[1].is_nan() && alpha.values[2].is_nan());
    let mach = &maneuver.channels()["mach"];
    assert_eq!((mach.values[0], mach.values[3]), (0.5, 1e-3));
    assert_eq!(mach.recorded_unit, "-");
}

#[test]
fn every_line_ending_is_one() {
    let digest = |text: &str| read_text(text).unwrap().digest();
    let expected = digest("t[s],a\n0,1\n1,2\n");
    for text in [
        "t[s],a\r\n0,1\r\n1,2",
        "t[s],a\r0,1\r1,2\r",
        "\n\nt[s],a\n\n0,1\n   \n1,2\n\n",
        "t[s],a[-]\n0.0,1.0\n1e0,2\n",
    ] {
        assert_eq!(digest(text), expected, "{text:?}");
    }
}

#[test]
fn faults_of_the_whole_file() {
    assert_eq!(faults(""), ["empty_body "]);
    assert_eq!(faults("t[s],a\n"), ["too_few_samples "]);
    assert_eq!(faults("t[s],a\n0,1\n"), ["too_few_samples "]);
    assert_eq!(faults("t[s];a\n0;1,000\n1;1,500\n"), ["ambiguous_number "]);
    assert_eq!(faults("# nothing\n% at all"), ["empty_body "]);
    assert_eq!(faults("a,b\n1,2\n1,2\n"), ["no_time_column "]);
    assert_eq!(faults("1,2\n1,2\n"), ["mapping_needed "]);
    assert_eq!(faults("t[s]\n0\n1\n"), ["no_channels "]);
    assert_eq!(faults("t,a\n0,1\n1,2\n"), ["time_unit /columns/t"]);
    assert_eq!(faults("t[m],a\n0,1\n1,2\n"), ["time_unit /columns/t"]);
    let cut = read(
        "t[s],a\n0,1\n1,\u{b0}".as_bytes().split_last().unwrap().1,
        None,
        None,
        &Limits::default(),
    );
    let fault = &cut.unwrap_err().into_faults()[0];
    assert_eq!(fault.code, code::NOT_UTF8);
    assert!(fault.message.contains("line 3"), "{}", fault.message);
}

#[test]
fn faults_of_rows_are_reported_with_their_lines() {
    let text = "t[s],a,b\n0,1,1\n\nx,2,1\n1,y,1\n2\n1.1,3,1\n0.5,4,1\n,5,1\n3,1e999,1\n";
    assert_eq!(
        faults(text),
        [
            "not_a_number /rows/2/t",
            "row_length /rows/4",
            "time_missing /rows/7/t"
        ]
    );
    let error = read_text(text).unwrap_err();
    let message = |at: usize| error.faults()[at].message.as_str();
    assert!(
        message(0).starts_with("line 4: 'x' in column 't'"),
        "{}",
        message(0)
    );
    assert!(
        message(1).starts_with("line 6: row 4 has 1 cell(s)"),
        "{}",
        message(1)
    );
    assert_eq!(
        faults("t[s],a\n0,1\n2,1\n1,1\n0.5,1\n"),
        [
            "time_not_increasing /rows/3/t",
            "time_not_increasing /rows/4/t"
        ]
    );
}

#[test]
fn at_most_twenty_faults_of_rows_are_listed() {
    let rows: String = (0..100).map(|k| format!("{k},1\n{k}\n")).collect();
    assert_eq!(faults(&format!("t[s],a\n{rows}")).len(), 20);
}

#[test]
fn a_number_is_no_year_with_a_day() {
    let reading = reading("t[s],h[m]\n0,4840.071\n1,4840.071\n", None).unwrap();
    assert_eq!(reading.maneuver.channels()["h"].values[0], 4840.071);
}

#[test]
fn what_cannot_be_read_is_left_out_and_told_once() {
    let text = "t[s],q[deg/s],mode,on,gust[furlong],Engine 1 RPM [rpm],a\n0,1,CLIMB,True,1,2400,x\n1,2,CLIMB,False,1,2400,1\n";
    let reading = reading(text, None).unwrap();
    let names: Vec<&String> = reading.maneuver.channels().keys().collect();
    assert_eq!(names, ["q", "Engine_1_RPM"]);
    let left_out = &reading.findings[0];
    assert_eq!((left_out.code.as_str(), left_out.count), ("left_out", 4));
    for said in [
        "'mode' ('CLIMB' is not a number)",
        "unknown unit 'furlong'",
        "'a' ('x' in column 'a'",
    ] {
        assert!(left_out.message.contains(said), "{}", left_out.message);
    }
    // where nothing is left, each reason is a fault
    assert_eq!(
        faults("t[s],q[furlong]\n0,1\n1,2\n"),
        ["unknown_unit /columns/q"]
    );
    assert_eq!(faults("t[s],q\n0,1\n1,two\n"), ["not_a_number /rows/2/q"]);
    assert_eq!(
        faults("t[s],,q[furlong]\n0,1,1\n1,2,1\n"),
        ["empty_name /columns/2", "unknown_unit /columns/q"]
    );
}

#[test]
fn titles_become_names() {
    let text =
        "t[s],xyz[0],xyz[1] (deg),q(1),alpha,alpha,beta_deg\n0,1,1,1,1,1,180\n1,2,2,2,2,2,180\n";
    let maneuver = read_text(text).unwrap();
    let names: Vec<&String> = maneuver.channels().keys().collect();
    assert_eq!(
        names,
        ["xyz_0", "xyz_1", "q_1", "alpha", "alpha_2", "beta_deg"]
    );
    assert_eq!(
        maneuver.channels()["beta_deg"].values[0],
        std::f64::consts::PI
    );
    assert_eq!(told(text), ["renamed", "no_unit"]);
}

#[test]
fn limits_are_named() {
    let limits = Limits {
        max_columns: 3,
        max_samples: 4,
        max_values: 8,
        max_name_length: 5,
        ..Limits::default()
    };
    let refused = |text: &str, code: &str, bound: &str| {
        let error = read(text.as_bytes(), None, None, &limits).unwrap_err();
        assert_eq!(error.faults()[0].code, code, "{error}");
        assert!(error.to_string().contains(bound), "{error}");
    };
    refused("t[s],a,b,c\n", code::TOO_MANY_COLUMNS, "max_columns = 3");
    refused(
        "t[s],a\n1,1\n2,1\n3,1\n4,1\n5,1\n",
        code::TOO_MANY_SAMPLES,
        "max_samples = 4",
    );
    refused(
        "t[s],a,b\n1,1,1\n2,1,1\n3,1,1\n",
        code::TOO_MANY_VALUES,
        "max_values = 8",
    );
    refused("t[s],abcdef\n", code::NAME_TOO_LONG, "max_name_length = 5");
    refused("t[s],a\n1,1\n2,1,1,1\n", code::ROW_LENGTH, "row 2 has 4");
}

#[test]
fn a_header_of_a_million_columns_is_refused_at_once() {
    let header = format!("t[s]{}\n0\n1\n", ",a".repeat(1_000_000));
    assert_eq!(faults(&header), ["too_many_columns "]);
}

#[test]
fn a_forgotten_quote_spoils_one_cell_only() {
    assert_eq!(
        faults("t[s],a\n0,\"1\n1,2\n2,3\n"),
        ["not_a_number /rows/1/a"]
    );
}

#[test]
fn decimal_commas_between_commas_get_the_right_advice() {
    let error = read_text("t[s],a\n0,0,1,5\n0,1,1,7\n").unwrap_err();
    assert!(
        error.to_string().contains("separate cells by semicolons"),
        "{error}"
    );
}

#[test]
fn one_recording_in_many_layouts() {
    let expected = read_text("t[s],alpha[deg],q[deg/s]\n0,1.5,-2\n0.04,,3e-1\n").unwrap();
    for text in [
        "t[s];alpha[deg];q[deg/s]\r\n0;1.5;-2\r\n0.04;;3e-1\r\n",
        "t[s];alpha[deg];q[deg/s]\n0;1,5;-2\n0,04;;3e-1\n",
        "t (s)\talpha (deg)\tq (deg/s)\n0\t1,5\t-2\n0,04\t\t0,3\n",
        "# logger 7\n% 2026-11-21\nt;alpha;q\n\ns;deg;deg/s\n# begin\n0;1.5;-2\n0.04;;0.3\n# end\n",
        "time,alpha,q\n[s],[deg],[deg/s]\n0,1.5,-2\n0.04,nan,0.3\n",
        "sep=;\nt;alpha[deg];q\ns;;(deg/s)\n0;1,5;-2,0\n0,04;;0,3\n",
        "t;alpha;q;\nms;deg;deg/s;\n0;1.5;-2;\n40;;0.3;\n",
        "time,alpha[deg],q[deg/s]\n2026-11-21T12:00:00Z,1.5,-2\n2026-11-21T12:00:00.040Z,,.3\n",
        "Timestamp;alpha;q\nUTC;deg;deg/s\n12:00:00,000;1,5;-2\n12:00:00,040;;0,3\n",
        "| t[s] | alpha[deg] | q[deg/s] |\n|---|---|---|\n| 0 | 1.5 | -2 |\n| 0.04 | | 0.3 |\n",
        "   t[s]  alpha[deg]  q[deg/s]\n   0.00   1.5  -2.0\n   0.04   nan   0.3\n",
        "Run 7\nChannels: 3\n\n   t   alpha   q\n   S   DEG   DEG/SEC\n 0.00D+00 1.5D0 -2.0\n 4.0D-02 ***** 3.0D-01\n",
        "s,deg,deg/s\nTime since start,Angle of attack,Pitch rate\nt,alpha,q\n0,1.5,-2\n0.04,-,0.3\n",
        "# t[s],alpha[deg],q[deg/s]\n0,1.5,-2\n0.04,,0.3\n",
        "%time (s),alpha (deg),q (dps)\n0,1.5,-2\n0.04,,0.3\n",
        "t[s],alpha[deg],q[deg/s]\n0,1.5,-2,\n0.04,,0.3,\n",
        "t[s],alpha[deg],q[deg/s]\n0,1.5,-2\nt[s],alpha[deg],q[deg/s]\n0.04,,0.3\n",
        "t[s],alpha[deg],q[deg/s]\n0,1.5,-2\n0.04,,0.3\n0.08,1",
        "t[s],alpha[deg],q[deg/s]\n0,1.5,-2\n0.04,,0.3\n\nEnd of file, 2 records\n",
        "t[s],alpha[deg],q[deg/s]\n0,1.5,-2\n0.04,,0.3\n\0\0\0\0\0\0\0\0",
        "t[s],alpha[deg],q[deg/s]\n0,1.5,-2\n0.04,,0.3\n,,\n,,\n",
        "t[s],alpha[deg],q[deg/s]\n0,1.5,-2\n0,1.5,-2\n0.04,,0.3\n",
        "Lcl Date,Lcl Time,alpha[deg],q[deg/s]\n2026-11-21,12:00:00,1.5,-2\n2026-11-21,12:00:00.04,,0.3\n",
        "time,alpha[deg],q[deg/s]\n1795255200000,1.5,-2\n1795255200040,,0.3\n",
        "t[s],alpha[deg],q[deg/s],remark\n0,1.5,-2,\"up, and\naway\"\n0.04,,0.3,\"climb, flaps\"\n",
    ] {
        let maneuver = read_text(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(maneuver.time(), expected.time(), "{text}");
        assert_eq!(maneuver.digest(), expected.digest(), "{text}");
    }
}

#[test]
fn what_was_passed_over_is_told() {
    let body = "t[s],a[-]\n0,1\n1,2\n";
    for (text, code) in [
        (format!("{body}t[s],a[-]\n2,3\n"), "repeated_header"),
        (format!("{body}2"), "incomplete_line"),
        (format!("{body}\nend of file\n"), "footer"),
        (format!("{body}\0\0\0"), "zero_bytes"),
        (format!("{body}1,2\n"), "repeated_time"),
        ("t[s],a[-]\n,5\n0,1\n1,2\n".to_string(), "no_time_yet"),
    ] {
        assert_eq!(told(&text), [code], "{text:?}");
    }
    let cut = "t[s],a[-]\n0,1.50\n1,1.25\n2,1.75\n3,1.25\n4,1.2";
    assert_eq!(told(cut), ["incomplete_line"]);
    assert_eq!(read_text(cut).unwrap().len(), 4);
}

#[test]
fn faults_of_time_stamps_name_their_line() {
    let text = "time,a\n12:00:00,1\n12:00:00.5,2\n1.5,4\n12:00,5\n12:00:01,1\n,6\n2026-11-21T12:00:00Z,7\n12:00:02,1\n";
    assert_eq!(
        faults(text),
        [
            "not_a_number /rows/3/time",
            "not_a_number /rows/4/time",
            "time_missing /rows/6/time",
            "not_a_number /rows/7/time",
        ]
    );
    let error = read_text(text).unwrap_err();
    assert!(
        error.faults()[1]
            .message
            .starts_with("line 5: '12:00' in column 'time'"),
        "{error}"
    );
    let unknown = read_text("time,a\nnoon,1\nlater,2\n").unwrap_err();
    assert!(
        unknown
            .to_string()
            .contains("is no time stamp that is known"),
        "{unknown}"
    );
}

#[test]
fn a_date_of_any_characters_is_a_fault() {
    let text = "Date,Time,a\n2026-11-21,10:15:19,1\nabc€de,10:15:20,1.5\n2026-11-21,10:15:21,2\n";
    assert_eq!(faults(text), ["not_a_number /rows/2/Time"]);
}

#[test]
fn no_repetition_takes_long() {
    let length = 1 << 20;
    for piece in [
        "\"x\ny\",",
        "\"",
        "\"\n",
        "a,\"",
        ",",
        ";",
        "| ",
        "\r",
        "#\n",
        "[",
        "x\n",
        "1 ",
        "\0",
    ] {
        let repeated = piece.repeat(length / piece.len());
        for text in [format!("t[s],a\n0,1\n1,2\n{repeated}"), repeated] {
            let _ = read_text(&text);
        }
    }
}

#[test]
fn a_refusal_brings_the_draft_of_a_mapping() {
    let error = read_text("Zeit,Elev Pos,mode\n0,1,a\n1,2,b\n").unwrap_err();
    let draft = Mapping::from_json(error.draft().unwrap())
        .unwrap()
        .to_toml();
    for said in [
        "time = { unit = \"?\", from = \"Zeit\" }",
        "Elev_Pos = { from = \"Elev Pos\", unit = \"?\" }",
    ] {
        assert!(draft.contains(said), "{draft}");
    }
    assert!(!draft.contains("mode"), "{draft}");
    let done = draft.replace("\"?\"", "\"s\"");
    assert!(reading("Zeit,Elev Pos,mode\n0,1,a\n1,2,b\n", Some(&done)).is_ok());
    let numbers = read_text("0,1\n1,2\n").unwrap_err();
    assert!(numbers.draft().unwrap().contains("(:,2)"));
}
