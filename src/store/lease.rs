//! How a worker holds a job: claim, heartbeat, and the ways of giving it back.
//!
//! A queue library (apalis 1.0, which has both engines) was tried for this and not taken: it accepts the end of a job by the
//! worker's name alone, so that a worker which was stopped beyond its lease and claimed the job again could end it twice, with two
//! results (no fence); and it has no way to cancel a job that runs in another process. Checks of our own on its table would
//! mend both, but then only claim and heartbeat would be left of it, which are two statements here.

use std::time::Duration;

use sqlx::any::AnyRow;
use sqlx::{AnyConnection, AssertSqlSafe, Row};
use uuid::Uuid;

use super::log::{Head, read_status};
use super::record::record;
use super::row::read_id;
use super::writing::Writing;
use super::{ResultParts, Signal, Store, StoreError, queue, results};
use crate::job::{EventBody, Fault, JobSpec, Status};
use crate::model::ModelDocument;

/// How long a job stays with a worker that says nothing. Heartbeats come three times as often.
pub const LEASE: Duration = Duration::from_secs(15);

/// A job whose workers vanished this often is given up: it is likelier to be what kills them than not.
pub const MOST_LOST_WORKERS: u32 = 3;

/// The right to write to a job, until another claims it.
#[derive(Clone, PartialEq, Debug)]
pub struct Claim {
    pub job: Uuid,
    /// Counts from 1; a claim with an earlier number is void.
    pub attempt: u32,
    pub worker: String,
    /// Whose job it is.
    pub project: String,
    pub spec: JobSpec,
    pub model: ModelDocument,
    /// The job was asked to stop before this worker got it.
    pub cancelling: bool,
}

const COLUMNS: &str =
    "id, status, last_seq, attempt, lost, lease_owner, project, spec, model FROM jobs";

