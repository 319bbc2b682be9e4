//! `trimtab health`: for those that start and watch a server, where no other client is at hand.

use super::Failure;
use super::client::Client;
use super::server::ServerOption;

/// Says whether a server can serve requests, its database included; the exit code is 0 or 1.
#[derive(clap::Args, Debug)]
pub(super) struct Health {
    #[command(flatten)]
    server: ServerOption,
}

impl Health {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        Client::of(&self.server)?.ready().await?;
        println!("ready");
        Ok(())
    }
}
