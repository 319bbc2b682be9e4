//! `trimtab cancel`: jobs of a server, ended before their time.

use clap::Args;

use super::Failure;
use super::client::{Client, in_path};
use super::server::ServerOption;

/// Asks for the end of jobs. One that waits is cancelled at once; one that runs keeps its best iterate as its result.
#[derive(Args, Debug)]
pub(super) struct Cancel {
    /// Ids of jobs.
    #[arg(required = true, value_name = "JOB")]
    jobs: Vec<String>,
    #[command(flatten)]
    server: ServerOption,
}

impl Cancel {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        let client = Client::of(&self.server)?;
        for job in &self.jobs {
            let asked = client.post(&format!("jobs/{}/cancel", in_path(job))).await;
            let asked = asked.map_err(|failure| Failure::new(format!("{job}: {failure}")))?;
            println!("{job} {}", asked["status"].as_str().unwrap_or_default());
        }
        Ok(())
    }
}
