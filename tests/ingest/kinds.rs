//! Kinds of files that loggers and people make: each in three variants of our own, and what becomes of them.

use trimtab_core::ingest::{Format, Limits, Mapping, Reading, read_recording};

fn read(text: &[u8], mapping: &str) -> Result<Reading, String> {
    let mapping = (!mapping.is_empty())
        .then(|| Mapping::from_toml(mapping).unwrap_or_else(|fault| panic!("{mapping}: {fault}")));
    read_recording(
        text,
        Format::Csv,
        None,
        mapping.as_ref(),
        &Limits::default(),
    )
    .map_err(|error| error.to_string())
}

/// A table of these titles: rows 0.02 s apart, values that grow.
fn table(titles: &str, rows: usize) -> String {
    let width = titles.lines().last().unwrap_or_default().split(',').count();
    let mut text = format!("{titles}\n");
    for row in 0..rows {
        let values: Vec<String> = (1..width)
            .map(|at| format!("{:.3}", at as f64 + row as f64 * 0.125))
            .collect();
        text += &format!("{:.3},{}\n", row as f64 * 0.02, values.join(","));
    }
    text
}

/// Channels with their units, samples and seconds.
fn told(text: &str, mapping: &str) -> (Vec<String>, usize, f64) {
    let reading = read(text.as_bytes(), mapping).unwrap_or_else(|error| panic!("{text}\n{error}"));
    let maneuver = reading.maneuver;
    let channel = |(name, channel): (&String, &trimtab_core::flight::Channel)| {
        format!("{name}[{}]", channel.recorded_unit)
    };
    let channels = maneuver.channels().iter().map(channel).collect();
    (
        channels,
        maneuver.len(),
        (maneuver.duration() * 1e6).round() / 1e6,
    )
}

#[test]
fn without_a_header_a_mapping_by_numbers_is_enough() {
    let mapping = "time = {from = \"(:,1)\", unit = \"s\"}\n[channels]\nq = {from = \"(:,3)\", unit = \"deg/s\"}\n";
    for text in [
        "0,1,2\n0.02,2,3\n",
        "0;1,5;2\n0,02;2,5;3\n",
        " 0.00 1 2\n 0.02 2 3\n",
    ] {
        assert_eq!(told(text, mapping), (vec!["q[deg/s]".to_string()], 2, 0.02));
        let refused = read(text.as_bytes(), "").unwrap_err();
        assert!(refused.contains("say with a mapping"), "{refused}");
    }
}

#[test]
fn units_are_read_as_people_write_them() {
    for (units, expected) in [
        (
            "SECONDS,DEG,DEG/S**2,FT/SEC**2,KNOTS",
            ["deg", "deg/s^2", "ft/s^2", "kt"],
        ),
        (
            "msec,degrees,rad/sec2,m/s\u{b2},KTAS",
            ["deg", "rad/s^2", "m/s^2", "kt"],
        ),
        (
            "us,\u{ba},dps,slug-ft2,PSIA",
            ["\u{b0}", "deg/s", "slug*ft^2", "psi"],
        ),
    ] {
        let names = ["t", "a", "b", "c", "d"];
        let titles: Vec<String> = names
            .iter()
            .zip(units.split(','))
            .map(|(name, unit)| format!("{name} [{unit}]"))
            .collect();
        let (channels, ..) = told(&table(&titles.join(","), 4), "");
        let expected: Vec<String> = names[1..]
            .iter()
            .zip(expected)
            .map(|(name, unit)| format!("{name}[{unit}]"))
            .collect();
        assert_eq!(channels, expected);
    }
}

#[test]
fn columns_that_no_one_needs_do_no_harm() {
    for (title, cell) in [
        ("flight phase", "CRUISE"),
        ("valid", "True"),
        ("gust[furlong]", "1"),
    ] {
        let text = format!("t[s],q[deg/s],{title}\n0,1,{cell}\n0.02,2,{cell}\n0.04,3,{cell}\n");
        let reading = read(text.as_bytes(), "").unwrap();
        assert!(reading.maneuver.channels().contains_key("q"));
        assert_eq!(reading.maneuver.channels().len(), 1, "{title}");
        assert_eq!(reading.findings.len(), 1, "{:?}", reading.findings);
        assert!(
            reading.findings[0]
                .message
                .contains(title.split('[').next().unwrap()),
            "{:?}",
            reading.findings
        );
        // what is needed and cannot be read is a fault with its place
        let mapping = "[channels]\nx = {from = \"(:,3)\", unit = \"-\"}\n";
        if cell != "1" {
            let refused = read(text.as_bytes(), mapping).unwrap_err();
            assert!(refused.starts_with("/rows/1/x: line 2:"), "{refused}");
        }
    }
}