impl Store {
    /// A job that a worker has left behind, or the first in line. A worker has one job at a time: one that is its own
    /// already is what it was given when the answer was lost.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn claim(&self, worker: &str) -> Result<Option<Claim>, StoreError> {
        // an idle worker should not take a lock each time it looks
        let mut reader = self.readers.acquire().await?;
        let now = self.clock.now_text();
        if claimable(&mut reader, worker, &now, "").await?.is_none() {
            return Ok(None);
        }
        drop(reader);
        let locking = self.engine.locking_the_next();
        loop {
            let now = self.clock.now_text();
            let mut writing = self.begin().await?;
            let row = claimable(writing.connection(), worker, &now, locking).await?;
            let Some(row) = row else { return Ok(None) };
            let job = read_id(&row, "id")?;
            let status = read_status(row.try_get("status")?)?;
            let mut head = Head {
                status: Some(status),
                last_seq: row.try_get("last_seq")?,
            };
            let was_lost = row.try_get::<Option<&str>, _>("lease_owner")?.is_some();
            let lost = row.try_get::<i64, _>("lost")? + i64::from(was_lost);
            let attempts = row.try_get::<i64, _>("attempt")?;

            let readable = read_task(&row);
            let refusal = match &readable {
                _ if lost >= i64::from(MOST_LOST_WORKERS) => Some(given_up(lost)),
                Err(fault) => Some(fault.clone()),
                Ok(_) => None,
            };
            let claimed = refusal.is_none();
            let attempt = attempts + i64::from(claimed);
            let event = match refusal {
                Some(fault) => EventBody::Failed {
                    faults: vec![fault],
                },
                None => EventBody::Claimed {
                    worker: worker.to_string(),
                    attempt: u32::try_from(attempt).unwrap_or(u32::MAX),
                },
            };
            record(writing.connection(), job, &mut head, &now, &[event]).await?;
            sqlx::query(
                "UPDATE jobs SET attempt = $2, lost = $3, written = 0, lease_owner = $4, lease_until = $5 WHERE id = $1",
            )
            .bind(job.to_string())
            .bind(attempt)
            .bind(lost)
            .bind(claimed.then_some(worker))
            .bind(claimed.then(|| self.clock.text_after(LEASE)))
            .execute(writing.connection())
            .await?;
            writing.tell(Signal::Log(job));
            writing.commit().await?;
            if let (true, Ok((spec, model))) = (claimed, readable) {
                return Ok(Some(Claim {
                    job,
                    attempt: u32::try_from(attempt).unwrap_or(u32::MAX),
                    worker: worker.to_string(),
                    project: row.try_get("project")?,
                    spec,
                    model,
                    cancelling: status == Status::Cancelling,
                }));
            }
        }
    }

    /// Says that the worker is alive, and hears whether the job was asked to stop.
    ///
    /// # Errors
    /// [`StoreError::LeaseLost`]: the job has another worker or is over.
    pub async fn heartbeat(&self, claim: &Claim) -> Result<Status, StoreError> {
        let (mut writing, held) = self.begin_as(claim).await?;
        self.keep(&mut writing, claim, held.written).await?;
        writing.commit().await?;
        Ok(held.head.status.unwrap_or(Status::Running))
    }

    /// Appends to the log of a claimed job; as good as a heartbeat. `before` counts the events that this claim has
    /// recorded: those which arrived, though the answer that said so did not, are not written twice.
    ///
    /// # Errors
    /// [`StoreError::LeaseLost`]: the job has another worker or is over. Nothing is written then.
    pub async fn record(
        &self,
        claim: &Claim,
        before: usize,
        events: &[EventBody],
    ) -> Result<(), StoreError> {
        let (mut writing, mut held) = self.begin_as(claim).await?;
        let missing = held.missing(before, events);
        let now = self.clock.now_text();
        record(
            writing.connection(),
            claim.job,
            &mut held.head,
            &now,
            missing,
        )
        .await?;
        let written = held.written.max(before + events.len());
        self.keep(&mut writing, claim, written).await?;
        writing.tell(Signal::Log(claim.job));
        writing.commit().await
    }

    /// Ends a job: what was told last and is not recorded yet (as [`Store::record`] takes it), the last event and the result,
    /// together. Ending it again changes nothing.
    ///
    /// # Errors
    /// [`StoreError::LeaseLost`]: the job has another worker or is over. Nothing is written then.
    pub async fn finish(
        &self,
        claim: &Claim,
        before: usize,
        events: &[EventBody],
        ending: EventBody,
        result: Option<&ResultParts>,
    ) -> Result<(), StoreError> {
        debug_assert!(ending.is_last());
        let (mut writing, mut held) = match self.begin_as(claim).await {
            Err(StoreError::LeaseLost) if self.is_ended(claim, &ending).await? => return Ok(()),
            begun => begun?,
        };
        let mut last = held.missing(before, events).to_vec();
        last.push(ending);
        if let Some(result) = result {
            results::insert(writing.connection(), claim.job, result).await?;
        }
        let now = self.clock.now_text();
        record(writing.connection(), claim.job, &mut held.head, &now, &last).await?;
        give_up_lease(&mut writing, claim).await?;
        writing.commit().await
    }

    /// Gives an unfinished job back; the next worker starts it anew.
    ///
    /// # Errors
    /// [`StoreError::LeaseLost`]: the job has another worker or is over. Nothing is written then.
    pub async fn release(&self, claim: &Claim, reason: &str) -> Result<(), StoreError> {
        let (mut writing, mut held) = self.begin_as(claim).await?;
        let event = EventBody::Released {
            reason: reason.to_string(),
        };
        let now = self.clock.now_text();
        record(
            writing.connection(),
            claim.job,
            &mut held.head,
            &now,
            &[event],
        )
        .await?;
        give_up_lease(&mut writing, claim).await?;
        writing.tell(Signal::Work);
        writing.commit().await
    }

    /// A transaction that has made sure that the claim still stands. That its time has run out is
    /// no harm as long as nobody else has taken the job.
    async fn begin_as(&self, claim: &Claim) -> Result<(Writing, Held), StoreError> {
        let mut writing = self.begin().await?;
        let sql = format!(
            "SELECT status, last_seq, written FROM jobs WHERE id = $1 AND attempt = $2 AND lease_owner = $3 {}",
            self.engine.locking()
        );
        let row = sqlx::query(AssertSqlSafe(sql))
            .bind(claim.job.to_string())
            .bind(i64::from(claim.attempt))
            .bind(&claim.worker)
            .fetch_optional(writing.connection())
            .await?;
        let row = row.ok_or(StoreError::LeaseLost)?;
        let status = read_status(row.try_get("status")?)?;
        if !matches!(status, Status::Running | Status::Cancelling) {
            return Err(StoreError::LeaseLost);
        }
        let head = Head {
            status: Some(status),
            last_seq: row.try_get("last_seq")?,
        };
        let written = usize::try_from(row.try_get::<i64, _>("written")?).unwrap_or(0);
        Ok((writing, Held { head, written }))
    }

    /// Whether the job has ended so under this very claim: beside who holds the attempt, only [`Store::claim`] can end it,
    /// by giving it up.
    async fn is_ended(&self, claim: &Claim, ending: &EventBody) -> Result<bool, StoreError> {
        let row = sqlx::query("SELECT status FROM jobs WHERE id = $1 AND attempt = $2")
            .bind(claim.job.to_string())
            .bind(i64::from(claim.attempt))
            .fetch_optional(&self.readers)
            .await?;
        match row {
            Some(row) => Ok(read_status(row.try_get("status")?)? == Status::after(None, ending)),
            None => Ok(false),
        }
    }

    async fn keep(
        &self,
        writing: &mut Writing,
        claim: &Claim,
        written: usize,
    ) -> Result<(), StoreError> {
        sqlx::query("UPDATE jobs SET lease_until = $2, written = $3 WHERE id = $1")
            .bind(claim.job.to_string())
            .bind(self.clock.text_after(LEASE))
            .bind(i64::try_from(written).unwrap_or(i64::MAX))
            .execute(writing.connection())
            .await?;
        Ok(())
    }
}

