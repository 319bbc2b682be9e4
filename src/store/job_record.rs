//! A job as the store keeps it, and how a row of the database is read.

use sqlx::Row;
use sqlx::any::AnyRow;
use uuid::Uuid;

use super::StoreError;
use super::about::About;
use super::log::read_status;
use super::row::read_id;
use crate::estimate::FitSummary;
use crate::job::{EventBody, Status};

/// A job without its spec, log and result.
#[derive(Clone, PartialEq, Debug)]
pub struct JobRecord {
    pub id: Uuid,
    pub kind: String,
    pub name: String,
    pub tags: Vec<String>,
    pub priority: i32,
    pub status: Status,
    pub created: String,
    pub started: Option<String>,
    pub finished: Option<String>,
    pub attempt: u32,
    /// The number of the last event.
    pub last_seq: u64,
    /// The last event of a job that is over.
    pub ending: Option<EventBody>,
    /// Its model and maneuvers.
    pub about: About,
    /// Where there is an estimate.
    pub fit: Option<FitSummary>,
}

impl JobRecord {
    /// What it is called: its name, or else its model and maneuvers.
    pub fn title(&self) -> String {
        if self.name.is_empty() {
            self.about.title()
        } else {
            self.name.clone()
        }
    }
}

/// What [`read_job`] reads, of jobs `j` with their last events.
pub(super) const COLUMNS: &str = "j.id, j.kind, j.name, j.tags, j.priority, j.status, j.created, j.started, j.finished, j.attempt, j.last_seq, j.about, j.fit, e.body AS ending \
     FROM jobs j LEFT JOIN events e ON e.job = j.id AND e.seq = j.last_seq";

pub(super) fn read_job(row: &AnyRow) -> Result<JobRecord, StoreError> {
    let id = read_id(row, "id")?;
    let corrupt = |error| StoreError::corrupt(format!("job {id}"), error);
    let status = read_status(row.try_get("status")?)?;
    let ending = match row.try_get::<Option<String>, _>("ending")? {
        Some(body) if status.is_over() => Some(serde_json::from_str(&body).map_err(corrupt)?),
        _ => None,
    };
    // an earlier version that shares the database writes neither
    let about: Option<&str> = row.try_get("about")?;
    let fit: Option<&str> = row.try_get("fit")?;
    Ok(JobRecord {
        id,
        kind: row.try_get("kind")?,
        name: row.try_get("name")?,
        tags: serde_json::from_str(row.try_get("tags")?).map_err(corrupt)?,
        priority: i32::try_from(row.try_get::<i64, _>("priority")?).unwrap_or(0),
        status,
        created: row.try_get("created")?,
        started: row.try_get("started")?,
        finished: row.try_get("finished")?,
        attempt: u32::try_from(row.try_get::<i64, _>("attempt")?).unwrap_or(u32::MAX),
        last_seq: u64::try_from(row.try_get::<i64, _>("last_seq")?).unwrap_or(0),
        ending,
        about: match about {
            Some(about) => serde_json::from_str(about).map_err(corrupt)?,
            None => About::default(),
        },
        fit: fit.map(serde_json::from_str).transpose().map_err(corrupt)?,
    })
}
