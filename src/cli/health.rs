//! `trimtab health`: for those that start and watch a server, where no other client is at hand.

use super::Failure;
use super::client::Client;

/// Says whether a server can serve requests, its database included; the exit code is 0 or 1.
#[derive(clap::Args, Debug)]
pub struct Health {
    #[arg(long, env = "TRIMTAB_SERVER", default_value = super::DEFAULT_SERVER)]
    server: String,
}

impl Health {
    pub async fn run(&self) -> Result<(), Failure> {
        Client::new(&self.server)?.ready().await?;
        println!("ready");
        Ok(())
    }
}
