//! Other processes on the same PostgreSQL: their signals, and the clock that all go by.

use std::sync::Arc;
use std::time::Duration;

use sqlx::postgres::{PgListener, PgPoolOptions};
use sqlx::{AnyPool, Row};
use tokio::time::{MissedTickBehavior, interval, sleep};
use tokio_util::sync::{CancellationToken, DropGuard};

use super::signal::{CHANNEL, Signal, Signals};
use super::{Clock, StoreError};

/// How often the clock is compared with the database's.
const COMPARE: Duration = Duration::from_secs(60);

/// How long to wait before the next try to hear.
const AGAIN: Duration = Duration::from_millis(500);

/// Hears what other processes signal, and keeps the clock with the database's, until all clones of what it returns are dropped.
pub(super) async fn listen(
    url: &str,
    pool: &AnyPool,
    clock: &Clock,
    signals: &Signals,
) -> Result<Arc<DropGuard>, StoreError> {
    compare(pool, clock).await?;
    let heard = PgPoolOptions::new().max_connections(1).connect(url).await?;
    let mut listener = PgListener::connect_with(&heard).await?;
    listener.listen(CHANNEL).await?;
    let end = CancellationToken::new();
    let guard = Arc::new(end.clone().drop_guard());
    let (pool, clock, signals) = (pool.clone(), clock.clone(), signals.clone());
    tokio::spawn(async move {
        let mut beat = interval(COMPARE);
        beat.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            tokio::select! {
                () = end.cancelled() => return,
                heard = listener.try_recv() => match heard {
                    Ok(Some(told)) => signals.send(told.payload().parse().unwrap_or(Signal::Missed)),
                    // the connection was lost, and with it what was sent meanwhile; the next call connects again
                    Ok(None) => signals.send(Signal::Missed),
                    Err(error) => {
                        tracing::warn!(%error, "cannot hear other processes; looking again");
                        signals.send(Signal::Missed);
                        sleep(AGAIN).await;
                    }
                },
                _ = beat.tick() => {
                    if let Err(error) = compare(&pool, &clock).await {
                        tracing::warn!(%error, "cannot compare the clock with the database's");
                    }
                }
            }
        }
    });
    Ok(guard)
}

/// Leases that machines see differently would be no leases.
async fn compare(pool: &AnyPool, clock: &Clock) -> Result<(), StoreError> {
    let sql = "SELECT CAST(EXTRACT(EPOCH FROM clock_timestamp()) * 1000 AS BIGINT) AS now";
    let row = sqlx::query(sql).fetch_one(pool).await?;
    clock.follow(row.try_get("now")?);
    Ok(())
}
