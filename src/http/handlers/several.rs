//! Several files as one recording: a body of `multipart/form-data` to `POST /v1/maneuvers`.

use std::collections::BTreeMap;

use serde_json::value::RawValue;
use utoipa::ToSchema;

use super::mappings;
use crate::http::code::Code;
use crate::http::problem::Problem;
use crate::http::request::json;
use crate::http::request::multipart::Part;
use crate::http::service::Service;
use crate::ingest::{self, Format, IngestError, Limits, Mapping, Reading};
use crate::job::Fault;

/// Characters of the name of a file.
const LONGEST_NAME: usize = 200;

/// Files that are one recording, each with its own times; and what is said of them by their names.
#[derive(ToSchema)]
#[expect(dead_code, reason = "it is there for the API's document")]
pub(crate) struct SeveralFiles {
    /// Each as it could be uploaded by itself.
    #[schema(value_type = Vec<String>, format = Binary)]
    file: Vec<Vec<u8>>,
    /// JSON: seconds that are added to the times of a file. It must be said of those whose clock is of another kind than that
    /// of the first.
    #[schema(example = "{\"air.csv\": 0.12}")]
    offsets: Option<String>,
    /// JSON: the mapping of a file, by name or written out; `?mapping=` is that of all others.
    #[schema(example = "{\"air.csv\": \"logger-3\"}")]
    mappings: Option<String>,
}

/// What is said of the files of a body.
pub(super) struct Said {
    offsets: BTreeMap<String, f64>,
    mappings: BTreeMap<String, Mapping>,
}

/// What a body says of its files.
pub(super) async fn said(service: &Service, parts: &[Part]) -> Result<Said, Problem> {
    let mut said = Said {
        offsets: BTreeMap::new(),
        mappings: BTreeMap::new(),
    };
    let files = files(parts)?;
    let fields: Vec<&Part> = parts.iter().filter(|part| part.file.is_none()).collect();
    for (number, part) in fields.iter().enumerate() {
        let name = short(&part.name);
        if fields[..number].iter().any(|other| other.name == part.name) {
            let detail = format!("the field '{name}' is there twice; say all of it in one");
            return Err(Problem::new(Code::InvalidMultipart, detail));
        }
        let limit = service.config.max_json_body;
        if part.bytes.len() > limit {
            let detail =
                format!("the field '{name}' is longer than {limit} bytes (--max-json-body)");
            return Err(Problem::new(Code::BodyTooLarge, detail));
        }
        let text = || json::text(part.bytes.to_vec());
        match part.name.as_str() {
            "offsets" => {
                said.offsets = json::parse(&text()?)?;
                check("offsets", said.offsets.keys(), &files)?;
            }
            "mappings" => {
                let all: BTreeMap<String, Box<RawValue>> = json::parse(&text()?)?;
                check("mappings", all.keys(), &files)?;
                for (file, mapping) in all {
                    let name = serde_json::from_str::<String>(mapping.get());
                    let mapping = name.unwrap_or_else(|_| mapping.get().to_string());
                    let mapping = mappings::find(service, &mapping).await?;
                    said.mappings.insert(file, mapping);
                }
            }
            _ => {
                let detail = format!(
                    "there is a field '{name}'; beside files there are \"offsets\" and \"mappings\""
                );
                return Err(Problem::new(Code::InvalidMultipart, detail));
            }
        }
    }
    Ok(said)
}

/// The beginning of a stranger's name.
fn short(name: &str) -> String {
    name.chars().take(60).collect()
}

/// The files of a body with their names.
fn files(parts: &[Part]) -> Result<Vec<(&str, &Part)>, Problem> {
    let files = parts
        .iter()
        .filter_map(|part| Some((part.file.as_deref()?, part)));
    let files: Vec<(&str, &Part)> = files.collect();
    if files.is_empty() {
        let detail = "there is no file in it; send each as a part with a filename, as curl -F 'file=@imu.csv' does";
        return Err(Problem::new(Code::InvalidMultipart, detail));
    }
    for (at, (name, _)) in files.iter().enumerate() {
        if name.chars().count() > LONGEST_NAME {
            let name = short(name);
            let detail = format!(
                "the name of a file, '{name}...', is longer than {LONGEST_NAME} characters"
            );
            return Err(Problem::new(Code::InvalidMultipart, detail));
        }
        if files[..at].iter().any(|(other, _)| other == name) {
            let detail =
                format!("two files are called '{name}'; offsets and mappings go by their names");
            return Err(Problem::new(Code::InvalidMultipart, detail));
        }
    }
    Ok(files)
}

/// What is said is said of a file that is there.
fn check<'n>(
    field: &str,
    mut named: impl Iterator<Item = &'n String>,
    files: &[(&str, &Part)],
) -> Result<(), Problem> {
    match named.find(|name| !files.iter().any(|(file, _)| file == name)) {
        None => Ok(()),
        Some(name) => {
            let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
            let detail = format!(
                "{field}: there is no file '{}'; there are {}",
                short(name),
                names.join(", ")
            );
            Err(Problem::new(Code::InvalidMultipart, detail))
        }
    }
}

/// Reads the files of a body as one recording; `mapping` is that of those of which none is said.
pub(super) fn read(
    parts: &[Part],
    said: &Said,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, Problem> {
    let mut readings = Vec::new();
    let mut faults = Vec::new();
    for (name, part) in files(parts)? {
        let extension = name
            .rsplit_once('.')
            .and_then(|(_, extension)| Format::from_extension(extension));
        let stated = Format::from_content_type(&part.media_type())
            .filter(|format| *format != Format::Unstated);
        let format = extension.or(stated).unwrap_or(Format::Unstated);
        let charset = Format::charset(&part.content_type);
        let mapping = said.mappings.get(name).or(mapping);
        match ingest::read_recording(&part.bytes, format, charset, mapping, limits) {
            Ok(reading) => readings.push(ingest::Part {
                name: name.to_string(),
                reading,
                offset: said.offsets.get(name).copied(),
            }),
            Err(error) => faults.extend(of_file(name, &error)),
        }
        // before more of them is in memory
        ingest::check_together(&readings, limits)?;
    }
    if !faults.is_empty() {
        return Err(Problem::of_faults(Code::InvalidManeuver, faults));
    }
    Ok(ingest::join(readings, limits)?)
}

fn of_file(name: &str, error: &IngestError) -> Vec<Fault> {
    let place = format!("/files/{}", crate::flight::escape(name));
    let faults = error.faults().iter();
    faults.map(|fault| fault.clone().under(&place)).collect()
}
