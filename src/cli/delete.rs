//! `trimtab delete`: jobs, recordings, models and mappings of a server.

use clap::{Args, ValueEnum};

use super::Failure;
use super::client::{Client, in_path};
use super::server::ServerOption;

/// Deletes jobs with their results, recordings that no job uses, stored models (jobs keep their copy), or mappings. It cannot be
/// undone, and needs a key with the scope `admin` where there are keys.
#[derive(Args, Debug)]
pub(super) struct Delete {
    /// What it is.
    #[arg(value_name = "job|maneuver|model|mapping", hide_possible_values = true)]
    what: What,
    /// Ids; of mappings, names.
    #[arg(required = true, value_name = "ID")]
    ids: Vec<String>,
    #[command(flatten)]
    server: ServerOption,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum What {
    Job,
    Maneuver,
    Model,
    Mapping,
}

impl What {
    fn collection(self) -> &'static str {
        match self {
            Self::Job => "jobs",
            Self::Maneuver => "maneuvers",
            Self::Model => "models",
            Self::Mapping => "mappings",
        }
    }
}

impl Delete {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        let client = Client::of(&self.server)?;
        for id in &self.ids {
            let path = format!("{}/{}", self.what.collection(), in_path(id));
            let done = client.delete(&path).await;
            done.map_err(|failure| Failure::new(format!("{id}: {failure}")))?;
            println!("{id} deleted");
        }
        Ok(())
    }
}
