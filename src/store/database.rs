//! The database, open: what all that is kept is read from and written to.

use std::sync::Arc;

use sqlx::AnyPool;
use tokio_util::sync::DropGuard;

use super::clock::Clock;
use super::engine::Engine;
use super::error::StoreError;
use super::signal::{Listener, Signals};

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

    /// Whether the database answers.
    ///
    /// # Errors
    /// It does not.
    pub async fn ping(&self) -> Result<(), StoreError> {
        sqlx::query("SELECT COUNT(*) FROM schema_steps")
            .fetch_one(&self.readers)
            .await?;
        Ok(())
    }

    /// Writes back and closes; what is under way is awaited.
    pub async fn close(&self) {
        self.readers.close().await;
        self.writer.close().await;
    }
}
