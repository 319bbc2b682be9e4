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
