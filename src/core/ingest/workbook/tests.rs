//! Workbooks that are written here, as other programs do it.

use super::super::packed::archive;
use super::super::{Format, Limits, Mapping, code, fault::places, read, read_mapped};

const RELATIONS: &str = r#"<Relationships><Relationship Id="rId1" Target="worksheets/sheet1.xml"/><Relationship Id="rId2" Target="/xl/worksheets/data.xml"/></Relationships>"#;

fn workbook(outline: &str, parts: &[(&str, &str)]) -> Vec<u8> {
    let mut files = vec![
        ("[Content_Types].xml", "<Types/>"),
        ("xl/workbook.xml", outline),
        ("xl/_rels/workbook.xml.rels", RELATIONS),
    ];
    files.extend(parts);
    let files: Vec<(&str, &[u8])> = files
        .iter()
        .map(|(name, text)| (*name, text.as_bytes()))
        .collect();
    archive(&files)
}

const OUTLINE: &str = r#"<workbook><workbookPr/><sheets><sheet name="About" sheetId="1" r:id="rId1"/><sheet name="Data" sheetId="2" r:id="rId2"/></sheets></workbook>"#;
const ABOUT: &str = r#"<worksheet><sheetData><row r="1"><c r="A1" t="inlineStr"><is><t>a flight</t></is></c></row></sheetData></worksheet>"#;

/// With shared strings, empty rows before the table, an empty column, an error, a formula.
fn data() -> String {
    let mut rows = String::from(
        r#"<row r="3" spans="2:5"><c r="B3" t="s"><v>0</v></c><c r="C3" t="s"><v>1</v></c><c r="E3" t="str"><f>A1</f><v>q[deg/s]</v></c></row>"#,
    );
    for k in 0..4 {
        let row = k + 4;
        let error = if k == 2 {
            r#" t="e"><v>#N/A</v>"#
        } else {
            "><v>-1.5E-1</v>"
        };
        rows += &format!(
            r#"<row r="{row}"><c r="B{row}"><v>{}</v></c><c r="C{row}" s="0"{error}</c><c r="E{row}"><f>2*B{row}</f><v>{k}</v></c></row>"#,
            f64::from(k) * 0.5
        );
    }
    format!("<?xml version=\"1.0\"?><worksheet><sheetData>{rows}</sheetData></worksheet>")
}

const STRINGS: &str =
    "<sst><si><t>t[s]</t></si><si><r><t>alpha</t></r><r><t>[deg]</t></r></si></sst>";

#[test]
fn the_first_sheet_with_a_table_is_read() {
    let bytes = workbook(
        OUTLINE,
        &[
            ("xl/worksheets/sheet1.xml", ABOUT),
            (
                "xl/worksheets/data.xml",
                &data().replace("<c r=\"E", "<c r=\"D"),
            ),
            ("xl/sharedStrings.xml", STRINGS),
        ],
    );
    let csv = b"t[s],alpha[deg],q[deg/s]\n0,-0.15,0\n0.5,-0.15,1\n1,,2\n1.5,-0.15,3\n";
    let limits = Limits::default();
    let plain = read(csv, Format::Csv, &limits).unwrap();
    for format in [Format::Unstated, Format::Csv] {
        let found = read(&bytes, format, &limits).unwrap();
        assert_eq!(found.digest(), plain.digest());
    }
    let text = r#"{"time": {"from": "t", "unit": "s"}, "channels": {"rate": {"from": "(:,3)", "unit": "rad/s"}}}"#;
    let mapping = Mapping::from_json(text).unwrap();
    let mapped = read_mapped(&bytes, Format::Unstated, Some(&mapping), &limits).unwrap();
    assert_eq!(mapped.channels()["rate"].values, [0.0, 1.0, 2.0, 3.0]);
}

