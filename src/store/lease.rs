//! How a worker holds a job: claim, heartbeat, and the ways of giving it back.

use std::time::Duration;

use sqlx::{Any, Row, Transaction};
use uuid::Uuid;

use super::jobs::read_id;
use super::log::{Head, append, read_status};
use super::{ResultParts, Signal, Store, StoreError, results};
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
    pub spec: JobSpec,
    pub model: ModelDocument,
    /// The job was asked to stop before this worker got it.
    pub cancelling: bool,
}

const CLAIMABLE: &str = "SELECT id, status, last_seq, attempt, lost, lease_until, spec, model FROM jobs \
     WHERE status = 'queued' OR (status IN ('running', 'cancelling') AND (lease_until IS NULL OR lease_until < $1)) \
     ORDER BY id LIMIT 1";

impl Store {
    /// The oldest job that waits, or that a worker has left behind.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn claim(&self, worker: &str) -> Result<Option<Claim>, StoreError> {
        // an idle worker should not take the write lock each time it looks
        let look = sqlx::query(CLAIMABLE).bind(self.clock.now_text());
        if look.fetch_optional(&self.readers).await?.is_none() {
            return Ok(None);
        }
        loop {
            let now = self.clock.now_text();
            let mut tx = self.begin().await?;
            let row = sqlx::query(CLAIMABLE)
                .bind(&now)
                .fetch_optional(&mut *tx)
                .await?;
            let Some(row) = row else { return Ok(None) };
            let job = read_id(&row, "id")?;
            let status = read_status(row.try_get("status")?)?;
            let mut head = Head {
                status: Some(status),
                last_seq: row.try_get("last_seq")?,
            };
            let was_lost = row.try_get::<Option<&str>, _>("lease_until")?.is_some();
            let lost = row.try_get::<i64, _>("lost")? + i64::from(was_lost);
            let attempt = row.try_get::<i64, _>("attempt")? + 1;

            let readable = read_task(&row);
            let refusal = match &readable {
                _ if lost >= i64::from(MOST_LOST_WORKERS) => Some(given_up(lost)),
                Err(fault) => Some(fault.clone()),
                Ok(_) => None,
            };
            let event = match refusal {
                Some(fault) => EventBody::Failed {
                    faults: vec![fault],
                },
                None => EventBody::Claimed {
                    worker: worker.to_string(),
                    attempt: u32::try_from(attempt).unwrap_or(u32::MAX),
                },
            };
            let claimed = matches!(event, EventBody::Claimed { .. });
            append(&mut tx, job, &mut head, &now, &[event]).await?;
            sqlx::query(
                "UPDATE jobs SET attempt = $2, lost = $3, lease_owner = $4, lease_until = $5 WHERE id = $1",
            )
            .bind(job.to_string())
            .bind(attempt)
            .bind(lost)
            .bind(claimed.then_some(worker))
            .bind(claimed.then(|| self.clock.text_after(LEASE)))
            .execute(&mut *tx)
            .await?;
            tx.commit().await?;
            self.signals.send(Signal::Log(job));
            if let (true, Ok((spec, model))) = (claimed, readable) {
                return Ok(Some(Claim {
                    job,
                    attempt: u32::try_from(attempt).unwrap_or(u32::MAX),
                    worker: worker.to_string(),
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
        let (mut tx, head) = self.begin_as(claim).await?;
        self.extend_lease(&mut tx, claim).await?;
        tx.commit().await?;
        Ok(head.status.unwrap_or(Status::Running))
    }

    /// Appends to the log of a claimed job; as good as a heartbeat.
    ///
    /// # Errors
    /// [`StoreError::LeaseLost`]: the job has another worker or is over. Nothing is written then.
    pub async fn record(&self, claim: &Claim, events: &[EventBody]) -> Result<(), StoreError> {
        let (mut tx, mut head) = self.begin_as(claim).await?;
        append(
            &mut tx,
            claim.job,
            &mut head,
            &self.clock.now_text(),
            events,
        )
        .await?;
        self.extend_lease(&mut tx, claim).await?;
        tx.commit().await?;
        self.signals.send(Signal::Log(claim.job));
        Ok(())
    }

    /// Ends a job: its last event and its result, together.
    ///
    /// # Errors
    /// [`StoreError::LeaseLost`]: the job has another worker or is over. Nothing is written then.
    pub async fn finish(
        &self,
        claim: &Claim,
        ending: EventBody,
        result: Option<&ResultParts>,
    ) -> Result<(), StoreError> {
        debug_assert!(ending.is_last());
        let (mut tx, mut head) = self.begin_as(claim).await?;
        if let Some(result) = result {
            results::insert(&mut tx, claim.job, result).await?;
        }
        append(
            &mut tx,
            claim.job,
            &mut head,
            &self.clock.now_text(),
            &[ending],
        )
        .await?;
        give_up_lease(&mut tx, claim).await?;
        tx.commit().await?;
        self.signals.send(Signal::Log(claim.job));
        Ok(())
    }

    /// Gives an unfinished job back; the next worker starts it anew.
    ///
    /// # Errors
    /// [`StoreError::LeaseLost`]: the job has another worker or is over. Nothing is written then.
    pub async fn release(&self, claim: &Claim, reason: &str) -> Result<(), StoreError> {
        let (mut tx, mut head) = self.begin_as(claim).await?;
        let event = EventBody::Released {
            reason: reason.to_string(),
        };
        append(
            &mut tx,
            claim.job,
            &mut head,
            &self.clock.now_text(),
            &[event],
        )
        .await?;
        give_up_lease(&mut tx, claim).await?;
        tx.commit().await?;
        self.signals.send(Signal::Log(claim.job));
        self.signals.send(Signal::Work);
        Ok(())
    }

    /// A transaction that has made sure that the claim still stands. That its time has run out is
    /// no harm as long as nobody else has taken the job.
    async fn begin_as(
        &self,
        claim: &Claim,
    ) -> Result<(Transaction<'static, Any>, Head), StoreError> {
        let mut tx = self.begin().await?;
        let sql =
            "SELECT status, last_seq FROM jobs WHERE id = $1 AND attempt = $2 AND lease_owner = $3";
        let row = sqlx::query(sql)
            .bind(claim.job.to_string())
            .bind(i64::from(claim.attempt))
            .bind(&claim.worker)
            .fetch_optional(&mut *tx)
            .await?;
        let row = row.ok_or(StoreError::LeaseLost)?;
        let status = read_status(row.try_get("status")?)?;
        if !matches!(status, Status::Running | Status::Cancelling) {
            return Err(StoreError::LeaseLost);
        }
        let last_seq = row.try_get("last_seq")?;
        Ok((
            tx,
            Head {
                status: Some(status),
                last_seq,
            },
        ))
    }

    async fn extend_lease(
        &self,
        tx: &mut Transaction<'static, Any>,
        claim: &Claim,
    ) -> Result<(), StoreError> {
        sqlx::query("UPDATE jobs SET lease_until = $2 WHERE id = $1")
            .bind(claim.job.to_string())
            .bind(self.clock.text_after(LEASE))
            .execute(&mut **tx)
            .await?;
        Ok(())
    }
}

async fn give_up_lease(
    tx: &mut Transaction<'static, Any>,
    claim: &Claim,
) -> Result<(), StoreError> {
    sqlx::query("UPDATE jobs SET lease_owner = NULL, lease_until = NULL WHERE id = $1")
        .bind(claim.job.to_string())
        .execute(&mut **tx)
        .await?;
    Ok(())
}

/// What there is to do. A job that cannot be read any more must not stop those behind it.
fn read_task(row: &sqlx::any::AnyRow) -> Result<(JobSpec, ModelDocument), Fault> {
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
