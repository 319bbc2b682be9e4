//! How a worker holds a job: claim, heartbeat, and the ways of giving it back.
//!
//! A queue library (apalis 1.0, which has both engines) was tried for this and not taken: it accepts the end of a job by the
//! worker's name alone, so that a worker which was stopped beyond its lease and claimed the job again could end it twice, with two
//! results (no fence); and it has no way to cancel a job that runs in another process. Checks of our own on its table would
//! mend both, but then only claim and heartbeat would be left of it, which are two statements here.

use std::time::{Duration, Instant};

use sqlx::any::AnyRow;
use sqlx::{AssertSqlSafe, Row};
use uuid::Uuid;

use super::log::{Head, read_status};
use super::look::Look;
use super::losses::Losses;
use super::record::record;
use super::row::read_id;
use super::writing::Writing;
use super::{ResultParts, Signal, Store, StoreError, results};
use crate::job::{EventBody, Fault, JobSpec, Status};
use crate::model::ModelDocument;

/// How long a job stays with a worker that says nothing. Heartbeats come three times as often.
pub const LEASE: Duration = Duration::from_secs(15);

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
    /// Workers were lost with it: it is to run alone ([`Store::run_alone`]).
    pub is_suspect: bool,
}

impl Store {
    /// A job that a worker has left behind, or the first in line. A worker has one job at a time: one that is its own
    /// already is what it was given when the answer was lost.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn claim(&self, worker: &str) -> Result<Option<Claim>, StoreError> {
        // an idle worker should not take a lock each time it looks
        let mut reader = self.readers.acquire().await?;
        let is_taking_over = self.looked.tells(Instant::now());
        let look = Look::of(worker, &self.clock, is_taking_over);
        if look.claimable(&mut reader, "").await?.is_none() {
            return Ok(None);
        }
        drop(reader);
        let locking = self.engine.locking_the_next();
        loop {
            let now = self.clock.now_text();
            let mut writing = self.begin().await?;
            let look = Look::of(worker, &self.clock, is_taking_over);
            let row = look.claimable(writing.connection(), locking).await?;
            let Some(row) = row else { return Ok(None) };
            let job = read_id(&row, "id")?;
            let status = read_status(row.try_get("status")?)?;
            let mut head = Head {
                status: Some(status),
                last_seq: row.try_get("last_seq")?,
            };
            let losses = Losses::found_by(worker, &row)?;
            let attempts = row.try_get::<i64, _>("attempt")?;

            let readable = read_task(&row);
            let unreadable = readable.as_ref().err().cloned();
            let refusal = losses.verdict().or(unreadable);
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
                "UPDATE jobs SET attempt = $2, lost = $3, lost_alone = $4, counted = $5, alone = 0, written = 0, \
                 lease_owner = $6, lease_until = $7 WHERE id = $1",
            )
            .bind(job.to_string())
            .bind(attempt)
            .bind(losses.beside)
            .bind(losses.alone)
            .bind(losses.counted)
            .bind(claimed.then_some(worker))
            .bind(claimed.then(|| self.clock.lease_text(LEASE)))
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
                    is_suspect: losses.is_suspect(),
                }));
            }
        }
    }

    /// Says that nothing runs beside the job from now on: if its worker is lost, it is the job's doing, most likely.
    ///
    /// # Errors
    /// [`StoreError::LeaseLost`]: the job has another worker or is over.
    pub async fn run_alone(&self, claim: &Claim) -> Result<(), StoreError> {
        let (mut writing, _) = self.begin_as(claim).await?;
        sqlx::query("UPDATE jobs SET alone = 1 WHERE id = $1")
            .bind(claim.job.to_string())
            .execute(writing.connection())
            .await?;
        writing.commit().await
    }

    /// Takes back that the worker was lost: it was only away, and its job has another by now.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn was_not_lost(&self, claim: &Claim) -> Result<(), StoreError> {
        let attempt = i64::from(claim.attempt);
        for (sql, counted) in [
            (
                "UPDATE jobs SET lost = lost - 1, counted = 0 WHERE id = $1 AND counted = $2",
                attempt,
            ),
            (
                "UPDATE jobs SET lost_alone = lost_alone - 1, counted = 0 WHERE id = $1 AND counted = $2",
                -attempt,
            ),
        ] {
            sqlx::query(sql)
                .bind(claim.job.to_string())
                .bind(counted)
                .execute(&self.writer)
                .await?;
        }
        Ok(())
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
            .bind(self.clock.lease_text(LEASE))
            .bind(i64::try_from(written).unwrap_or(i64::MAX))
            .execute(writing.connection())
            .await?;
        Ok(())
    }
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
