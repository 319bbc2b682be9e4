//! Who is told of the end of a job, and what was told.
//!
//! A delivery is written in the transaction of the job's last event: it is owed from then on, whatever dies. It is taken by
//! one process at a time, for as long as sending may take, and is over when the receiver has said so, or has not in all
//! attempts. So a receiver may hear twice of the same end, under the same id, and never not at all.

use std::time::Duration;

use sqlx::any::AnyRow;
use sqlx::{AnyConnection, AssertSqlSafe, Row};
use uuid::Uuid;

use super::log::findings_of;
use super::row::read_id;
use super::{Project, Store, StoreError, clock};
use crate::flight::FindingTally;

/// How long a delivery stays with the process that took it.
const IN_HAND: Duration = Duration::from_secs(60);

/// The type of a message that is sent to try a webhook; those of jobs are `job.` and how they ended.
const TEST: &str = "webhook.test";

#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Webhook {
    pub id: Uuid,
    pub url: String,
    /// The types of messages that it wants.
    pub events: Vec<String>,
    pub created: String,
    pub disabled: Option<String>,
}

/// One message to one receiver.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct DeliveryRecord {
    pub id: Uuid,
    pub event: String,
    pub job: String,
    pub created: String,
    pub attempts: u32,
    /// When it will be tried again; `None`: it is over.
    pub next: Option<String>,
    /// When it arrived.
    pub done: Option<String>,
    pub status: Option<u16>,
    pub fault: Option<String>,
}

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

const COLUMNS: &str = "id, url, events, created, disabled FROM webhooks";

fn read_webhook(row: &AnyRow) -> Result<Webhook, StoreError> {
    let id = read_id(row, "id")?;
    let events = serde_json::from_str(row.try_get("events")?)
        .map_err(|error| StoreError::corrupt(format!("webhook {id}"), error))?;
    Ok(Webhook {
        id,
        url: row.try_get("url")?,
        events,
        created: row.try_get("created")?,
        disabled: row.try_get("disabled")?,
    })
}

fn read_delivery(row: &AnyRow) -> Result<DeliveryRecord, StoreError> {
    Ok(DeliveryRecord {
        id: read_id(row, "id")?,
        event: row.try_get("type")?,
        job: row.try_get("job")?,
        created: row.try_get("created")?,
        attempts: u32::try_from(row.try_get::<i64, _>("attempts")?).unwrap_or(u32::MAX),
        next: row.try_get("next")?,
        done: row.try_get("done")?,
        status: row
            .try_get::<Option<i64>, _>("status")?
            .and_then(|status| u16::try_from(status).ok()),
        fault: row.try_get("fault")?,
    })
}

/// Owes the end of a job to all who want to know of it.
pub(super) async fn owe(
    connection: &mut AnyConnection,
    project: &str,
    job: &str,
    event: &str,
    now: &str,
) -> Result<(), StoreError> {
    let event = format!("job.{event}");
    let sql = format!("SELECT {COLUMNS} WHERE project = $1 AND disabled IS NULL");
    let rows = sqlx::query(AssertSqlSafe(sql))
        .bind(project)
        .fetch_all(&mut *connection)
        .await?;
    for row in rows {
        let webhook = match read_webhook(&row) {
            Ok(webhook) => webhook,
            // its receiver hears nothing, and the job ends all the same
            Err(error) => {
                tracing::error!(%error, "a webhook is not told");
                continue;
            }
        };
        if webhook.events.contains(&event) {
            insert(connection, webhook.id, &event, job, now).await?;
        }
    }
    Ok(())
}

async fn insert(
    connection: &mut AnyConnection,
    webhook: Uuid,
    event: &str,
    job: &str,
    now: &str,
) -> Result<(), StoreError> {
    let sql = "INSERT INTO deliveries (id, webhook, type, job, created, next) VALUES ($1, $2, $3, $4, $5, $5)";
    sqlx::query(sql)
        .bind(clock::id_at(now).to_string())
        .bind(webhook.to_string())
        .bind(event)
        .bind(job)
        .bind(now)
        .execute(connection)
        .await?;
    Ok(())
}

