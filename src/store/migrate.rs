//! The schema, as numbered steps that are run once and recorded.

use sqlx::Row;

use super::{Store, StoreError};

struct Step {
    version: i64,
    sql: &'static str,
}

/// In order. A step that was released is never edited: a change is a further step.
const STEPS: &[Step] = &[Step {
    version: 1,
    sql: include_str!("migrations/sqlite/0001_first.sql"),
}];

/// Brings the schema up to date. Two processes that start at once do not disturb each other: each
/// step looks and writes in one transaction.
pub(super) async fn run(store: &Store) -> Result<(), StoreError> {
    let table = "CREATE TABLE IF NOT EXISTS schema_steps (version BIGINT PRIMARY KEY NOT NULL, applied TEXT NOT NULL)";
    let mut tx = store.begin().await?;
    sqlx::query(table).execute(&mut *tx).await?;
    let row = sqlx::query("SELECT MAX(version) AS version FROM schema_steps")
        .fetch_one(&mut *tx)
        .await?;
    let reached = row.try_get::<Option<i64>, _>("version")?.unwrap_or(0);
    let known = STEPS.last().map_or(0, |step| step.version);
    if reached > known {
        return Err(StoreError::LaterVersion { reached, known });
    }
    for step in STEPS.iter().filter(|step| step.version > reached) {
        sqlx::raw_sql(step.sql).execute(&mut *tx).await?;
        sqlx::query("INSERT INTO schema_steps (version, applied) VALUES ($1, $2)")
            .bind(step.version)
            .bind(store.clock().now_text())
            .execute(&mut *tx)
            .await?;
        tracing::info!(version = step.version, "database schema brought up to date");
    }
    tx.commit().await?;
    Ok(())
}
