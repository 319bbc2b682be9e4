//! Messages to webhooks on their way: taken by one process at a time, and settled.

use std::time::Duration;

use sqlx::{AssertSqlSafe, Row};
use uuid::Uuid;

use super::log::findings_of;
use super::row::read_id;
use super::{Store, StoreError};
use crate::flight::FindingTally;

/// How long a delivery stays with the process that took it.
const IN_HAND: Duration = Duration::from_secs(60);

/// A message that is due, in the hands of who took it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Delivery {
    pub id: Uuid,
    pub webhook: Uuid,
    pub url: String,
    /// All that sign it: after a rotation the former one does, too, for a while.
    pub secrets: Vec<String>,
    pub event: String,
    pub job: String,
    /// What the job's result carries.
    pub findings: FindingTally,
    /// When the job ended.
    pub created: String,
    /// This one included.
    pub attempts: u32,
}

/// What an attempt came to.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Attempt {
    Arrived(u16),
    /// To be tried again after so long, or not at all.
    Failed {
        status: Option<u16>,
        fault: String,
        again: Option<Duration>,
    },
    /// The receiver is gone for good: it is told nothing more.
    Gone(u16),
}

impl Store {
    /// Takes a message that is due.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn take_delivery(&self) -> Result<Option<Delivery>, StoreError> {
        let now = self.clock.now_text();
        let due = "SELECT id FROM deliveries WHERE next <= $1 ORDER BY next LIMIT 1";
        // an idle process should not take a lock each time it looks
        let seen = sqlx::query(due)
            .bind(&now)
            .fetch_optional(&self.readers)
            .await?;
        if seen.is_none() {
            return Ok(None);
        }
        let mut writing = self.begin().await?;
        let sql = format!("{due} {}", self.engine.locking_the_next());
        let row = sqlx::query(AssertSqlSafe(sql))
            .bind(&now)
            .fetch_optional(writing.connection())
            .await?;
        let Some(row) = row else { return Ok(None) };
        let id = read_id(&row, "id")?;
        sqlx::query("UPDATE deliveries SET attempts = attempts + 1, next = $2 WHERE id = $1")
            .bind(id.to_string())
            .bind(self.clock.text_after(IN_HAND))
            .execute(writing.connection())
            .await?;
        let sql = "SELECT w.id, w.url, w.secret, w.previous_secret, w.previous_until, d.type, d.job, d.created, d.attempts \
                   FROM deliveries d JOIN webhooks w ON w.id = d.webhook WHERE d.id = $1";
        let row = sqlx::query(sql)
            .bind(id.to_string())
            .fetch_one(writing.connection())
            .await?;
        let job: String = row.try_get("job")?;
        let findings = findings_of(writing.connection(), &job).await?;
        writing.commit().await?;
        let mut secrets = vec![row.try_get("secret")?];
        let until: Option<String> = row.try_get("previous_until")?;
        if until.is_some_and(|until| until > now) {
            secrets.extend(row.try_get::<Option<String>, _>("previous_secret")?);
        }
        Ok(Some(Delivery {
            id,
            webhook: read_id(&row, "id")?,
            url: row.try_get("url")?,
            secrets,
            event: row.try_get("type")?,
            job,
            findings,
            created: row.try_get("created")?,
            attempts: u32::try_from(row.try_get::<i64, _>("attempts")?).unwrap_or(u32::MAX),
        }))
    }

    /// Writes what an attempt came to.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn settle_delivery(
        &self,
        delivery: &Delivery,
        attempt: &Attempt,
    ) -> Result<(), StoreError> {
        let now = self.clock.now_text();
        let (status, fault, next, done) = match attempt {
            Attempt::Arrived(status) => (Some(*status), None, None, Some(&now)),
            Attempt::Gone(status) => (Some(*status), Some("the receiver is gone"), None, None),
            Attempt::Failed {
                status,
                fault,
                again,
            } => {
                let next = again.map(|again| self.clock.text_after(again));
                (*status, Some(fault.as_str()), next, None)
            }
        };
        let mut writing = self.begin().await?;
        sqlx::query(
            "UPDATE deliveries SET status = $2, fault = $3, next = $4, done = $5 WHERE id = $1",
        )
        .bind(delivery.id.to_string())
        .bind(status.map(i64::from))
        .bind(fault)
        .bind(next)
        .bind(done)
        .execute(writing.connection())
        .await?;
        if let Attempt::Gone(_) = attempt {
            for sql in [
                "UPDATE webhooks SET disabled = $2 WHERE id = $1",
                "UPDATE deliveries SET next = NULL, fault = 'the receiver is gone since ' || $2 WHERE webhook = $1 AND next IS NOT NULL",
            ] {
                sqlx::query(sql)
                    .bind(delivery.webhook.to_string())
                    .bind(&now)
                    .execute(writing.connection())
                    .await?;
            }
        }
        writing.commit().await
    }
}
