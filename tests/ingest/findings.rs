//! The table of findings, and what is found on recordings of our own.

use trimtab_core::flight::{FindingCode, Severity};
use trimtab_core::ingest::{Format, Limits, quality, read};

/// The table of the documentation, held against the code.
#[test]
fn the_documentation_has_the_table_of_findings() {
    let guide = concat!(env!("CARGO_MANIFEST_DIR"), "/../../src/guide/findings.md");
    let guide = std::fs::read_to_string(guide).expect("the documentation");
    let rows = guide.lines().filter(|line| line.starts_with("| `"));
    let rows: Vec<&str> = rows.collect();
    for code in FindingCode::ALL {
        let (name, severity) = (code.name(), code.severity().name());
        let row = format!("| `{name}` | {severity} | {} |", code.meaning());
        assert!(
            rows.contains(&row.as_str()),
            "src/guide/findings.md lacks the row\n{row}"
        );
    }
}

/// Nothing is odd about the bundled recordings but what was put into them.
#[test]
fn bundled_recordings_raise_no_false_alarm() {
    let root = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../data"));
    let mut files = Vec::new();
    for directory in [root.to_path_buf(), root.join("effects")] {
        let entries = std::fs::read_dir(directory).expect("a directory");
        let paths = entries.map(|entry| entry.expect("an entry").path());
        files.extend(paths.filter(|path| path.extension().is_some_and(|end| end == "csv")));
    }
    assert!(files.len() > 10, "{}", files.len());
    let mut alarms = Vec::new();
    for file in files {
        let bytes = std::fs::read(&file).expect("a recording");
        let maneuver = read(&bytes, Format::Csv, &Limits::default()).expect("a recording");
        for finding in quality(&maneuver) {
            if finding.severity > Severity::Note {
                alarms.push(format!("{}: {finding:?}", file.display()));
            }
        }
    }
    assert!(alarms.is_empty(), "{}", alarms.join("\n"));
}