/// A job that a worker has left behind or was given without hearing of it; otherwise the first in line.
async fn claimable(
    connection: &mut AnyConnection,
    worker: &str,
    now: &str,
    locking: &str,
) -> Result<Option<AnyRow>, StoreError> {
    let left_behind = format!(
        "SELECT {COLUMNS} WHERE status IN ('running', 'cancelling') \
         AND (lease_until IS NULL OR lease_until < $1 OR lease_owner = $2) ORDER BY id LIMIT 1 {locking}"
    );
    let left_behind = sqlx::query(AssertSqlSafe(left_behind))
        .bind(now)
        .bind(worker)
        .fetch_optional(&mut *connection)
        .await?;
    if left_behind.is_some() {
        return Ok(left_behind);
    }
    let in_line = queue::IN_LINE;
    let waiting =
        format!("SELECT {COLUMNS} WHERE status = 'queued' ORDER BY {in_line} LIMIT 1 {locking}");
    Ok(sqlx::query(AssertSqlSafe(waiting))
        .fetch_optional(connection)
        .await?)
}

/// What a claim that stands finds.
struct Held {
    head: Head,
    /// Events that this claim has recorded.
    written: usize,
}

impl Held {
    /// Of events that follow the first `before` of the claim, those that have not arrived.
    fn missing<'a>(&self, before: usize, events: &'a [EventBody]) -> &'a [EventBody] {
        let arrived = self.written.saturating_sub(before).min(events.len());
        &events[arrived..]
    }
}

/// The log has grown by its last event for now.
async fn give_up_lease(writing: &mut Writing, claim: &Claim) -> Result<(), StoreError> {
    sqlx::query("UPDATE jobs SET lease_owner = NULL, lease_until = NULL WHERE id = $1")
        .bind(claim.job.to_string())
        .execute(writing.connection())
        .await?;
    writing.tell(Signal::Log(claim.job));
    Ok(())
}

/// What there is to do. A job that cannot be read any more must not stop those behind it.
fn read_task(row: &AnyRow) -> Result<(JobSpec, ModelDocument), Fault> {
    let unreadable = |why: String| {
        Fault::new(
            "",
            "unreadable_job",
            format!("the kept job cannot be read: {why}; submit it again"),
        )
    };
    let text = |column| {
        row.try_get::<&str, _>(column)
            .map_err(|error| unreadable(error.to_string()))
    };
    let spec =
        serde_json::from_str(text("spec")?).map_err(|error| unreadable(error.to_string()))?;
    let model =
        serde_json::from_str(text("model")?).map_err(|error| unreadable(error.to_string()))?;
    Ok((spec, model))
}

fn given_up(lost: i64) -> Fault {
    let message = format!(
        "{lost} workers vanished while they ran this job, most likely for want of memory; try it with fewer samples, outputs or parameters"
    );
    Fault::new("", "workers_lost", message)
}