#[test]
fn a_mapping_names_titles_as_they_stand() {
    for title in [
        "Elev Pos [deg]",
        "ctl/elev[2] (deg)",
        "Elevator {left}, raw",
    ] {
        let text = format!("Zeit,\"{title}\"\n0,1\n20,2\n");
        for from in [
            title.to_string(),
            "(:,2)".to_string(),
            format!("{}*", &title[..4]),
        ] {
            let mapping = format!(
                "time = {{from = \"Zeit\", unit = \"ms\"}}\n[channels]\nde = {{from = \"{from}\", unit = \"deg\"}}\n"
            );
            assert_eq!(
                told(&text, &mapping),
                (vec!["de[deg]".to_string()], 2, 0.02),
                "{from}"
            );
        }
    }
}

#[test]
fn headers_may_be_commented() {
    for text in [
        "# a run\n#t[s],q[deg/s]\n#an event, at 5 s, twice\n0,1\n0.02,2\n",
        "% t (s), q (deg/s)\n0,1\n0.02,2\n",
        "#  t[s]  q[deg/s]\n   0.00   1\n   0.02   2\n",
    ] {
        assert_eq!(
            told(text, ""),
            (vec!["q[deg/s]".to_string()], 2, 0.02),
            "{text}"
        );
    }
}

#[test]
fn lines_before_and_around_the_header_are_passed_over() {
    let rows = "0.00,1,2\n0.02,2,3\n0.04,3,4\n";
    for (above, rows) in [
        (
            "Program: X\nOperator,me\nRate,50,Hz\n\nt[s],q[deg/s],mach[-]\n".to_string(),
            rows.to_string(),
        ),
        (
            "1,2,3\nt,q,mach\nTime,Pitch rate,Mach number\ns,deg/s,-\n".to_string(),
            rows.to_string(),
        ),
        (
            "Run 3, two variables\n\n    T      Q    MACH\n    S  DEG/S      -\n".to_string(),
            rows.replace(',', "   "),
        ),
    ] {
        let (channels, samples, duration) = told(&(above + &rows), "");
        assert_eq!((channels.len(), samples, duration), (2, 3, 0.04));
        assert!(channels[0].to_lowercase() == "q[deg/s]", "{channels:?}");
    }
}

#[test]
fn equal_stamps_are_kept_once_or_as_is_said() {
    let text = "t[s],q[deg/s]\n0,1\n0.02,2\n0.02,2\n0.04,3\n";
    assert_eq!(told(text, "").1, 3);
    let other = "t[s],q[deg/s]\n0,1\n0.02,2\n0.02,2.5\n0.04,3\n";
    let refused = read(other.as_bytes(), "").unwrap_err();
    assert!(
        refused.contains("line 4") && refused.contains("repeated"),
        "{refused}"
    );
    for repeated in ["first", "mean"] {
        assert_eq!(
            told(other, &format!("time = {{repeated = \"{repeated}\"}}\n")).1,
            3
        );
    }
    let coarse: String = (0..20)
        .map(|row| format!("10:15:0{},{row}\n", row / 5))
        .collect();
    let coarse = format!("time,q[deg/s]\n{coarse}");
    let refused = read(coarse.as_bytes(), "").unwrap_err();
    assert!(
        refused.contains("5 rows in 1 s") && refused.contains("step = 0.2"),
        "{refused}"
    );
    assert_eq!(told(&coarse, "time = {repeated = \"spread\"}\n").2, 3.8);
    assert_eq!(
        told(
            &coarse,
            "time = {step = 0.2, unit = \"s\"}\n[channels]\nq = {from = \"q\"}\n"
        )
        .2,
        3.8
    );
}

