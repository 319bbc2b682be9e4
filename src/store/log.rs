//! The log of a job: appending to it, and reading on from where one stopped.

use sqlx::{AnyConnection, Row};
use uuid::Uuid;

use super::page::one_more;
use super::{Page, Project, StoreError};
use crate::flight::FindingTally;
use crate::job::{EventBody, Status};

/// An event as it is kept. The body stays JSON: most readers hand it on as it is.
#[derive(Clone, PartialEq, Debug)]
pub struct StoredEvent {
    pub seq: u64,
    /// RFC 3339 UTC.
    pub at: String,
    /// [`EventBody::name`].
    pub name: String,
    /// JSON of the [`EventBody`].
    pub body: String,
}

impl StoredEvent {
    /// JSON of the [`crate::job::Event`] that this is.
    pub fn to_json(&self) -> String {
        let Self { seq, at, body, .. } = self;
        // an event body is an object with at least its type in it
        let fields = body.strip_prefix('{').unwrap_or("}");
        format!(r#"{{"seq":{seq},"at":"{at}",{fields}"#)
    }

    /// Whether nothing follows.
    pub fn is_last(&self) -> bool {
        matches!(self.name.as_str(), "succeeded" | "failed" | "cancelled")
    }
}

/// The end of a job's log, as read in the transaction that appends to it.
pub(super) struct Head {
    pub(super) status: Option<Status>,
    pub(super) last_seq: i64,
}

/// Appends events and brings status and times of the job along with them.
pub(super) async fn append(
    connection: &mut AnyConnection,
    job: Uuid,
    head: &mut Head,
    now: &str,
    events: &[EventBody],
) -> Result<(), StoreError> {
    let job = job.to_string();
    let now = &not_before_the_last(connection, &job, head.last_seq, now).await?;
    let (mut started, mut finished) = (None, None);
    for event in events {
        head.last_seq += 1;
        let status = Status::after(head.status, event);
        head.status = Some(status);
        match event {
            EventBody::Claimed { .. } => started = Some(now.as_str()),
            _ if status.is_over() => finished = Some(now.as_str()),
            _ => {}
        }
        let body = serde_json::to_string(event).map_err(|error| StoreError::Unwritable {
            what: format!("event '{}'", event.name()),
            why: error.to_string(),
        })?;
        sqlx::query("INSERT INTO events (job, seq, at, type, body) VALUES ($1, $2, $3, $4, $5)")
            .bind(&job)
            .bind(head.last_seq)
            .bind(now)
            .bind(event.name())
            .bind(body)
            .execute(&mut *connection)
            .await?;
    }
    let Some(status) = head.status else {
        return Ok(());
    };
    sqlx::query(
        "UPDATE jobs SET status = $2, last_seq = $3, started = COALESCE(started, $4), finished = COALESCE(finished, $5) WHERE id = $1",
    )
    .bind(&job)
    .bind(status.name())
    .bind(head.last_seq)
    .bind(started)
    .bind(finished)
    .execute(&mut *connection)
    .await?;
    Ok(())
}

/// `now`, or the time of the last event, if that is later: the clock has gone back since.
async fn not_before_the_last(
    connection: &mut AnyConnection,
    job: &str,
    last_seq: i64,
    now: &str,
) -> Result<String, StoreError> {
    let row = sqlx::query("SELECT at FROM events WHERE job = $1 AND seq = $2")
        .bind(job)
        .bind(last_seq)
        .fetch_optional(connection)
        .await?;
    let last = row.map(|row| row.try_get::<String, _>("at")).transpose()?;
    Ok(last
        .filter(|last| **last > *now)
        .unwrap_or_else(|| now.to_string()))
}

pub(super) fn read_status(text: &str) -> Result<Status, StoreError> {
    serde_json::from_value(serde_json::Value::from(text))
        .map_err(|error| StoreError::corrupt("the status of a job", error))
}

/// What the last event of a job says of its findings; nothing of a message that is about no job.
pub(super) async fn findings_of(
    connection: &mut AnyConnection,
    job: &str,
) -> Result<FindingTally, StoreError> {
    let sql = "SELECT body FROM events WHERE job = $1 ORDER BY seq DESC LIMIT 1";
    let row = sqlx::query(sql)
        .bind(job)
        .fetch_optional(connection)
        .await?;
    let body: Option<String> = row.map(|row| row.try_get("body")).transpose()?;
    let ending = body.and_then(|body| serde_json::from_str(&body).ok());
    Ok(match ending {
        Some(EventBody::Succeeded { findings, .. } | EventBody::Cancelled { findings, .. }) => {
            findings
        }
        _ => FindingTally::default(),
    })
}

fn read_event(row: &sqlx::any::AnyRow) -> Result<StoredEvent, StoreError> {
    Ok(StoredEvent {
        seq: u64::try_from(row.try_get::<i64, _>("seq")?).unwrap_or(0),
        at: row.try_get("at")?,
        name: row.try_get("type")?,
        body: row.try_get("body")?,
    })
}

impl Project {
    /// Events behind number `after`, in order, at most `limit`. A job that does not exist has none.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn events(
        &self,
        job: Uuid,
        after: u64,
        limit: usize,
    ) -> Result<Page<StoredEvent>, StoreError> {
        let sql = "SELECT seq, at, type, body FROM events \
                   WHERE job = (SELECT id FROM jobs WHERE id = $1 AND project = $2) AND seq > $3 ORDER BY seq LIMIT $4";
        let rows = sqlx::query(sql)
            .bind(job.to_string())
            .bind(&*self.name)
            .bind(i64::try_from(after).unwrap_or(i64::MAX))
            .bind(one_more(limit))
            .fetch_all(&self.store.readers)
            .await?;
        let events = rows.iter().map(read_event).collect::<Result<_, _>>()?;
        Ok(Page::new(events, limit, |event| event.seq.to_string()))
    }

    /// The iterations of the latest attempt, in order: those behind the last claim.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn iterations(&self, job: Uuid) -> Result<Vec<StoredEvent>, StoreError> {
        let sql = "SELECT seq, at, type, body FROM events \
                   WHERE job = (SELECT id FROM jobs WHERE id = $1 AND project = $2) AND type = 'iteration' \
                   AND seq > (SELECT MAX(seq) FROM events WHERE job = $1 AND type = 'claimed') ORDER BY seq";
        let rows = sqlx::query(sql)
            .bind(job.to_string())
            .bind(&*self.name)
            .fetch_all(&self.store.readers)
            .await?;
        rows.iter().map(read_event).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::Event;

    #[test]
    fn an_event_is_put_together_as_its_type_would_be() {
        let body = EventBody::Claimed {
            worker: "w".into(),
            attempt: 2,
        };
        let stored = StoredEvent {
            seq: 2,
            at: "2026-11-21T12:00:00.123Z".into(),
            name: body.name().into(),
            body: serde_json::to_string(&body).unwrap(),
        };
        let event = Event {
            seq: 2,
            at: stored.at.clone(),
            body,
        };
        assert_eq!(stored.to_json(), serde_json::to_string(&event).unwrap());
        assert_eq!(
            serde_json::from_str::<Event>(&stored.to_json()).unwrap(),
            event
        );
    }
}
