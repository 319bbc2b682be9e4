//! Jobs: accepting, listing, asking to stop. What a worker does to a job is in `lease`.

use sqlx::{AssertSqlSafe, Row};
use uuid::Uuid;

use super::about::About;
use super::job_record::{COLUMNS, JobRecord, read_job};
use super::log::{Head, read_status};
use super::page::one_more;
use super::record::record;
use super::search::{Search, words_of_job};
use super::writing::Writing;
use super::{BadCursor, Page, Project, Signal, StoreError, queue};
use crate::job::{EventBody, JobSpec, Status};

/// What is kept of a job that was checked.
#[derive(Clone, PartialEq, Debug)]
pub struct NewJob {
    pub kind: String,
    pub name: String,
    pub tags: Vec<String>,
    pub priority: i32,
    /// What the spec names, in its order.
    pub maneuvers: Vec<String>,
    /// JSON of the spec, as submitted.
    pub spec: String,
    /// JSON of the model document that the spec names or holds: what it means today it means forever.
    pub model: String,
}

/// Which jobs a list shows; `None` shows all.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct JobFilter {
    pub status: Option<Status>,
    pub kind: Option<String>,
    pub tag: Option<String>,
    /// RFC 3339 UTC with milliseconds.
    pub created_after: Option<String>,
    /// In its name, tags, model or labels of maneuvers.
    pub search: Search,
}

/// What became of the wish to stop a job.
#[derive(Clone, PartialEq, Debug)]
pub enum CancelReply {
    /// It is in the log; a job that nobody works on is over at once.
    Asked(JobRecord),
    AlreadyOver(JobRecord),
    Unknown,
}

fn to_json(about: &About) -> Result<String, StoreError> {
    serde_json::to_string(about).map_err(|error| StoreError::Unwritable {
        what: "the job".into(),
        why: error.to_string(),
    })
}

impl Project {
    /// Accepts a job: when this returns, it is on the disk and a worker will take it. Accepted again under the same id, it
    /// is what it was.
    ///
    /// # Errors
    /// As [`Project::submit_all`].
    pub async fn submit(&self, id: Uuid, job: &NewJob) -> Result<JobRecord, StoreError> {
        let accepted = self.submit_all(&[(id, job)]).await?.pop();
        accepted.ok_or_else(|| StoreError::corrupt("a job", "it vanished"))
    }

    /// Accepts all of these jobs, or none.
    ///
    /// # Errors
    /// The database cannot be written. [`StoreError::ManeuverGone`]: a maneuver was deleted in the meantime.
    pub async fn submit_all(&self, jobs: &[(Uuid, &NewJob)]) -> Result<Vec<JobRecord>, StoreError> {
        let mut writing = self.store.begin().await?;
        let mut accepted = Vec::new();
        for (number, (id, job)) in jobs.iter().enumerate() {
            let new = self.accept(&mut writing, *id, job).await?;
            if new.is_some() {
                self.hold_maneuvers(&mut writing, number, job).await?;
            }
            accepted.push(new);
        }
        writing.tell(Signal::Work);
        writing.commit().await?;
        let mut records = Vec::new();
        for ((id, _), new) in jobs.iter().zip(accepted) {
            let record = match new {
                Some(record) => Some(record),
                None => self.job(*id).await?,
            };
            records.push(record.ok_or_else(|| StoreError::corrupt("a job", "it vanished"))?);
        }
        Ok(records)
    }

    /// Makes sure that the maneuvers of a job are there and stay: one may have been deleted since the job was checked, and
    /// nobody deletes it from here on, since the job is seen when the lock is gone.
    async fn hold_maneuvers(
        &self,
        writing: &mut Writing,
        number: usize,
        job: &NewJob,
    ) -> Result<(), StoreError> {
        let sql = format!(
            "SELECT id FROM maneuvers WHERE project = $1 AND id = $2 {}",
            self.store.engine.sharing()
        );
        for (place, id) in job.maneuvers.iter().enumerate() {
            let held = sqlx::query(AssertSqlSafe(sql.as_str()))
                .bind(&*self.name)
                .bind(id)
                .fetch_optional(writing.connection())
                .await?;
            if held.is_none() {
                return Err(StoreError::ManeuverGone { job: number, place });
            }
        }
        Ok(())
    }

