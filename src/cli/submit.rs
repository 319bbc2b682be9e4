//! `trimtab submit`: recordings and a job to a server.

use indexmap::IndexMap;

use super::client::{Client, Stored};
use super::recording::read_bytes;
use super::request::Request;
use super::server::ServerOption;
use super::watch::{conclude, follow};
use super::{Failure, table};
use crate::job::JobKind;

/// Uploads recordings, submits a job and prints its id.
#[derive(clap::Args, Debug)]
pub(super) struct Submit {
    #[command(flatten)]
    request: Request,
    #[command(flatten)]
    server: ServerOption,
    /// Find what the model lacks: a job of the kind `diagnose`.
    #[arg(long)]
    diagnose: bool,
    /// Follow the job and print its parameter table.
    #[arg(long, short)]
    watch: bool,
}

impl Submit {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        let client = Client::of(&self.server)?;
        let mut uploaded = IndexMap::new();
        for file in self.request.files() {
            let name = file
                .file_stem()
                .map_or("recording".into(), |stem| stem.to_string_lossy());
            let mapping = self.request.mapping.text()?;
            let stored: Stored = client
                .upload(&name, file, mapping.as_deref(), read_bytes(file)?)
                .await?;
            uploaded.insert(file, stored.id);
        }
        let recordings = self.request.file_rows();
        let ids: Vec<String> = recordings
            .map(|rows| uploaded[rows.file.as_path()].clone())
            .collect();
        let mut spec = self.request.spec(&ids)?;
        if self.diagnose {
            spec.kind = JobKind::Diagnose;
        }
        let job = client.submit(&spec).await?;
        println!("{}", job.id);
        if self.watch {
            let estimate = follow(&client, &job.id).await?;
            println!("{}", table::result(&estimate, None));
            conclude(&client, &job.id, &estimate).await?;
        }
        Ok(())
    }
}
