//! The database, open: what all that is kept is read from and written to.

use std::sync::Arc;

use sqlx::AnyPool;
use tokio_util::sync::DropGuard;

use super::clock::Clock;
use super::engine::Engine;
use super::error::StoreError;
use super::looked::Looked;
use super::readiness::Readiness;
use super::signal::{Listener, Signals};

/// A handle; clones share one database.
#[derive(Clone)]
pub struct Store {
    pub(super) engine: Engine,
    pub(super) readers: AnyPool,
    pub(super) writer: AnyPool,
    pub(super) clock: Clock,
    pub(super) signals: Signals,
    pub(super) readiness: Readiness,
    pub(super) looked: Looked,
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

    /// Whether the database answers and can be written: what is accepted has to be kept. Known to a second.
    ///
    /// # Errors
    /// It does not, or cannot, within two seconds.
    pub async fn ping(&self) -> Result<(), StoreError> {
        // SQLite does not write a row again that is what it was
        let now = format!("{} {}", self.clock.now_text(), self.clock.new_id());
        let probe = async {
            let probe = sqlx::query("UPDATE probe SET at = $1").bind(now);
            probe.execute(&self.writer).await.map(drop)
        };
        self.readiness.known_or(probe).await
    }

    /// Writes back and closes; what is under way is awaited.
    pub async fn close(&self) {
        self.readers.close().await;
        self.writer.close().await;
    }
}
