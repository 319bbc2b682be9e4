//! What happens to a job is recorded: in its log, in the tallies, and in what those are owed who want to know of its end.

use sqlx::{AnyConnection, Row};
use uuid::Uuid;

use super::clock::Clock;
use super::error::StoreError;
use super::log::{Head, append};
use super::{tallies, webhooks};
use crate::job::EventBody;

/// Appends events to the log of a job, with all that follows from them.
pub(super) async fn record(
    connection: &mut AnyConnection,
    job: Uuid,
    head: &mut Head,
    now: &str,
    events: &[EventBody],
) -> Result<(), StoreError> {
    append(connection, job, head, now, events).await?;
    for event in events {
        note(connection, &job.to_string(), event, now).await?;
    }
    Ok(())
}

/// What follows from the first claim of a job, and from its end: they are counted, and who wants to know is owed it.
async fn note(
    connection: &mut AnyConnection,
    job: &str,
    event: &EventBody,
    now: &str,
) -> Result<(), StoreError> {
    let how = match event {
        EventBody::Claimed { attempt: 1, .. } => None,
        EventBody::Failed { faults } => Some(faults.first().map_or("failed", |fault| &fault.code)),
        event if event.is_last() => Some(event.name()),
        _ => return Ok(()),
    };
    let row = sqlx::query("SELECT project, created, started FROM jobs WHERE id = $1")
        .bind(job)
        .fetch_one(&mut *connection)
        .await?;
    let since = |moment: &str| Clock::seconds_between(moment, now).unwrap_or(0.0).max(0.0);
    match how {
        None => tallies::count_wait(connection, since(row.try_get("created")?)).await,
        Some(how) => {
            let started: Option<&str> = row.try_get("started")?;
            tallies::count_end(connection, how, started.map(since)).await?;
            let project = row.try_get("project")?;
            webhooks::owe(connection, project, job, event.name(), now).await
        }
    }
}
