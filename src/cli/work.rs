//! `trimtab work`: workers without an API, on as many machines as there are.

use clap::Args;
use tokio_util::sync::CancellationToken;

use super::Failure;
use super::process::Process;
use crate::work;

/// Run workers alone: they take jobs from a database that `serve` processes and other workers share.
#[derive(Args)]
pub(super) struct Work {
    #[command(flatten)]
    process: Process,
}

impl Work {
    pub(super) fn run(&self) -> Result<(), Failure> {
        self.process.run(|shutdown| self.work(shutdown))
    }

    async fn work(&self, shutdown: CancellationToken) -> Result<(), Failure> {
        let workers = self.process.workers();
        let count = workers.count;
        if count == 0 {
            return Err(Failure::new(
                "with --workers 0 there is nothing to do; leave it out for one worker on each core",
            ));
        }
        let store = self.process.database.open().await?;
        let database = self.process.database.shown();
        println!("{count} workers on {database}");
        tracing::info!(database, workers = count, "ready");
        work::run(store.clone(), workers, shutdown).await;
        store.close().await;
        Ok(())
    }
}
