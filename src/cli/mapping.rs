//! The mapping that says what the columns of recordings are.

use std::path::Path;

use super::Failure;
use super::recording::read_text;
use crate::ingest::Mapping;

#[derive(clap::Args, Debug)]
pub(super) struct MappingOption {
    /// Where recordings have time and channels, and in which units, if they do not say it or say it otherwise: the name of a
    /// bundled mapping, or a mapping document (.toml, .json). `trimtab inspect FILE` prints a draft.
    #[arg(long, value_name = "FILE|NAME")]
    mapping: Option<String>,
}

impl MappingOption {
    /// As a server reads it: the name of a bundled mapping, or a JSON document.
    pub(super) fn text(&self) -> Result<Option<String>, Failure> {
        let Some(mapping) = &self.mapping else {
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

    /// The mapping, if there is one.
    pub(super) fn read(&self) -> Result<Option<Mapping>, Failure> {
        let read = |text: String| {
            Mapping::named_or_json(&text)
                .map_err(|fault| Failure::new(format!("--mapping: {fault}")))
        };
        self.text()?.map(read).transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mapping_is_a_name_or_a_file() {
        let option = |mapping: &str| MappingOption {
            mapping: Some(mapping.to_string()),
        };
        assert!(option("sidpac").read().unwrap().is_some());
        assert!(option("sidpack").read().is_err());
        assert!(MappingOption { mapping: None }.read().unwrap().is_none());

        let directory = tempfile::TempDir::new().unwrap();
        let file = directory.path().join("mapping.toml");
        let text =
            "time = {step = 0.5, unit = \"s\"}\n[channels]\na = {from = \"a\", unit = \"deg\"}\n";
        std::fs::write(&file, text).unwrap();
        let found = option(file.to_str().unwrap()).read().unwrap();
        assert_eq!(found, Some(Mapping::from_toml(text).unwrap()));
    }
}
