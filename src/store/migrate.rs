//! The schema, as numbered steps that are run once and recorded.

use sqlx::{AssertSqlSafe, Row};

use super::{Store, StoreError};

struct Step {
    version: i64,
    sql: &'static str,
}

/// In order. A step that was released is never edited: a change is a further step.
const STEPS: &[Step] = &[
    Step {
        version: 1,
        sql: include_str!("migrations/0001_first.sql"),
    },
    Step {
        version: 2,
        sql: include_str!("migrations/0002_many_machines.sql"),
    },
    Step {
        version: 3,
        sql: include_str!("migrations/0003_answers.sql"),
    },
    Step {
        version: 4,
        sql: include_str!("migrations/0004_projects.sql"),
    },
    Step {
        version: 5,
        sql: include_str!("migrations/0005_tallies.sql"),
    },
    Step {
        version: 6,
        sql: include_str!("migrations/0006_webhooks.sql"),
    },
    Step {
        version: 7,
        sql: include_str!("migrations/0007_mappings.sql"),
    },
];

/// Brings the schema up to date. Processes that start at once do not disturb each other: all steps are looked for and
/// written in one transaction.
pub(super) async fn run(store: &Store) -> Result<(), StoreError> {
    let table = "CREATE TABLE IF NOT EXISTS schema_steps (version BIGINT PRIMARY KEY NOT NULL, applied TEXT NOT NULL)";
    let mut writing = store.begin().await?;
    if let Some(lock) = store.engine.lock_of_schema() {
        sqlx::query(lock).execute(writing.connection()).await?;
    }
    sqlx::query(table).execute(writing.connection()).await?;
    let row = sqlx::query("SELECT MAX(version) AS version FROM schema_steps")
        .fetch_one(writing.connection())
        .await?;
    let reached = row.try_get::<Option<i64>, _>("version")?.unwrap_or(0);
    let known = STEPS.last().map_or(0, |step| step.version);
    if reached > known {
        return Err(StoreError::LaterVersion { reached, known });
    }
    for step in STEPS.iter().filter(|step| step.version > reached) {
        // safe: put together from this program's own text
        let sql = AssertSqlSafe(store.engine.schema(step.sql));
        sqlx::raw_sql(sql).execute(writing.connection()).await?;
        sqlx::query("INSERT INTO schema_steps (version, applied) VALUES ($1, $2)")
            .bind(step.version)
            .bind(store.clock().now_text())
            .execute(writing.connection())
            .await?;
        tracing::info!(version = step.version, "database schema brought up to date");
    }
    writing.commit().await
}
