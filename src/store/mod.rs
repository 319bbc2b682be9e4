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
//! * What users ask for is asked of a [`Project`], and no project sees anything of another.

mod address;
mod answers;
mod clock;
mod columns;
mod engine;
mod jobs;
mod keys;
mod lease;
mod log;
mod maneuvers;
mod mappings;
mod migrate;
mod models;
mod neighbours;
mod page;
mod project;
mod queue;
mod results;
mod retention;
mod signal;
mod tallies;
mod webhooks;
mod writing;

use std::sync::Arc;
use std::time::Duration;

use sqlx::AnyPool;
use tokio::time::{Instant, sleep};
use tokio_util::sync::DropGuard;

pub use address::{is_missing, without_password};
pub use answers::{KeptAnswer, Once};
pub use clock::Clock;
pub use jobs::{CancelReply, JobFilter, JobRecord, NewJob};
pub use keys::{Key, KeyRecord, NewKey, Scope, Shown};
pub use lease::{Claim, LEASE, MOST_LOST_WORKERS};
pub use log::StoredEvent;
pub use maneuvers::{ManeuverRecord, Uploaded};
pub use mappings::MappingRecord;
pub use models::ModelRecord;
pub use page::{BadCursor, Page};
pub use project::{DEFAULT_PROJECT, Project};
pub use queue::Waiting;
pub use results::{Part, ResultParts};
pub use retention::{Deleted, Expired, Rule};
pub use signal::{Listener, Signal};
pub use tallies::{BUCKETS, Census, Histogram};
pub use webhooks::{Attempt, Delivery, DeliveryRecord, Webhook};

use engine::Engine;

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
    /// Whether it is the database that does not answer, and the same may well go through in a while.
    pub fn is_passing(&self) -> bool {
        use sqlx::Error::{Io, PoolClosed, PoolTimedOut, Protocol, Tls, WorkerCrashed};
        match self {
            Self::Database(
                Io(_) | PoolClosed | PoolTimedOut | Protocol(_) | Tls(_) | WorkerCrashed,
            ) => true,
            // PostgreSQL: connections, operator's intervention (shutting down, starting up), serialisation
            Self::Database(sqlx::Error::Database(error)) => error.code().is_some_and(|code| {
                ["08", "57", "40"]
                    .iter()
                    .any(|class| code.starts_with(class))
                    && code.len() == 5
            }),
            _ => false,
        }
    }

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
    engine: Engine,
    readers: AnyPool,
    writer: AnyPool,
    clock: Clock,
    signals: signal::Signals,
    /// Kept as long as signals of other processes are to be heard.
    _neighbours: Option<Arc<DropGuard>>,
}

impl Store {
    /// Opens the database at `address` and creates what is missing: a file (a path or `sqlite:PATH`), or
    /// `postgres://USER:PASSWORD@HOST/DATABASE`, which many machines may share.
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
        let (engine, url) = address::connection(address)?;
        let deadline = Instant::now() + engine.patience();
        loop {
            match Self::connect(engine, &url, &clock).await {
                Err(error) if error.is_passing() && Instant::now() < deadline => {
                    tracing::warn!(%error, "the database does not answer yet; trying again");
                    sleep(Duration::from_secs(1)).await;
                }
                Err(StoreError::Database(error)) => {
                    return Err(StoreError::Address {
                        address: without_password(address),
                        why: error.to_string(),
                    });
                }
                opened => return opened,
            }
        }
    }

    async fn connect(engine: Engine, url: &str, clock: &Clock) -> Result<Self, StoreError> {
        let writer = engine.pool(engine.writers()).connect(url).await?;
        let readers = engine.pool(8).connect(url).await?;
        let signals = signal::Signals::new();
        let neighbours = match engine {
            Engine::Sqlite => None,
            Engine::Postgres => Some(neighbours::listen(url, &readers, clock, &signals).await?),
        };
        let store = Self {
            engine,
            readers,
            writer,
            clock: clock.clone(),
            signals,
            _neighbours: neighbours,
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
