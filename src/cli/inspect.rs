//! `trimtab inspect`: what is found in a recording, and the draft of a mapping for it.

use std::path::PathBuf;

use super::Failure;
use super::mapping::MappingOption;
use super::notes;
use super::recording::{format_of, read_bytes, refused};
use super::table::bordered;
use crate::ingest::{self, IngestError, Inspection, Limits, Reading, summary};

/// Prints what is found in a recording: of a table how it is written, its columns, what they are read as, and a draft
/// of a mapping.
#[derive(clap::Args, Debug)]
pub(super) struct Inspect {
    /// A recording: a table of text (.csv, .txt, .dat, ...), a workbook, or what `fit` reads.
    file: PathBuf,
    #[command(flatten)]
    mapping: MappingOption,
}

impl Inspect {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let (bytes, mapping) = (read_bytes(&self.file)?, self.mapping.read()?);
        let (format, limits) = (format_of(&self.file), Limits::default());
        let refuse = |error: IngestError| refused(&self.file, &error);
        let inspected = ingest::inspect(&bytes, format, None, mapping.as_ref(), &limits);
        let text = match inspected.map_err(refuse)? {
            Some(inspection) => told(&inspection),
            // such a file says itself what it has, or its refusal does
            None => {
                let read = ingest::read_recording(&bytes, format, None, mapping.as_ref(), &limits);
                recording(&read.map_err(refuse)?)
            }
        };
        print!("{text}");
        Ok(())
    }
}

fn told(inspection: &Inspection) -> String {
    let mut text = String::new();
    for (what, found) in &inspection.written {
        text += &format!("{what:<26}{found}\n");
    }
    text += &format!("\n{}\n", columns(inspection));
    match &inspection.reading {
        Ok(reading) => text += &recording(reading),
        Err(error) => text += &format!("\nIt is not read as it is:\n{error}\n"),
    }
    text += "\nThe draft of a mapping (\"?\" where a choice is to be made):\n\n";
    text += &inspection.draft.to_toml();
    text
}

fn columns(inspection: &Inspection) -> String {
    let columns = inspection.columns.iter().enumerate();
    let rows = columns.map(|(at, column)| {
        let number = (at + 1).to_string();
        vec![
            number,
            column.title.clone(),
            column.unit.clone(),
            column.first.clone(),
        ]
    });
    bordered(["column", "title", "unit", "first value"], rows, 0..1)
}

fn recording(reading: &Reading) -> String {
    let summary = summary(&reading.maneuver);
    let names: Vec<String> = summary
        .channels
        .iter()
        .map(|channel| format!("{}[{}]", channel.name, channel.unit))
        .collect();
    let mut text = format!(
        "\n{} samples, {} s, {:.4} Hz, {} part(s) without a gap\nchannels: {}\n",
        summary.samples,
        summary.duration,
        summary.rate,
        summary.segments,
        names.join(", ")
    );
    let findings = [reading.findings.as_slice(), summary.findings.as_slice()].concat();
    text.extend(
        notes::lines(&findings)
            .iter()
            .map(|line| format!("{line}\n")),
    );
    text
}
