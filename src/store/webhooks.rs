//! Who is told of the end of a job, and what was told.
//!
//! A delivery is written in the transaction of the job's last event: it is owed from then on, whatever dies. It is taken by
//! one process at a time, for as long as sending may take, and is over when the receiver has said so, or has not in all
//! attempts. So a receiver may hear twice of the same end, under the same id, and never not at all.

use std::time::Duration;

use sqlx::any::AnyRow;
use sqlx::{AnyConnection, AssertSqlSafe, Row};
use uuid::Uuid;

use super::audit::Deed;
use super::page::readable;
use super::row::read_id;
use super::{Project, StoreError, clock};

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
        let mut writing = self.store.begin().await?;
        sqlx::query(sql)
            .bind(id.to_string())
            .bind(&*self.name)
            .bind(url)
            .bind(serde_json::Value::from(events.to_vec()).to_string())
            .bind(secret)
            .bind(&created)
            .execute(writing.connection())
            .await?;
        self.note(&mut writing, Deed::WebhookAdded, &id.to_string())
            .await?;
        writing.commit().await?;
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
        Ok(readable(&rows, read_webhook))
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
        self.note(&mut writing, Deed::WebhookDeleted, &id.to_string())
            .await?;
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
        let mut writing = self.store.begin().await?;
        let changed = sqlx::query(sql)
            .bind(&*self.name)
            .bind(id.to_string())
            .bind(secret)
            .bind(self.store.clock.text_after(overlap))
            .execute(writing.connection())
            .await?;
        if changed.rows_affected() == 0 {
            return Ok(false);
        }
        self.note(&mut writing, Deed::WebhookRotated, &id.to_string())
            .await?;
        writing.commit().await?;
        Ok(true)
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
        Ok(readable(&rows, read_delivery))
    }
}
