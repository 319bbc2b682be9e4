//! The database, open: what all that is kept is read from and written to.

use std::sync::Arc;
use std::time::Duration;

use sqlx::AnyPool;
use tokio::time::timeout;
use tokio_util::sync::DropGuard;

use super::clock::Clock;
use super::engine::Engine;
use super::error::StoreError;
use super::signal::{Listener, Signals};

/// A probe that takes longer is of a database that does not answer.
const PROBE: Duration = Duration::from_secs(3);

/// A handle; clones share one database.
#[derive(Clone)]
pub struct Store {
    pub(super) engine: Engine,
    pub(super) readers: AnyPool,
    pub(super) writer: AnyPool,
    pub(super) clock: Clock,
    pub(super) signals: Signals,
    /// Kept as long as signals of other processes are to be heard.
    pub(super) _neighbours: Option<Arc<DropGuard>>,
}

impl Store {
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// For those who wait; call it before looking for what is waited for.
    pub fn listen(&self) -> Listener {
        self.signals.listen()
    }

    /// Whether the database answers and can be written: what is accepted has to be kept.
    ///
    /// # Errors
    /// It does not, or cannot, within some seconds.
    pub async fn ping(&self) -> Result<(), StoreError> {
        let probe = async {
            // changes nothing, and is written nevertheless
            sqlx::query("UPDATE schema_steps SET applied = applied WHERE version = 1")
                .execute(&self.writer)
                .await
        };
        let in_time = timeout(PROBE, probe).await;
        in_time.unwrap_or(Err(sqlx::Error::PoolTimedOut))?;
        Ok(())
    }

    /// Writes back and closes; what is under way is awaited.
    pub async fn close(&self) {
        self.readers.close().await;
        self.writer.close().await;
    }
}