impl Project {
    /// Added again under the same id it gets this secret: the first was shown to nobody.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn add_webhook(
        &self,
        id: Uuid,
        url: &str,
        events: &[String],
        secret: &str,
    ) -> Result<Webhook, StoreError> {
        let created = self.store.clock.now_text();
        let sql = "INSERT INTO webhooks (id, project, url, events, secret, created) VALUES ($1, $2, $3, $4, $5, $6) \
                   ON CONFLICT (id) DO UPDATE SET secret = excluded.secret";
        sqlx::query(sql)
            .bind(id.to_string())
            .bind(&*self.name)
            .bind(url)
            .bind(serde_json::Value::from(events.to_vec()).to_string())
            .bind(secret)
            .bind(&created)
            .execute(&self.store.writer)
            .await?;
        Ok(Webhook {
            id,
            url: url.to_string(),
            events: events.to_vec(),
            created,
            disabled: None,
        })
    }

    /// The newest first.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn webhooks(&self) -> Result<Vec<Webhook>, StoreError> {
        let sql = format!("SELECT {COLUMNS} WHERE project = $1 ORDER BY id DESC");
        let rows = sqlx::query(AssertSqlSafe(sql))
            .bind(&*self.name)
            .fetch_all(&self.store.readers)
            .await?;
        rows.iter().map(read_webhook).collect()
    }

    /// # Errors
    /// The database does not answer.
    pub async fn webhook(&self, id: Uuid) -> Result<Option<Webhook>, StoreError> {
        let sql = format!("SELECT {COLUMNS} WHERE project = $1 AND id = $2");
        let row = sqlx::query(AssertSqlSafe(sql))
            .bind(&*self.name)
            .bind(id.to_string())
            .fetch_optional(&self.store.readers)
            .await?;
        row.as_ref().map(read_webhook).transpose()
    }

    /// Forgets a webhook and what it is owed. Whether there was one.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn delete_webhook(&self, id: Uuid) -> Result<bool, StoreError> {
        if self.webhook(id).await?.is_none() {
            return Ok(false);
        }
        let mut writing = self.store.begin().await?;
        for sql in [
            "DELETE FROM deliveries WHERE webhook = $1",
            "DELETE FROM webhooks WHERE id = $1",
        ] {
            sqlx::query(sql)
                .bind(id.to_string())
                .execute(writing.connection())
                .await?;
        }
        writing.commit().await?;
        Ok(true)
    }

    /// Signs with `secret` from now on, and with the former one as well for the time of `overlap`. Whether there is such a
    /// webhook. One that was disabled is told again.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn rotate_webhook(
        &self,
        id: Uuid,
        secret: &str,
        overlap: Duration,
    ) -> Result<bool, StoreError> {
        let sql = "UPDATE webhooks SET previous_secret = secret, previous_until = $4, secret = $3, disabled = NULL \
                   WHERE project = $1 AND id = $2";
        let changed = sqlx::query(sql)
            .bind(&*self.name)
            .bind(id.to_string())
            .bind(secret)
            .bind(self.store.clock.text_after(overlap))
            .execute(&self.store.writer)
            .await?;
        Ok(changed.rows_affected() > 0)
    }

    /// Owes a message that only tries the webhook.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn try_webhook(&self, id: Uuid) -> Result<(), StoreError> {
        let mut writing = self.store.begin().await?;
        let now = self.store.clock.now_text();
        insert(writing.connection(), id, TEST, "", &now).await?;
        writing.commit().await
    }

    /// What was sent last, the newest first.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn deliveries(
        &self,
        webhook: Uuid,
        limit: usize,
    ) -> Result<Vec<DeliveryRecord>, StoreError> {
        let sql = "SELECT id, type, job, created, attempts, next, done, status, fault FROM deliveries \
                   WHERE webhook = (SELECT id FROM webhooks WHERE id = $1 AND project = $2) ORDER BY id DESC LIMIT $3";
        let rows = sqlx::query(sql)
            .bind(webhook.to_string())
            .bind(&*self.name)
            .bind(i64::try_from(limit).unwrap_or(i64::MAX))
            .fetch_all(&self.store.readers)
            .await?;
        rows.iter().map(read_delivery).collect()
    }
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
