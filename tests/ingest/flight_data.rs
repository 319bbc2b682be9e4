//! Recorded maneuvers are read, and their known oddities found, with few false alarms.

use std::path::Path;

use trimtab_core::flight::{Finding, Maneuver, Severity};
use trimtab_core::ingest::{Format, Limits, quality, read, summary, to_json};

const FILES: [(&str, usize, usize); 6] = [
    ("attas_elv1", 626, 47),
    ("attas_ail1", 751, 47),
    ("attas_rud1", 751, 47),
    ("attas_ailrud1", 1502, 44),
    ("attas_qst01", 3001, 44),
    ("hfb320_1_10", 601, 19),
];

fn maneuver(directory: &Path, name: &str) -> Maneuver {
    let path = directory.join(name).with_extension("csv");
    let bytes = std::fs::read(&path).unwrap();
    read(&bytes, Format::Csv, &Limits::default()).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The rows of the findings with this code and channel.
fn rows(findings: &[Finding], code: &str, channel: Option<&str>) -> Vec<usize> {
    findings
        .iter()
        .filter(|finding| finding.code == code && finding.channel.as_deref() == channel)
        .flat_map(|finding| finding.rows.clone())
        .collect()
}

#[test]
fn every_file_is_read_whole() {
    let Some(directory) = crate::common::flight_data::directory("every_file_is_read_whole") else {
        return;
    };
    for (name, samples, channels) in FILES {
        let maneuver = maneuver(&directory, name);
        assert_eq!(maneuver.len(), samples, "{name}");
        assert_eq!(maneuver.channels().len(), channels, "{name}");
        let summary = summary(&maneuver);
        let rate = if name.starts_with("hfb") { 10.0 } else { 25.0 };
        // the time column of one file is rounded to 1e-5 s
        assert!(
            (summary.rate - rate).abs() < 1e-5,
            "{name}: {} Hz",
            summary.rate
        );
        assert!(summary.channels.iter().all(|c| c.missing == 0), "{name}");
        let json = to_json(&maneuver).unwrap();
        let again = read(json.as_bytes(), Format::Json, &Limits::default()).unwrap();
        assert_eq!(again.time(), maneuver.time(), "{name}");
        for (channel, values) in maneuver.channels() {
            assert_eq!(
                again.channels()[channel].values,
                values.values,
                "{name} {channel}"
            );
        }
    }
}

#[test]
fn known_oddities_are_found() {
    let Some(directory) = crate::common::flight_data::directory("known_oddities_are_found") else {
        return;
    };
    let findings = |name: &str| quality(&maneuver(&directory, name));

    let joined = findings("attas_ailrud1");
    assert_eq!(rows(&joined, "gap", None), [752]);
    let gap = joined.iter().find(|finding| finding.code == "gap").unwrap();
    let expected = "30.08 s between rows 751 and 752, where samples are 0.04 s apart";
    assert_eq!(gap.message, expected);

    let stall = findings("attas_qst01");
    let alpha = rows(&stall, "spikes", Some("alpha"));
    assert!(alpha.contains(&1) && alpha.contains(&3001), "{alpha:?}");
    let alphadot = rows(&stall, "spikes", Some("alphadot"));
    assert_eq!(alphadot, [1, 2999, 3000, 3001]);
    assert_eq!(rows(&stall, "wrap", Some("psi")).len(), 2);

    for name in ["attas_elv1", "attas_ail1", "attas_rud1", "attas_ailrud1"] {
        let findings = findings(name);
        for channel in ["h_radio", "alphadot"] {
            assert_eq!(
                rows(&findings, "constant", Some(channel)),
                [1],
                "{name} {channel}"
            );
        }
        // the raw samples at both ends of q that the smoothing of the source left
        let q = rows(&findings, "spikes", Some("q"));
        assert!(q.contains(&1) && q.len() >= 4, "{name}: {q:?}");
    }
}

#[test]
fn alarms_are_few() {
    let Some(directory) = crate::common::flight_data::directory("alarms_are_few") else {
        return;
    };
    for (name, _, channels) in FILES {
        let findings = quality(&maneuver(&directory, name));
        let warnings: Vec<&Finding> = findings
            .iter()
            .filter(|finding| finding.severity == Severity::Warning)
            .collect();
        for finding in &warnings {
            eprintln!("{name}: {finding:?}");
        }
        let commands = ["de", "da", "dr", "da_left", "da_right", "ih", "thrust"];
        let about_commands = warnings.iter().filter(|finding| {
            finding
                .channel
                .as_deref()
                .is_some_and(|channel| commands.contains(&channel))
        });
        assert_eq!(about_commands.count(), 0, "{name}");
        // air data that come 8.14 times a second over a bus, and were held up to 25: that is so, and no false alarm
        let (held, warnings): (Vec<&Finding>, Vec<&Finding>) =
            (warnings.into_iter()).partition(|finding| finding.code == "held_channel");
        for finding in held {
            let channel = finding.channel.as_deref();
            assert!(
                matches!(channel, Some("V_cas" | "mach")),
                "{name}: {finding:?}"
            );
            assert!(finding.message.contains("(8.13"), "{name}: {finding:?}");
        }
        assert!(
            warnings.len() * 4 < channels,
            "{name}: {} warnings on {channels} channels",
            warnings.len()
        );
        let repeated = warnings.iter().filter(|f| f.code.starts_with("repeated"));
        assert_eq!(repeated.count(), 0, "{name}");
        if name.starts_with("hfb") {
            assert!(warnings.is_empty(), "{name}: {warnings:?}");
        }
    }
}
