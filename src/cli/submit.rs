//! `trimtab submit`: recordings and a job to a server.

use super::client::Client;
use super::request::{Request, read_bytes};
use super::watch::follow;
use super::{Failure, table};

/// Uploads recordings, submits a job and prints its id.
#[derive(clap::Args, Debug)]
pub struct Submit {
    #[command(flatten)]
    request: Request,
    #[arg(long, env = "TRIMTAB_SERVER", default_value = super::DEFAULT_SERVER)]
    server: String,
    /// Follow the job and print its parameter table.
    #[arg(long, short)]
    watch: bool,
}

impl Submit {
    pub async fn run(&self) -> Result<(), Failure> {
        let client = Client::new(&self.server)?;
        let mut ids = Vec::new();
        for file in self.request.files() {
            let name = file
                .file_stem()
                .map_or("recording".into(), |stem| stem.to_string_lossy());
            ids.push(client.upload(&name, file, read_bytes(file)?).await?.id);
        }
        let job = client.submit(&self.request.spec(&ids)?).await?;
        println!("{}", job.id);
        if self.watch {
            let estimate = follow(&client, &job.id).await?;
            println!("{}", table::result(&estimate, None));
        }
        Ok(())
    }
}
