//! `trimtab upload`: recordings to a server.

use std::path::PathBuf;

use clap::Args;
use serde_json::Value;

use super::Failure;
use super::client::Client;
use super::form::{Column, Form};
use super::mapping::MappingOption;
use super::notes;
use super::recording::read_bytes;
use super::server::ServerOption;
use crate::flight::Finding;

/// Uploads recordings, and prints the id of each; what is odd about the data is said on the standard error.
#[derive(Args, Debug)]
pub(super) struct Upload {
    /// Recordings, each by itself (`trimtab join` makes one of several files).
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    server: ServerOption,
    /// What it is called; without it, what its file is called.
    #[arg(long)]
    name: Option<String>,
    #[command(flatten)]
    mapping: MappingOption,
    #[command(flatten)]
    form: Form,
}

const COLUMNS: [Column; 4] = [
    Column::text("id", "/id"),
    Column::text("name", "/name"),
    Column::number("s", "/summary/duration"),
    Column::number("samples", "/summary/samples"),
];

impl Upload {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        if self.name.is_some() && self.files.len() > 1 {
            let message = "--name is for one file; several are called what their files are called";
            return Err(Failure::new(message));
        }
        let client = Client::of(&self.server)?;
        let mapping = self.mapping.text()?;
        let mut stored = Vec::new();
        for file in &self.files {
            let stem = file.file_stem();
            let stem = stem.map_or("recording".into(), |stem| stem.to_string_lossy());
            let name = self.name.as_deref().unwrap_or(&stem);
            let uploaded: Value = client
                .upload(name, file, mapping.as_deref(), read_bytes(file)?)
                .await
                .map_err(|failure| Failure::new(format!("{}: {failure}", file.display())))?;
            let findings = uploaded.pointer("/summary/findings").cloned();
            let findings: Vec<Finding> =
                serde_json::from_value(findings.unwrap_or_default()).unwrap_or_default();
            for line in notes::lines(&findings) {
                eprintln!("{}: {line}", file.display());
            }
            if !(self.form.csv || self.form.json) {
                println!("{}", uploaded["id"].as_str().unwrap_or_default());
            }
            stored.push(uploaded);
        }
        if self.form.csv || self.form.json {
            self.form.print(&COLUMNS, &stored)?;
        }
        Ok(())
    }
}