#[test]
fn time_may_be_a_step() {
    for (text, from) in [
        ("q[deg/s],mach\n1,2\n2,3\n3,4\n", "q"),
        ("1 2\n2 3\n3 4\n", "(:,1)"),
        ("q\n1\n2\n3\n", "q"),
    ] {
        let mapping = format!(
            "time = {{step = 20, unit = \"ms\"}}\n[channels]\nq = {{from = \"{from}\", unit = \"deg/s\"}}\n"
        );
        assert_eq!(
            told(text, &mapping),
            (vec!["q[deg/s]".to_string()], 3, 0.04),
            "{text}"
        );
    }
}

#[test]
fn stamps_are_read_where_one_reading_is_possible() {
    for (first, second) in [
        ("10:15:00.000 AM", "10:15:00.500 AM"),
        ("21.11.2026 10:15:00", "21.11.2026 10:15:00.5"),
        ("21-NOV-2026 10:15:00.0", "21-NOV-2026 10:15:00.5"),
        ("325 10:15:00.0", "325 10:15:00.5"),
        ("2026:325:10:15:00.0", "2026:325:10:15:00.5"),
        ("47:59.9", "48:00.4"),
        ("59:59.9", "00:00.4"),
        ("0.5 seconds", "1 seconds"),
        ("1795255200.25", "1795255200.75"),
        ("1795255200250000000", "1795255200750000000"),
    ] {
        let text = format!("time,q[deg/s]\n{first},1\n{second},2\n");
        assert_eq!(told(&text, "").2, 0.5, "{first}");
    }
    let unknown = read(b"time,q\nMonday,1\nTuesday,2\n", "").unwrap_err();
    assert!(unknown.contains("2026-11-21T10:15:00"), "{unknown}");
}

#[test]
fn debris_at_the_end_is_left_out() {
    let body = table("t[s],q[deg/s],mach[-]", 12);
    for (debris, code) in [
        ("0.24,2", "incomplete_line"),
        ("0.240,2.000,3.0", "incomplete_line"),
        ("\n*** end ***\n", "footer"),
        ("Samples: 12, all good\nChecksum,AB12,CD34\n", "footer"),
        ("\0\0\0\0\0\0", "zero_bytes"),
        ("t[s],q[deg/s],mach[-]\n", "repeated_header"),
    ] {
        let reading = read(format!("{body}{debris}").as_bytes(), "")
            .unwrap_or_else(|error| panic!("{debris}: {error}"));
        assert_eq!(reading.maneuver.len(), 12, "{debris:?}");
        let codes: Vec<&str> = reading
            .findings
            .iter()
            .map(|finding| finding.code.as_str())
            .collect();
        assert_eq!(codes, [code], "{debris:?}");
    }
}

#[test]
fn quotes_protect_and_thousands_are_marked() {
    for (cell, value) in [
        ("\"12,345.5\"", 12345.5),
        ("\"1,234,567\"", 1_234_567.0),
        ("\"12 345.5\"", 12345.5),
    ] {
        let text = format!("t[s],h[m],remark\n0,{cell},\"a, b\"\n0.02,{cell},\"say \"\"c\"\"\"\n");
        let reading = read(text.as_bytes(), "").unwrap_or_else(|error| panic!("{cell}: {error}"));
        assert_eq!(
            reading.maneuver.channels()["h"].values,
            [value; 2],
            "{cell}"
        );
    }
}

#[test]
fn an_index_is_no_unit() {
    for (title, name) in [
        ("gyro[2]", "gyro_2"),
        ("q[0]", "q_0"),
        ("acc[1] (g)", "acc_1"),
    ] {
        let (channels, ..) = told(&table(&format!("t[s],{title}"), 3), "");
        assert!(channels[0].starts_with(&format!("{name}[")), "{channels:?}");
    }
}

#[test]
fn encodings_of_other_programs_are_read() {
    let text = "t[s];\u{3b1} [\u{b0}];T [\u{b0}C]\n0;1,5;20\n0,02;2,5;20\n";
    let utf16: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let utf16_with_mark = [&b"\xff\xfe"[..], &utf16].concat();
    let latin: Vec<u8> = text
        .replace('\u{3b1}', "alpha")
        .chars()
        .map(|c| c as u8)
        .collect();
    for bytes in [text.as_bytes(), &utf16_with_mark, &utf16, &latin] {
        let maneuver = read(bytes, "").unwrap().maneuver;
        assert_eq!(maneuver.channels()["alpha"].values[0], 1.5_f64.to_radians());
        assert_eq!(maneuver.channels()["T"].values[0], 293.15);
    }
}
