//! What may go wrong with the store.

/// What went wrong.
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

    pub(super) fn corrupt(what: impl Into<String>, why: impl ToString) -> Self {
        Self::Corrupt {
            what: what.into(),
            why: why.to_string(),
        }
    }
}
