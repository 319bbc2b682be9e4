//! How a worker looks for work: what others have left behind, then what waits.

use std::time::Duration;

use sqlx::any::AnyRow;
use sqlx::{AnyConnection, AssertSqlSafe};

use super::clock::Clock;
use super::error::StoreError;
use super::queue;

const COLUMNS: &str = "id, status, last_seq, attempt, lost, lost_alone, alone, lease_owner, project, spec, model FROM jobs";

/// A look at what there is to do.
pub(super) struct Look<'a> {
    worker: &'a str,
    now: String,
    pattern: String,
    is_taking_over: bool,
}

impl<'a> Look<'a> {
    pub(super) fn of(worker: &'a str, clock: &Clock, is_taking_over: bool) -> Self {
        Self {
            worker,
            now: clock.lease_text(Duration::ZERO),
            pattern: clock.lease_pattern(),
            is_taking_over,
        }
    }

    /// A job that a worker has left behind or was given without hearing of it; otherwise the first in line.
    pub(super) async fn claimable(
        &self,
        connection: &mut AnyConnection,
        locking: &str,
    ) -> Result<Option<AnyRow>, StoreError> {
        let left_behind = format!(
            "SELECT {COLUMNS} WHERE status IN ('running', 'cancelling') AND (lease_owner = $1 OR lease_until IS NULL \
             OR $2 = 1 AND (lease_until < $3 OR lease_until NOT LIKE $4)) ORDER BY id LIMIT 1 {locking}"
        );
        let left_behind = sqlx::query(AssertSqlSafe(left_behind))
            .bind(self.worker)
            .bind(i64::from(self.is_taking_over))
            .bind(&self.now)
            .bind(&self.pattern)
            .fetch_optional(&mut *connection)
            .await?;
        if left_behind.is_some() {
            return Ok(left_behind);
        }
        let in_line = queue::IN_LINE;
        let waiting = format!(
            "SELECT {COLUMNS} WHERE status = 'queued' ORDER BY {in_line} LIMIT 1 {locking}"
        );
        Ok(sqlx::query(AssertSqlSafe(waiting))
            .fetch_optional(connection)
            .await?)
    }
}