    /// `None`: there is one of this id.
    async fn accept(
        &self,
        writing: &mut Writing,
        id: Uuid,
        job: &NewJob,
    ) -> Result<Option<JobRecord>, StoreError> {
        let now = self.store.clock.now_text();
        let tags = serde_json::Value::from(job.tags.clone()).to_string();
        let about = About::of(writing.connection(), &self.name, &job.spec, &job.model).await?;
        let turn = queue::next_turn(writing.connection(), &self.submitter).await?;
        let inserted = sqlx::query(
            "INSERT INTO jobs (id, kind, name, tags, status, created, last_seq, attempt, lost, spec, model, \
             project, submitter, priority, turn, about, words) \
             VALUES ($1, $2, $3, $4, $5, $6, 0, 0, 0, $7, $8, $9, $10, $11, $12, $13, $14) ON CONFLICT (id) DO NOTHING",
        )
        .bind(id.to_string())
        .bind(&job.kind)
        .bind(&job.name)
        .bind(tags)
        .bind(Status::Queued.name())
        .bind(&now)
        .bind(&job.spec)
        .bind(&job.model)
        .bind(&*self.name)
        .bind(&*self.submitter)
        .bind(i64::from(job.priority))
        .bind(turn)
        .bind(to_json(&about)?)
        .bind(words_of_job(&job.name, &job.tags, &about))
        .execute(writing.connection())
        .await?;
        if inserted.rows_affected() == 0 {
            return Ok(None);
        }
        for tag in &job.tags {
            sqlx::query("INSERT INTO job_tags (tag, job) VALUES ($1, $2) ON CONFLICT DO NOTHING")
                .bind(tag)
                .bind(id.to_string())
                .execute(writing.connection())
                .await?;
        }
        let mut head = Head {
            status: None,
            last_seq: 0,
        };
        let queued = [EventBody::Queued];
        record(writing.connection(), id, &mut head, &now, &queued).await?;
        Ok(Some(JobRecord {
            id,
            kind: job.kind.clone(),
            name: job.name.clone(),
            tags: job.tags.clone(),
            priority: job.priority,
            status: Status::Queued,
            created: now,
            started: None,
            finished: None,
            attempt: 0,
            last_seq: u64::try_from(head.last_seq).unwrap_or(0),
            ending: None,
            about,
            fit: None,
        }))
    }

    /// # Errors
    /// The database does not answer.
    pub async fn job(&self, id: Uuid) -> Result<Option<JobRecord>, StoreError> {
        let row = sqlx::query(AssertSqlSafe(format!(
            "SELECT {COLUMNS} WHERE j.id = $1 AND j.project = $2"
        )))
        .bind(id.to_string())
        .bind(&*self.name)
        .fetch_optional(&self.store.readers)
        .await?;
        row.as_ref().map(read_job).transpose()
    }

