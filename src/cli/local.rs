//! A server of this process, for a command that needs one.

use std::path::PathBuf;

use tokio_util::sync::CancellationToken;

use super::Failure;
use crate::store::Store;
use crate::{http, work};

/// Nothing of it is logged.
pub(super) struct Local {
    pub url: String,
    shutdown: CancellationToken,
    running: tokio::task::JoinHandle<()>,
    store: Store,
    /// Removed when the server has stopped.
    directory: Option<PathBuf>,
}

impl Local {
    /// On `listen`, with `database` or with one that goes away again.
    pub(super) async fn start(listen: &str, database: Option<&str>) -> Result<Self, Failure> {
        let (database, directory) = match database {
            Some(database) => (database.to_string(), None),
            None => {
                let directory =
                    std::env::temp_dir().join(format!("trimtab-{}", uuid::Uuid::now_v7()));
                std::fs::create_dir(&directory)?;
                (
                    directory.join("trimtab.db").display().to_string(),
                    Some(directory),
                )
            }
        };
        let store = Store::open(&database).await?;
        let listener = http::bind(listen, &store).await?;
        let url = format!("http://{}", listener.local_addr()?);
        let shutdown = CancellationToken::new();
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let (served, token) = (store.clone(), shutdown.clone());
        let running = tokio::spawn(async move {
            tokio::join!(
                http::run(
                    http::Config::default(),
                    listener,
                    served.clone(),
                    token.clone()
                ),
                work::run(served.clone(), cores, token),
            );
        });
        Ok(Self {
            url,
            shutdown,
            running,
            store,
            directory,
        })
    }

    pub(super) async fn stop(self) -> Result<(), Failure> {
        self.shutdown.cancel();
        self.running.await?;
        self.store.close().await;
        if let Some(directory) = self.directory {
            std::fs::remove_dir_all(directory)?;
        }
        Ok(())
    }
}
