//! `trimtab join`: several files of one flight as one recording.

use std::collections::HashMap;
use std::io::Write;
use std::path::PathBuf;

use super::Failure;
use super::mapping::MappingOption;
use super::notes;
use super::pairs::once;
use super::recording::{format_of, read_bytes, refused};
use crate::ingest::{self, IngestError, Limits, Part};

/// Joins files of one flight, each with its own times, and writes one recording as CSV, in SI. Every channel keeps its samples;
/// nothing is interpolated.
#[derive(clap::Args, Debug)]
pub(super) struct Join {
    /// Recordings: what `fit` reads. The time is that of the first.
    #[arg(required = true, num_args = 2..)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    mapping: MappingOption,
    /// Seconds that are added to the times of a file, as it is named here: "air.csv=0.12"; may be given several times. It must be
    /// said where the clock of a file is of another kind than that of the first.
    #[arg(long = "offset", value_name = "FILE=S")]
    offsets: Vec<String>,
    /// Where to write it; without, to the standard output.
    #[arg(long, short)]
    output: Option<PathBuf>,
}

impl Join {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let (mapping, limits) = (self.mapping.read()?, Limits::default());
        self.check_names()?;
        let offsets = self.offsets()?;
        let mut parts = Vec::new();
        for file in &self.files {
            let bytes = read_bytes(file)?;
            let reading =
                ingest::read_recording(&bytes, format_of(file), None, mapping.as_ref(), &limits);
            let name = file.to_string_lossy().into_owned();
            parts.push(Part {
                reading: reading.map_err(|error| refused(file, &error))?,
                offset: offsets.get(&name).copied(),
                name,
            });
            ingest::check_together(&parts, &limits).map_err(|error| not_joined(&error))?;
        }
        let joined = ingest::join(parts, &limits).map_err(|error| not_joined(&error))?;
        for line in notes::lines(&joined.findings) {
            eprintln!("{line}");
        }
        let csv = ingest::to_csv(&joined.maneuver, |_| true);
        match &self.output {
            Some(file) => std::fs::write(file, csv)
                .map_err(|error| Failure::new(format!("{}: {error}", file.display()))),
            None => std::io::stdout()
                .write_all(csv.as_bytes())
                .map_err(|error| Failure::new(error.to_string())),
        }
    }

    /// # Errors
    /// A file is named twice, or would be written over.
    fn check_names(&self) -> Result<(), Failure> {
        let real = |file: &PathBuf| std::fs::canonicalize(file).unwrap_or_else(|_| file.clone());
        let files: Vec<PathBuf> = self.files.iter().map(real).collect();
        for (number, file) in files.iter().enumerate() {
            if files[..number].contains(file) {
                let file = self.files[number].display();
                return Err(Failure::new(format!("{file} is named twice")));
            }
        }
        match self
            .output
            .as_ref()
            .filter(|file| files.contains(&real(file)))
        {
            Some(file) => Err(Failure::new(format!(
                "--output {} is one of the files that are joined; write to another",
                file.display()
            ))),
            None => Ok(()),
        }
    }

    /// Seconds by file.
    fn offsets(&self) -> Result<HashMap<String, f64>, Failure> {
        let mut offsets = HashMap::new();
        for text in &self.offsets {
            // the name of a file may have a '=' in it
            let said = text.rsplit_once('=');
            let said = said.and_then(|(file, seconds)| Some((file, seconds.parse::<f64>().ok()?)));
            let (file, seconds) = said.ok_or_else(|| {
                Failure::new(format!("--offset '{text}': write it like air.csv=0.12"))
            })?;
            if !self.files.iter().any(|other| other.as_os_str() == file) {
                return Err(Failure::new(format!(
                    "--offset '{text}': no file is called '{file}' here"
                )));
            }
            let before = offsets.insert(file.to_string(), seconds);
            once("--offset", file, before.is_some())?;
        }
        Ok(offsets)
    }
}

fn not_joined(error: &IngestError) -> Failure {
    Failure::faults("the files cannot be joined", error.faults())
}
