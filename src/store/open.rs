//! Opening a database, whichever engine it has.

use std::time::Duration;

use sqlx::{AnyConnection, Connection, Row};
use tokio::time::{Instant, sleep};
use uuid::Uuid;

use super::address::{connection, without_password};
use super::clock::Clock;
use super::database::Store;
use super::engine::Engine;
use super::error::StoreError;
use super::looked::Looked;
use super::readiness::Readiness;
use super::signal::Signals;
use super::{migrate, neighbours};

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
        let (engine, url) = connection(address)?;
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
                        why: engine.why_not_opened(&error),
                    });
                }
                opened => return opened,
            }
        }
    }

    async fn connect(engine: Engine, url: &str, clock: &Clock) -> Result<Self, StoreError> {
        // a pool tries until its patience ends, and then does not say why
        let mut first = AnyConnection::connect(url).await?;
        engine.try_to_lock(&mut first).await?;
        engine.prepare(&mut first).await?;
        first.close().await?;
        let writer = engine.pool(engine.writers()).connect(url).await?;
        let readers = engine.pool(8).connect(url).await?;
        let signals = Signals::new();
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
            readiness: Readiness::default(),
            looked: Looked::default(),
            _neighbours: neighbours,
        };
        migrate::run(&store).await?;
        store.go_on_from_the_last().await?;
        Ok(store)
    }

    /// Lists are in the order of ids: what is made from now on comes behind what is there, though the clock may have gone
    /// back since.
    async fn go_on_from_the_last(&self) -> Result<(), StoreError> {
        for sql in [
            "SELECT MAX(id) AS id FROM jobs",
            "SELECT MAX(id) AS id FROM models",
        ] {
            let row = sqlx::query(sql).fetch_one(&self.readers).await?;
            let last = row.try_get::<Option<&str>, _>("id")?;
            if let Some(Ok(id)) = last.map(Uuid::parse_str) {
                self.clock.go_on_from(id);
            }
        }
        Ok(())
    }
}
