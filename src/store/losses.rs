//! Workers that a job has lost, and what that says of the job.
//!
//! A worker is lost when its lease runs out without a word. That is no proof against the job: its process may have been killed,
//! or run out of memory by what another job did. So a job that has lost some is run alone in its process, and is given up
//! only when workers are lost that ran nothing else. What does not count: that a process takes its own job anew (its database
//! was away, and the process was not), and a worker that comes back.

use sqlx::Row;
use sqlx::any::AnyRow;

use super::error::StoreError;
use crate::job::Fault;

/// A job that has lost so many workers which ran others as well is run alone.
pub const SUSPECTED_AFTER: u32 = 2;

/// A job that has lost so many workers which ran nothing else is given up.
pub const GIVEN_UP_AFTER: u32 = 2;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Losses {
    /// Workers that ran other jobs beside it, or may have.
    pub(super) beside: i64,
    /// Workers whose process ran nothing else.
    pub(super) alone: i64,
    /// The attempt whose worker counts as lost by the latest claim, below zero if it ran alone; 0: none does.
    pub(super) counted: i64,
}

impl Losses {
    /// What a job has lost once `worker` claims it.
    pub(super) fn found_by(worker: &str, row: &AnyRow) -> Result<Self, StoreError> {
        let losses = Self {
            beside: row.try_get("lost")?,
            alone: row.try_get("lost_alone")?,
            counted: 0,
        };
        let is_lost = row
            .try_get::<Option<&str>, _>("lease_owner")?
            .is_some_and(|owner| process_of(owner) != process_of(worker));
        if !is_lost {
            return Ok(losses);
        }
        let attempt: i64 = row.try_get("attempt")?;
        Ok(if row.try_get::<i64, _>("alone")? == 0 {
            Self {
                beside: losses.beside + 1,
                counted: attempt,
                ..losses
            }
        } else {
            Self {
                alone: losses.alone + 1,
                counted: -attempt,
                ..losses
            }
        })
    }

    pub(super) fn is_suspect(self) -> bool {
        self.beside >= i64::from(SUSPECTED_AFTER) || self.alone > 0
    }

    /// Why the job is given up, if it is.
    pub(super) fn verdict(self) -> Option<Fault> {
        let Self { beside, alone, .. } = self;
        if alone < i64::from(GIVEN_UP_AFTER) {
            return None;
        }
        let all = beside + alone;
        let message = format!(
            "{all} workers were lost while they ran this job, {alone} of them while their process ran nothing else; what ended them was not seen here: the logs of their machines may tell (of memory, above all). Submit it again when that is found, or with fewer samples, outputs or parameters"
        );
        Some(Fault::new("", "workers_lost", message))
    }
}

/// Workers are named by their process and their number in it.
fn process_of(worker: &str) -> &str {
    worker.split('/').next().unwrap_or(worker)
}
