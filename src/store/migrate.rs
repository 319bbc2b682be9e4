//! The schema, as numbered steps that are run once and recorded.

use sqlx::{AssertSqlSafe, Row};

use super::database::Store;
use super::error::StoreError;
use super::search;

/// In order, from version 1. A step that was released is never edited: a change is a further step.
const STEPS: &[&str] = &[
    include_str!("migrations/0001_first.sql"),
    include_str!("migrations/0002_many_machines.sql"),
    include_str!("migrations/0003_answers.sql"),
    include_str!("migrations/0004_projects.sql"),
    include_str!("migrations/0005_tallies.sql"),
    include_str!("migrations/0006_webhooks.sql"),
    include_str!("migrations/0007_mappings.sql"),
    include_str!("migrations/0008_key_lifetimes.sql"),
    include_str!("migrations/0009_flown.sql"),
    include_str!("migrations/0010_probe.sql"),
    include_str!("migrations/0011_losses.sql"),
    include_str!("migrations/0012_audit.sql"),
    include_str!("migrations/0013_found_by.sql"),
];

/// With this step rows got columns that the program fills in.
const FOUND_BY: i64 = 13;

/// The version that this program brings a database to.
pub(super) fn known() -> i64 {
    i64::try_from(STEPS.len()).unwrap_or(i64::MAX)
}

/// Brings the schema up to date. Processes that start at once do not disturb each other: all steps are looked for and
/// written in one transaction.
pub(super) async fn run(store: &Store) -> Result<(), StoreError> {
    let table = "CREATE TABLE IF NOT EXISTS schema_steps (version BIGINT PRIMARY KEY NOT NULL, applied TEXT NOT NULL)";
    let mut writing = store.begin().await?;
    for preparation in store.engine.before_schema() {
        sqlx::query(*preparation)
            .execute(writing.connection())
            .await?;
    }
    sqlx::query(table).execute(writing.connection()).await?;
    let row = sqlx::query("SELECT MAX(version) AS version FROM schema_steps")
        .fetch_one(writing.connection())
        .await?;
    let reached = row.try_get::<Option<i64>, _>("version")?.unwrap_or(0);
    let steps = (1..).zip(STEPS);
    let known = known();
    if reached > known {
        return Err(StoreError::LaterVersion { reached, known });
    }
    for (version, step) in steps.filter(|(version, _)| *version > reached) {
        // safe: put together from this program's own text
        let sql = AssertSqlSafe(store.engine.schema(step));
        sqlx::raw_sql(sql).execute(writing.connection()).await?;
        sqlx::query("INSERT INTO schema_steps (version, applied) VALUES ($1, $2)")
            .bind(version)
            .bind(store.clock().now_text())
            .execute(writing.connection())
            .await?;
        tracing::info!(version, "database schema brought up to date");
    }
    if reached < FOUND_BY {
        search::fill_in(&mut writing).await?;
    }
    writing.commit().await
}

#[cfg(test)]
mod tests {
    use sha2::{Digest, Sha256};

    use super::STEPS;

    /// Of the text of each step, SHA-256, the first 16 digits. A step that is new gets a line more; the others stay: databases
    /// that have run them do not run them again.
    const RELEASED: &[&str] = &[
        "c577c0aabcd1e044",
        "bd68d76200e7fc9c",
        "ed9da9be280221f8",
        "cc7073d15ae21eb1",
        "df1048242c234275",
        "1375de8c5df088e5",
        "286817a4153ddb4a",
        "60f30e3c820afbf3",
        "6afee731f25bbcee",
        "a08af6eb2edbafd4",
        "e56065f2a563439f",
        "f00f98fe3793b0fb",
        "eb23fa20e218823d",
    ];

    #[test]
    fn a_step_that_was_released_is_never_edited() {
        let digests: Vec<String> = (STEPS.iter())
            .map(|step| hex::encode(Sha256::digest(step))[..16].to_string())
            .collect();
        assert_eq!(digests, RELEASED);
    }
}
