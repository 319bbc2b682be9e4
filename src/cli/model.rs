//! `trimtab model`: the catalog, to read and to start one's own model from.

use super::Failure;
use crate::model::catalog;

/// Lists the catalog, or prints one model document of it as TOML.
#[derive(clap::Args, Debug)]
pub(super) struct ShowModel {
    /// A name of the list.
    name: Option<String>,
}

impl ShowModel {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let Some(name) = &self.name else {
            for document in catalog::all() {
                println!("{:36} {}", document.name, document.title);
            }
            return Ok(());
        };
        let text = catalog::text(name).ok_or_else(|| {
            let known: Vec<String> = catalog::all()
                .into_iter()
                .map(|document| document.name)
                .collect();
            Failure::new(format!(
                "there is no catalog model '{name}'; the catalog has {}",
                known.join(", ")
            ))
        })?;
        print!("{text}");
        Ok(())
    }
}
