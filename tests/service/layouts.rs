//! Files of loggers and programs by two ways: over HTTP, and on the command line. What becomes of each is tried with the core.

use std::process::Command;

use crate::common::layouts::{Layout, layouts};
use crate::common::server::Server;
use trimtab::http::Config;
use trimtab::ingest::{Format, Limits, Mapping, read_recording};

/// The digest of the recording that the core makes of a layout.
fn digest(layout: &Layout) -> String {
    let mapping = layout.mapping.map(|text| Mapping::from_toml(text).unwrap());
    let bytes = layout.file.as_bytes();
    let limits = Limits::default();
    let read = read_recording(bytes, Format::Unstated, None, mapping.as_ref(), &limits);
    read.unwrap_or_else(|error| panic!("{}: {error}", layout.name))
        .maneuver
        .digest()
}

#[tokio::test]
async fn every_layout_goes_in_over_http() {
    let server = Server::start_with(Config::default(), 0).await;
    for layout in layouts() {
        let query = match layout.mapping {
            None => String::new(),
            Some(text) => {
                let mapping = Mapping::from_toml(text).unwrap().to_json();
                let mut query = form_urlencoded::Serializer::new(String::from("?"));
                query.append_pair("mapping", &mapping);
                query.finish()
            }
        };
        for content_type in ["text/csv", "text/plain", "application/octet-stream"] {
            let path = format!("/v1/maneuvers{query}");
            let sent = server.post(&path, content_type, layout.file).await;
            let name = layout.name;
            assert!(sent.status.is_success(), "{name}: {}", sent.text());
            let kept = sent.json();
            assert_eq!(kept["id"], digest(&layout), "{name}, {content_type}");
            let summary = &kept["summary"];
            let off = summary["duration"].as_f64().unwrap() - layout.duration;
            assert!(off.abs() < 1e-9, "{name}: {off} s");
            let mut channels = summary["channels"].as_array().unwrap().iter();
            assert!(channels.any(|c| c["name"] == layout.channel.0), "{name}");
        }
    }
}

#[test]
fn every_layout_goes_in_on_the_command_line() {
    let directory = tempfile::tempdir().unwrap();
    let mapping = directory.path().join("mapping.toml");
    for (number, layout) in layouts().iter().enumerate() {
        let file = directory.path().join(format!("{number}.log"));
        std::fs::write(&file, layout.file).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
        command.arg("inspect").arg(&file);
        if let Some(text) = layout.mapping {
            std::fs::write(&mapping, text).unwrap();
            command.arg("--mapping").arg(&mapping);
        }
        let done = command.output().unwrap();
        let said = String::from_utf8_lossy(&done.stdout);
        let samples = format!("{} samples, ", layout.samples);
        let error = String::from_utf8_lossy(&done.stderr);
        assert!(said.contains(&samples), "{}: {said}{error}", layout.name);
    }
}