#[test]
fn dates_are_time_stamps() {
    let styles = r#"<styleSheet><numFmts><numFmt numFmtId="165" formatCode="yyyy-mm-dd hh:mm:ss.000"/></numFmts><cellXfs><xf numFmtId="0"/><xf numFmtId="165"/></cellXfs></styleSheet>"#;
    let mut rows = String::from(
        r#"<row><c t="inlineStr"><is><t>time</t></is></c><c t="inlineStr"><is><t>q[deg/s]</t></is></c></row>"#,
    );
    for k in 0..3 {
        let days = 46_347.0 + f64::from(k) * 0.02 / 86_400.0;
        rows += &format!(r#"<row><c s="1"><v>{days}</v></c><c><v>{k}</v></c></row>"#);
    }
    let sheet = format!("<worksheet><sheetData>{rows}</sheetData></worksheet>");
    let bytes = workbook(
        OUTLINE,
        &[
            ("xl/worksheets/sheet1.xml", &sheet),
            ("xl/styles.xml", styles),
        ],
    );
    let maneuver = read(&bytes, Format::Unstated, &Limits::default()).unwrap();
    for (k, time) in (0..3).zip(maneuver.time()) {
        assert!((time - f64::from(k) * 0.02).abs() < 2e-6, "{time}");
    }
}

#[test]
fn what_has_no_table_or_too_much_is_refused() {
    let limits = Limits {
        max_bytes: 100_000,
        ..Limits::default()
    };
    let refused = |parts: &[(&str, &str)], code: &str, expected: &str| {
        let error = read(&workbook(OUTLINE, parts), Format::Unstated, &limits).unwrap_err();
        assert_eq!(error.faults()[0].code, code, "{error}");
        assert!(error.to_string().contains(expected), "{error}");
    };
    let about = ("xl/worksheets/sheet1.xml", ABOUT);
    refused(&[about], code::TOO_FEW_SAMPLES, "no sheet with a table");
    let long = format!("<sst>{}</sst>", "<si/>".repeat(30_000));
    refused(
        &[about, ("xl/sharedStrings.xml", &long)],
        code::UNPACKED_TOO_LARGE,
        "sharedStrings",
    );
    // cells in the last column make long rows of little
    let row = |k: usize| {
        format!(r#"<row r="{k}"><c r="A{k}"><v>1</v></c><c r="XFD{k}"><v>1</v></c></row>"#)
    };
    let rows: String = (1..50).map(row).collect();
    let wide = format!("<worksheet>{rows}</worksheet>");
    refused(
        &[("xl/worksheets/sheet1.xml", &wide)],
        code::UNPACKED_TOO_LARGE,
        "longer than 100000 bytes as CSV",
    );
}

#[test]
fn a_row_of_more_than_a_sheet_can_have_is_refused() {
    let limits = Limits {
        max_bytes: 500_000,
        ..Limits::default()
    };
    let refused = |row: &str, code: &str, expected: &str| {
        let sheet = format!("<worksheet><row>{row}</row></worksheet>");
        let strings = format!("<sst><si><t>{}</t></si></sst>", "a".repeat(1000));
        let parts = [
            ("xl/worksheets/sheet1.xml", sheet.as_str()),
            ("xl/sharedStrings.xml", strings.as_str()),
        ];
        let error = read(&workbook(OUTLINE, &parts), Format::Unstated, &limits).unwrap_err();
        assert_eq!(error.faults()[0].code, code, "{error}");
        assert!(error.to_string().contains(expected), "{error}");
    };
    // one row, which is no table
    let shared = r#"<c t="s"><v>0</v></c>"#.repeat(1000);
    refused(
        &shared,
        code::UNPACKED_TOO_LARGE,
        "longer than 500000 bytes as CSV",
    );
    let repeated = r#"<c r="A1"/>"#.repeat(16_385);
    refused(&repeated, code::DAMAGED_FILE, "more than 16384 cells");
}

#[test]
fn cells_and_rows_without_a_place_go_behind_the_last() {
    let csv = |rows: &str| {
        let sheet = format!("<worksheet>{rows}</worksheet>");
        let bytes = workbook(OUTLINE, &[("xl/worksheets/sheet1.xml", &sheet)]);
        super::table(&bytes, &Limits::default()).unwrap()
    };
    let cells = |cells: [&str; 3]| {
        cells.map(|cell| match cell {
            "" => "<c/>".to_string(),
            _ => format!(r#"<c t="str"><v>{cell}</v></c>"#),
        })
    };
    let row = |of: [&str; 3]| format!("<row>{}</row>", cells(of).concat());
    let rows = [
        ["t[s]", "a", "b"],
        ["0", "1", "2"],
        ["1", "", "3"],
        ["2", "1", ""],
    ]
    .map(row);
    assert_eq!(csv(&rows.concat()), "t[s],a,b\n0,1,2\n1,,3\n2,1,\n");
    // a number that no row has is none
    let last = rows[3].replace("<row>", "<row r=\"18446744073709551615\">");
    let expected = "t[s],a,b\n0,1,2\n2,1,\n1,,3\n";
    assert_eq!(
        csv(&[&rows[0], &rows[1], &last, &rows[2]]
            .map(String::as_str)
            .concat()),
        expected
    );
}

#[test]
fn no_repetition_takes_long() {
    let length = 1 << 20;
    for piece in [
        "&",
        "&#",
        "<",
        "<c>",
        "<c/>",
        "<c r=\"A1\"><v>1</v></c>",
        "<row>",
        "<row/>",
        "<v>",
        "<!--",
        "<![CDATA[",
        "<a b='",
        "<sheet r:id='rId9'/>",
        "<Relationship/>",
        "<si/>",
        "<xf/>",
    ] {
        let repeated = format!("<si><row><c><t>{}", piece.repeat(length / piece.len()));
        let parts = [
            ("xl/worksheets/sheet1.xml", repeated.as_str()),
            ("xl/sharedStrings.xml", &repeated),
            ("xl/styles.xml", &repeated),
        ];
        for outline in [OUTLINE, &repeated] {
            let _ = read(
                &workbook(outline, &parts),
                Format::Unstated,
                &Limits::default(),
            );
        }
    }
}

#[test]
fn no_damage_to_a_part_panics() {
    let sheet = data();
    let limits = Limits::default();
    let with = |part: &str| {
        let part = ("xl/worksheets/data.xml", part);
        let _ = read(
            &workbook(OUTLINE, &[part, ("xl/sharedStrings.xml", STRINGS)]),
            Format::Unstated,
            &limits,
        );
    };
    for at in (0..sheet.len()).step_by(3) {
        with(&sheet[..at]);
        for byte in [b'<', b'>', b'"', b'/', b'&', b'9'] {
            let mut damaged = sheet.clone().into_bytes();
            damaged[at] = byte;
            with(&String::from_utf8(damaged).unwrap());
        }
    }
    let empty = read(&workbook("<workbook/>", &[]), Format::Unstated, &limits);
    assert_eq!(places(empty), ["too_few_samples "]);
}