    /// What was submitted, to be submitted again: the model is what it was then.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn submitted(&self, id: Uuid) -> Result<Option<NewJob>, StoreError> {
        let sql = "SELECT kind, name, tags, priority, spec, model FROM jobs WHERE id = $1 AND project = $2";
        let row = sqlx::query(sql)
            .bind(id.to_string())
            .bind(&*self.name)
            .fetch_optional(&self.store.readers)
            .await?;
        let Some(row) = row else { return Ok(None) };
        let corrupt = |error| StoreError::corrupt(format!("job {id}"), error);
        let tags = serde_json::from_str(row.try_get("tags")?).map_err(corrupt)?;
        let spec: JobSpec = serde_json::from_str(row.try_get("spec")?).map_err(corrupt)?;
        Ok(Some(NewJob {
            maneuvers: spec.maneuvers.into_iter().map(|used| used.id).collect(),
            kind: row.try_get("kind")?,
            name: row.try_get("name")?,
            tags,
            priority: i32::try_from(row.try_get::<i64, _>("priority")?).unwrap_or(0),
            spec: row.try_get("spec")?,
            model: row.try_get("model")?,
        }))
    }

    /// JSON of the spec, as it was submitted.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn job_spec(&self, id: Uuid) -> Result<Option<String>, StoreError> {
        let row = sqlx::query("SELECT spec FROM jobs WHERE id = $1 AND project = $2")
            .bind(id.to_string())
            .bind(&*self.name)
            .fetch_optional(&self.store.readers)
            .await?;
        Ok(row.map(|row| row.try_get("spec")).transpose()?)
    }

    /// Jobs that pass the filter, newest first.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn jobs(
        &self,
        filter: &JobFilter,
        cursor: Option<&str>,
        limit: usize,
    ) -> Result<Result<Page<JobRecord>, BadCursor>, StoreError> {
        let before = match cursor.map(Uuid::parse_str) {
            None => None,
            Some(Ok(id)) => Some(id.to_string()),
            Some(Err(_)) => return Ok(Err(BadCursor)),
        };
        let mut conditions = Vec::new();
        let mut values = Vec::new();
        let mut wanted = |condition: &str, value: Option<String>| {
            if let Some(value) = value {
                values.push(value);
                conditions.push(condition.replace('?', &format!("${}", values.len())));
            }
        };
        wanted("j.project = ?", Some(self.name.to_string()));
        wanted("j.id < ?", before);
        wanted(
            "j.status = ?",
            filter.status.map(|status| status.name().to_string()),
        );
        wanted("j.kind = ?", filter.kind.clone());
        wanted(
            "j.id IN (SELECT job FROM job_tags WHERE tag = ?)",
            filter.tag.clone(),
        );
        wanted("j.created > ?", filter.created_after.clone());
        let words = "COALESCE(j.words, LOWER(j.name))";
        for (condition, pattern) in filter.search.conditions(words) {
            wanted(&condition, Some(pattern));
        }
        let conditions = conditions.join(" AND ");
        let limit_at = values.len() + 1;
        let sql =
            format!("SELECT {COLUMNS} WHERE {conditions} ORDER BY j.id DESC LIMIT ${limit_at}");
        // safe: put together from the constants above; what users wrote is bound
        let mut query = sqlx::query(AssertSqlSafe(sql));
        for value in values {
            query = query.bind(value);
        }
        let rows = query
            .bind(one_more(limit))
            .fetch_all(&self.store.readers)
            .await?;
        let cursor = |job: &JobRecord| job.id.to_string();
        Ok(Ok(Page::readable(&rows, limit, read_job, cursor)))
    }

    /// Asks to stop a job. Asking twice is asking once.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn cancel(&self, id: Uuid) -> Result<CancelReply, StoreError> {
        let mut writing = self.store.begin().await?;
        let Some((status, last_seq)) = self.hold(&mut writing, id).await? else {
            return Ok(CancelReply::Unknown);
        };
        let mut head = Head {
            status: Some(status),
            last_seq,
        };
        let events = match status {
            Status::Queued => vec![
                EventBody::CancelRequested,
                EventBody::cancelled_without_result(),
            ],
            Status::Running => vec![EventBody::CancelRequested],
            Status::Cancelling | Status::Succeeded | Status::Failed | Status::Cancelled => {
                Vec::new()
            }
        };
        if !events.is_empty() {
            let now = self.store.clock.now_text();
            record(writing.connection(), id, &mut head, &now, &events).await?;
            writing.tell(Signal::Log(id));
            writing.tell(Signal::Cancel(id));
        }
        writing.commit().await?;
        Ok(match self.job(id).await? {
            None => CancelReply::Unknown,
            Some(job) if status.is_over() => CancelReply::AlreadyOver(job),
            Some(job) => CancelReply::Asked(job),
        })
    }

    /// Status and last event of a job, which nobody else changes until the transaction ends.
    pub(super) async fn hold(
        &self,
        writing: &mut Writing,
        id: Uuid,
    ) -> Result<Option<(Status, i64)>, StoreError> {
        let sql = format!(
            "SELECT status, last_seq FROM jobs WHERE id = $1 AND project = $2 {}",
            self.store.engine.locking()
        );
        let row = sqlx::query(AssertSqlSafe(sql))
            .bind(id.to_string())
            .bind(&*self.name)
            .fetch_optional(writing.connection())
            .await?;
        let Some(row) = row else { return Ok(None) };
        let status = read_status(row.try_get("status")?)?;
        Ok(Some((status, row.try_get("last_seq")?)))
    }
}
