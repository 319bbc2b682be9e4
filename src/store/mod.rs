//! What is kept: maneuvers, models, jobs, their logs and their results.
//!
//! The store is all that `http` and `work` share. What it promises:
//!
//! * A job that was accepted is on the disk, and so is an event before anybody is told of it.
//! * A job's status changes in the transaction that appends the event which changes it, and the
//!   result of a job arrives in the transaction of its last event: no reader sees a half of it.
//! * A worker holds a job by a lease. Each claim counts the job's `attempt` up; whoever writes with
//!   the number of an earlier attempt is refused ([`StoreError::LeaseLost`]).
//! * Maneuvers, models, specs, events and results are never changed once written.

mod address;
mod clock;
mod columns;
mod jobs;
mod lease;
mod log;
mod maneuvers;
mod migrate;
mod models;
mod page;
mod results;
mod signal;

use std::time::Duration;

use sqlx::any::AnyPoolOptions;
use sqlx::{Any, AnyPool, Executor, Transaction};

pub use clock::Clock;
pub use jobs::{CancelReply, JobFilter, JobRecord, NewJob};
pub use lease::{Claim, LEASE, MOST_LOST_WORKERS};
pub use log::StoredEvent;
pub use maneuvers::{ManeuverRecord, Uploaded};
pub use models::ModelRecord;
pub use page::{BadCursor, Page};
pub use results::{Part, ResultParts};
pub use signal::{Listener, Signal};

/// A statement that waits longer than this for the database gives up.
const ACQUIRE_TIMEOUT: Duration = Duration::from_secs(10);

#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    #[error("the database '{address}' cannot be used: {why}")]
    Address { address: String, why: String },
    #[error(
        "the database is of a later version of Trimtab (schema {reached}, this one knows {known}); use that version, or another database"
    )]
    LaterVersion { reached: i64, known: i64 },
    #[error("database: {0}")]
    Database(#[from] sqlx::Error),
    #[error("{what} in the database cannot be read: {why}")]
    Corrupt { what: String, why: String },
    #[error("{what} cannot be written: {why}")]
    Unwritable { what: String, why: String },
    #[error("the lease of the job was lost to another worker")]
    LeaseLost,
}

impl StoreError {
    fn corrupt(what: impl Into<String>, why: impl ToString) -> Self {
        Self::Corrupt {
            what: what.into(),
            why: why.to_string(),
        }
    }
}

/// A handle; clones share one database.
#[derive(Clone)]
pub struct Store {
    readers: AnyPool,
    /// SQLite has one writer at a time: queueing for the one connection is fair and cheap, where
    /// several connections would poll for the lock.
    writer: AnyPool,
    clock: Clock,
    signals: signal::Signals,
}

impl Store {
    /// Opens the database at `address` (a path or `sqlite:PATH`), creates what is missing.
    ///
    /// # Errors
    /// The address cannot be used, or the database is of a later version.
    pub async fn open(address: &str) -> Result<Self, StoreError> {
        Self::open_with_clock(address, Clock::default()).await
    }

    /// As [`Store::open`], with a clock that the caller may put forward.
    ///
    /// # Errors
    /// As [`Store::open`].
    pub async fn open_with_clock(address: &str, clock: Clock) -> Result<Self, StoreError> {
        sqlx::any::install_default_drivers();
        let url = address::connection_url(address)?;
        let cannot = |error: sqlx::Error| StoreError::Address {
            address: address.to_string(),
            why: error.to_string(),
        };
        let writer = pool(1).connect(&url).await.map_err(cannot)?;
        let readers = pool(8).connect(&url).await.map_err(cannot)?;
        let store = Self {
            readers,
            writer,
            clock,
            signals: signal::Signals::new(),
        };
        migrate::run(&store).await?;
        Ok(store)
    }

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

    /// A transaction that reads, and then writes what follows from it: it has the write lock from
    /// the beginning, so nothing it read can have changed when it writes.
    async fn begin(&self) -> Result<Transaction<'static, Any>, StoreError> {
        Ok(self.writer.begin_with("BEGIN IMMEDIATE").await?)
    }
}

fn pool(connections: u32) -> AnyPoolOptions {
    AnyPoolOptions::new()
        .max_connections(connections)
        .acquire_timeout(ACQUIRE_TIMEOUT)
        .idle_timeout(None)
        .max_lifetime(None)
        .after_connect(|connection, _| {
            Box::pin(async move {
                // WAL: readers do not block the writer. FULL: what was committed outlives a power cut.
                for pragma in [
                    "PRAGMA busy_timeout = 5000",
                    "PRAGMA journal_mode = WAL",
                    "PRAGMA synchronous = FULL",
                    "PRAGMA foreign_keys = ON",
                ] {
                    connection.execute(pragma).await?;
                }
                Ok(())
            })
        })
}

/// Runs what takes long (encoding and decoding of long columns) where it does not hold up the reactor.
async fn off_reactor<T: Send + 'static>(
    what: &str,
    work: impl FnOnce() -> Result<T, StoreError> + Send + 'static,
) -> Result<T, StoreError> {
    match tokio::task::spawn_blocking(work).await {
        Ok(result) => result,
        Err(error) => Err(StoreError::corrupt(what, error)),
    }
}
