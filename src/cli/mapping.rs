//! The mapping of recordings that say no names and units.

use std::path::Path;

use super::Failure;
use super::recording::{format_of, read_text};
use crate::ingest::{Format, Mapping};

#[derive(clap::Args, Debug)]
pub(super) struct MappingOption {
    /// Where MAT files, ASCII matrices, workbooks and logs have time and channels: ardupilot, fvsysid-attas, fvsysid-hfb320,
    /// px4, sidpac, or a mapping document (.toml, .json).
    #[arg(long, value_name = "FILE|NAME")]
    mapping: Option<String>,
}

impl MappingOption {
    /// As a server reads it: the name of a bundled mapping, or a JSON document. `None` for a recording that says names
    /// and units itself.
    pub(super) fn text(&self, recording: &Path) -> Result<Option<String>, Failure> {
        let needs_one = matches!(
            format_of(recording),
            Format::Mat | Format::Ascii | Format::Unstated
        );
        let Some(mapping) = self.mapping.as_ref().filter(|_| needs_one) else {
            return Ok(None);
        };
        let file = Path::new(mapping);
        let extension = file.extension().and_then(|extension| extension.to_str());
        let of_this_file = |error: String| Failure::new(format!("{mapping}: {error}"));
        match extension {
            Some("json") => Ok(Some(read_text(file)?)),
            Some("toml") => {
                let document: toml::Table = toml::from_str(&read_text(file)?)
                    .map_err(|error| of_this_file(error.to_string()))?;
                let text = serde_json::to_string(&document);
                text.map(Some)
                    .map_err(|error| of_this_file(error.to_string()))
            }
            _ => Ok(Some(mapping.clone())),
        }
    }

    /// The mapping of a recording; `None` for one that says names and units itself.
    pub(super) fn of(&self, recording: &Path) -> Result<Option<Mapping>, Failure> {
        let read = |text: String| {
            Mapping::named_or_json(&text)
                .map_err(|fault| Failure::new(format!("--mapping: {fault}")))
        };
        self.text(recording)?.map(read).transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mapping_goes_with_files_that_need_one() {
        let option = |mapping: &str| MappingOption {
            mapping: Some(mapping.to_string()),
        };
        let recording = Path::new("flight.MAT");
        assert_eq!(format_of(recording), Format::Mat);
        assert_eq!(format_of(Path::new("flight")), Format::Csv);
        assert!(option("sidpac").of(recording).unwrap().is_some());
        assert!(
            option("sidpac")
                .of(Path::new("flight.csv"))
                .unwrap()
                .is_none()
        );
        assert!(option("sidpack").of(recording).is_err());

        let directory = tempfile::TempDir::new().unwrap();
        let file = directory.path().join("mapping.toml");
        let text =
            "time = {step = 0.5, unit = \"s\"}\n[channels]\na = {from = \"a\", unit = \"deg\"}\n";
        std::fs::write(&file, text).unwrap();
        let found = option(file.to_str().unwrap()).of(recording).unwrap();
        assert_eq!(found, Some(Mapping::from_toml(text).unwrap()));
    }
}
