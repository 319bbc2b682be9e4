//! Whose turn it is: the higher priority first, and among equals each key in turn, however much one of them has submitted.
//!
//! A job gets its `turn` when it is submitted: one behind the last that its key has in line, and not before the turn that is
//! served now. So the third job of each key is served before the fourth of any, and a key that was idle has saved up nothing
//! (start-time fair queueing with jobs of equal length).

use sqlx::{AnyConnection, Row};
use uuid::Uuid;

use super::{Project, StoreError};

/// How many jobs wait, counted no further than is asked for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Waiting {
    /// Of everybody.
    pub all: usize,
    /// Of this key.
    pub own: usize,
}

impl Project {
    /// # Errors
    /// The database does not answer.
    pub async fn waiting(&self, most: usize) -> Result<Waiting, StoreError> {
        let sql = "SELECT (SELECT COUNT(*) FROM (SELECT id FROM jobs WHERE status = 'queued' LIMIT $1) AS a) AS everybody, \
                   (SELECT COUNT(*) FROM (SELECT id FROM jobs WHERE submitter = $2 AND status = 'queued' LIMIT $1) AS b) AS own";
        let row = sqlx::query(sql)
            .bind(i64::try_from(most).unwrap_or(i64::MAX))
            .bind(&*self.submitter)
            .fetch_one(&self.store.readers)
            .await?;
        let of = |column| {
            Ok::<_, StoreError>(usize::try_from(row.try_get::<i64, _>(column)?).unwrap_or(0))
        };
        Ok(Waiting {
            all: of("everybody")?,
            own: of("own")?,
        })
    }

    /// How many jobs, of everybody, are taken before one that waits; nothing of one that does not.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn ahead(&self, job: Uuid) -> Result<Option<usize>, StoreError> {
        let sql = "SELECT (SELECT COUNT(*) FROM jobs AS other WHERE other.status = 'queued' AND (other.priority > own.priority \
                   OR other.priority = own.priority AND (other.turn < own.turn OR other.turn = own.turn AND other.id < own.id))) AS ahead \
                   FROM jobs AS own WHERE own.id = $1 AND own.project = $2 AND own.status = 'queued'";
        let row = sqlx::query(sql)
            .bind(job.to_string())
            .bind(&*self.name)
            .fetch_optional(&self.store.readers)
            .await?;
        let Some(row) = row else { return Ok(None) };
        let ahead: i64 = row.try_get("ahead")?;
        Ok(usize::try_from(ahead).ok())
    }
}

/// Waiting jobs in their order.
pub(super) const IN_LINE: &str = "priority DESC, turn, id";

/// The turn of a job that is submitted now. Two that are submitted at once may get the same; their ids tell them apart.
pub(super) async fn next_turn(
    connection: &mut AnyConnection,
    submitter: &str,
) -> Result<i64, StoreError> {
    let served = "SELECT COALESCE((SELECT MIN(turn) FROM jobs WHERE status = 'queued'), (SELECT MAX(turn) FROM jobs), 0) AS turn";
    let served: i64 = sqlx::query(served)
        .fetch_one(&mut *connection)
        .await?
        .try_get("turn")?;
    let own = "SELECT MAX(turn) AS turn FROM jobs WHERE submitter = $1 AND status = 'queued'";
    let own: Option<i64> = sqlx::query(own)
        .bind(submitter)
        .fetch_one(connection)
        .await?
        .try_get("turn")?;
    Ok(own.map_or(served, |own| served.max(own + 1)))
}
