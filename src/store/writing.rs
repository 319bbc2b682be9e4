//! A transaction that writes, and whom to wake when it is kept.

use sqlx::{Any, AnyConnection, Transaction};

use super::engine::Engine;
use super::signal::{CHANNEL, Signal, Signals};
use super::{Store, StoreError};

pub(super) struct Writing {
    transaction: Transaction<'static, Any>,
    engine: Engine,
    signals: Signals,
    told: Vec<Signal>,
}

impl Writing {
    pub(super) fn connection(&mut self) -> &mut AnyConnection {
        &mut self.transaction
    }

    /// Sent when, and only if, the transaction is committed.
    pub(super) fn tell(&mut self, signal: Signal) {
        self.told.push(signal);
    }

    pub(super) async fn commit(mut self) -> Result<(), StoreError> {
        if self.engine == Engine::Postgres {
            for signal in &self.told {
                // part of the transaction: other processes hear of it when it is committed
                sqlx::query("SELECT pg_notify($1, $2)")
                    .bind(CHANNEL)
                    .bind(signal.to_string())
                    .execute(&mut *self.transaction)
                    .await?;
            }
        }
        self.transaction.commit().await?;
        for signal in self.told {
            self.signals.send(signal);
        }
        Ok(())
    }

    /// Gives up what was begun, and what it holds, before it returns. One that is only dropped holds its rows until its
    /// connection is used again: who passes over rows that are held (`SKIP LOCKED`) would not see them.
    pub(super) async fn abandon(self) -> Result<(), StoreError> {
        Ok(self.transaction.rollback().await?)
    }
}

impl Store {
    /// A transaction that reads, and then writes what follows from it.
    pub(super) async fn begin(&self) -> Result<Writing, StoreError> {
        Ok(Writing {
            transaction: self.writer.begin_with(self.engine.begin()).await?,
            engine: self.engine,
            signals: self.signals.clone(),
            told: Vec::new(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::Trouble;

    /// A database that may not grow is to SQLite a disk that is full: it ends the transaction by itself. Found on a full
    /// disk, where no transaction could be begun any more until the process was started again.
    #[tokio::test]
    async fn a_full_disk_is_told_and_costs_the_connection_alone() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("trimtab.db");
        let store = Store::open(file.to_str().unwrap()).await.unwrap();
        sqlx::query("PRAGMA max_page_count = 1")
            .execute(&store.writer)
            .await
            .unwrap();
        let mut writing = store.begin().await.unwrap();
        let full = loop {
            let written = sqlx::query(
                "INSERT INTO schema_steps (version, applied) SELECT MAX(version) + 1, $1 FROM schema_steps",
            )
            .bind("x".repeat(10_000))
            .execute(writing.connection())
            .await;
            if let Err(error) = written {
                break StoreError::from(error);
            }
        };
        assert_eq!(full.trouble(), Some(Trouble::Full), "{full}");
        drop(writing);
        // another connection, without the limit: as if there were room again
        for _ in 0..3 {
            store.begin().await.unwrap().commit().await.unwrap();
        }
        store.ping().await.unwrap();
    }
}
