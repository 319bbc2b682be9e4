//! The two databases that the store can live in, and all that they differ in.

use std::time::Duration;

use sqlx::any::AnyPoolOptions;
use sqlx::{AnyConnection, Connection, Executor};

/// A statement that waits longer than this for the database gives up.
const ACQUIRE_TIMEOUT: Duration = Duration::from_secs(10);

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Engine {
    /// A file. One process has it; others may look in.
    Sqlite,
    /// A server that many machines share.
    Postgres,
}

impl Engine {
    /// How a transaction begins that reads, and then writes what follows from it. SQLite locks the file from the beginning;
    /// PostgreSQL locks the rows that are read, see [`Engine::locking`].
    pub(super) fn begin(self) -> &'static str {
        match self {
            Self::Sqlite => "BEGIN IMMEDIATE",
            Self::Postgres => "BEGIN",
        }
    }

    /// Behind a `SELECT`: nobody else changes these rows until the transaction ends.
    pub(super) fn locking(self) -> &'static str {
        match self {
            Self::Sqlite => "",
            Self::Postgres => "FOR UPDATE",
        }
    }

    /// Behind a `SELECT`: nobody else changes or deletes these rows until the transaction ends, and others may say the same.
    pub(super) fn sharing(self) -> &'static str {
        match self {
            Self::Sqlite => "",
            Self::Postgres => "FOR SHARE",
        }
    }

    /// As [`Engine::locking`], passing over rows that another has locked.
    pub(super) fn locking_the_next(self) -> &'static str {
        match self {
            Self::Sqlite => "",
            Self::Postgres => "FOR UPDATE SKIP LOCKED",
        }
    }

    /// A schema step in this database's words. Steps are written for SQLite; text sorts by its bytes in either.
    pub(super) fn schema(self, step: &str) -> String {
        match self {
            Self::Sqlite => step.to_string(),
            Self::Postgres => step
                .replace(" BLOB", " BYTEA")
                .replace(" TEXT", " TEXT COLLATE \"C\"")
                .replace(" WITHOUT ROWID", ""),
        }
    }

    /// Before a transaction looks at the schema: only one process at a time brings it up to date, and that a table is there
    /// already is no news.
    pub(super) fn before_schema(self) -> &'static [&'static str] {
        match self {
            Self::Sqlite => &[],
            Self::Postgres => &[
                "SET LOCAL client_min_messages = warning",
                "SELECT pg_advisory_xact_lock(20261121)",
            ],
        }
    }

    /// Connections of a pool, at most. SQLite has one writer at a time: queueing for the one connection is fair and cheap,
    /// where several connections would poll for the lock.
    pub(super) fn writers(self) -> u32 {
        match self {
            Self::Sqlite => 1,
            Self::Postgres => 8,
        }
    }

    /// How long a database is waited for that does not answer yet: a server may be starting, too.
    pub(super) fn patience(self) -> Duration {
        match self {
            Self::Sqlite => Duration::ZERO,
            Self::Postgres => Duration::from_secs(30),
        }
    }

    pub(super) fn pool(self, connections: u32) -> AnyPoolOptions {
        let pool = AnyPoolOptions::new()
            .max_connections(connections)
            .acquire_timeout(ACQUIRE_TIMEOUT)
            .after_connect(move |connection, _| Box::pin(self.prepare(connection)))
            .after_release(|connection, _| Box::pin(is_clear(connection)));
        match self {
            Self::Sqlite => pool.idle_timeout(None).max_lifetime(None),
            Self::Postgres => pool,
        }
    }

    /// Finds out, within some seconds, whether the database can be written at all. Who starts is not kept waiting as one whose work is
    /// waited for.
    pub(super) async fn try_to_lock(self, connection: &mut AnyConnection) -> sqlx::Result<()> {
        if self == Self::Sqlite {
            for step in ["PRAGMA busy_timeout = 2500", "BEGIN IMMEDIATE", "ROLLBACK"] {
                connection.execute(step).await?;
            }
        }
        Ok(())
    }

    /// Why a database could not be opened, and what to do.
    pub(super) fn why_not_opened(self, error: &sqlx::Error) -> String {
        let code = error.as_database_error().and_then(|error| error.code());
        let code = code.and_then(|code| code.parse::<u32>().ok());
        let remedy = match code.map(|code| code & 0xff) {
            Some(5 | 6) if self == Self::Sqlite => {
                "another process holds it locked; wait until it is done, or end it"
            }
            Some(8) if self == Self::Sqlite => {
                "it cannot be written; see to the permissions of the file and its directory"
            }
            Some(11) if self == Self::Sqlite => "it is damaged; restore a backup",
            Some(13) if self == Self::Sqlite => "its disk is full; make room there",
            Some(14) if self == Self::Sqlite => {
                "it cannot be opened; see to the permissions of the file and its directory"
            }
            Some(26) if self == Self::Sqlite => "it is a file of another kind; name another",
            _ => return error.to_string(),
        };
        format!("{remedy} ({error})")
    }

    pub(super) async fn prepare(self, connection: &mut AnyConnection) -> sqlx::Result<()> {
        let settings: &[&'static str] = match self {
            // WAL: readers do not block the writer. FULL: what was committed outlives a power cut.
            Self::Sqlite => &[
                "PRAGMA busy_timeout = 5000",
                "PRAGMA journal_mode = WAL",
                "PRAGMA synchronous = FULL",
                "PRAGMA foreign_keys = ON",
            ],
            // a server that was told not to wait for the disk is told otherwise; one that hangs is given up
            Self::Postgres => &[
                "SET synchronous_commit = on",
                "SET statement_timeout = '30s'",
                "SET idle_in_transaction_session_timeout = '30s'",
            ],
        };
        for setting in settings {
            connection.execute(*setting).await?;
        }
        Ok(())
    }
}

/// Whether a connection that comes back has no transaction any more. SQLite ends one by itself where the disk is full, so
/// that it cannot be rolled back; the driver then believes for ever that it goes on. Such a connection is thrown away.
async fn is_clear(connection: &mut AnyConnection) -> sqlx::Result<bool> {
    // behind a rollback that is under way
    connection.ping().await?;
    Ok(!connection.is_in_transaction())
}
