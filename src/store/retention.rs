//! Deleting: one job or maneuver by hand, or what is older than it need be kept.
//!
//! Which maneuvers a job uses stands in its spec and nowhere else: a maneuver's id is a digest of 64 digits, so that a spec
//! that has it in its text uses it. That takes a look at every spec, which deleting, done seldom, can afford.

use std::time::Duration;

use sqlx::{AnyConnection, AssertSqlSafe, Row};
use uuid::Uuid;

use super::audit::{self, Actor, Deed};
use super::writing::Writing;
use super::{Project, Store, StoreError};

/// What became of the wish to delete something.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Deleted {
    Gone,
    Unknown,
    /// A job that is not over.
    NotOver,
    /// A maneuver that so many jobs use.
    InUse(u64),
}

/// What need not be kept.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Rule {
    /// Of this project only.
    pub project: Option<String>,
    /// Jobs that ended, and maneuvers that were uploaded, before this moment.
    pub before: String,
    /// Jobs with this tag are kept, and what they use.
    pub keep_tag: String,
}

/// What was deleted, or would be.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Expired {
    pub jobs: u64,
    pub maneuvers: u64,
    /// That the maneuvers take.
    pub maneuver_bytes: u64,
}

const OVER: &str = "('succeeded', 'failed', 'cancelled')";

/// Jobs that end with a transaction, so that it does not hold up others for long.
const AT_ONCE: usize = 100;

impl Project {
    /// Deletes a job that is over, with its log and result.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn delete_job(&self, id: Uuid) -> Result<Deleted, StoreError> {
        let mut writing = self.store.begin().await?;
        let refused = match self.hold(&mut writing, id).await? {
            None => Some(Deleted::Unknown),
            Some((status, _)) if !status.is_over() => Some(Deleted::NotOver),
            Some(_) => None,
        };
        if let Some(refused) = refused {
            writing.abandon().await?;
            return Ok(refused);
        }
        let name = id.to_string();
        delete(writing.connection(), &name).await?;
        self.note(&mut writing, Deed::JobDeleted, &name).await?;
        writing.commit().await?;
        Ok(Deleted::Gone)
    }

    /// Deletes a maneuver that no job uses: a result without its data could not be made again.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn delete_maneuver(&self, id: &str) -> Result<Deleted, StoreError> {
        if self.maneuver(id).await?.is_none() {
            return Ok(Deleted::Unknown);
        }
        let mut writing = self.store.begin().await?;
        hold(&self.store, &mut writing, &self.name, id).await?;
        let sql =
            "SELECT COUNT(*) AS jobs FROM jobs WHERE project = $1 AND spec LIKE '%' || $2 || '%'";
        let row = sqlx::query(sql)
            .bind(&*self.name)
            .bind(id)
            .fetch_one(writing.connection())
            .await?;
        let jobs = u64::try_from(row.try_get::<i64, _>("jobs")?).unwrap_or(0);
        if jobs > 0 {
            writing.abandon().await?;
            return Ok(Deleted::InUse(jobs));
        }
        sqlx::query("DELETE FROM maneuvers WHERE project = $1 AND id = $2")
            .bind(&*self.name)
            .bind(id)
            .execute(writing.connection())
            .await?;
        self.note(&mut writing, Deed::ManeuverDeleted, id).await?;
        writing.commit().await?;
        Ok(Deleted::Gone)
    }

    /// Deletes what is older than `age`; see [`Store::expire`].
    ///
    /// # Errors
    /// As [`Store::expire`].
    pub async fn expire(
        &self,
        age: Duration,
        keep_tag: &str,
        dry_run: bool,
    ) -> Result<Expired, StoreError> {
        let rule = Rule {
            project: Some(self.name.to_string()),
            before: self.store.clock.text_before(age),
            keep_tag: keep_tag.to_string(),
        };
        self.store.expire_as(&rule, dry_run, &self.submitter).await
    }
}

impl Store {
    /// Deletes what need not be kept, or with `dry_run` says how much it is: jobs that are over, and maneuvers that no job uses
    /// which is left. The record of messages to webhooks goes with them.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn expire(&self, rule: &Rule, dry_run: bool) -> Result<Expired, StoreError> {
        self.expire_as(rule, dry_run, "").await
    }

    async fn expire_as(
        &self,
        rule: &Rule,
        dry_run: bool,
        key: &str,
    ) -> Result<Expired, StoreError> {
        // all projects have a name: that is what `of_one` is compared with where none is asked for
        let is_wanted = if rule.project.is_some() { "=" } else { "<>" };
        let of_one = rule.project.as_deref().unwrap_or_default();
        let doomed = format!(
            "jobs.status IN {OVER} AND jobs.finished < $1 AND jobs.project {is_wanted} $3 \
             AND NOT EXISTS (SELECT 1 FROM job_tags WHERE job_tags.job = jobs.id AND job_tags.tag = $2)"
        );
        let unused = format!(
            "maneuvers.created < $1 AND maneuvers.project {is_wanted} $3 AND NOT EXISTS (SELECT 1 FROM jobs \
             WHERE jobs.project = maneuvers.project AND jobs.spec LIKE '%' || maneuvers.id || '%' AND NOT ({doomed}))"
        );
        let select = format!(
            "SELECT COUNT(*) AS maneuvers, CAST(COALESCE(SUM(bytes), 0) AS BIGINT) AS bytes FROM maneuvers WHERE {unused}"
        );
        let row = sqlx::query(AssertSqlSafe(select))
            .bind(&rule.before)
            .bind(&rule.keep_tag)
            .bind(of_one)
            .fetch_one(&self.readers)
            .await?;
        let jobs = format!("SELECT id FROM jobs WHERE {doomed} ORDER BY id");
        let jobs = sqlx::query(AssertSqlSafe(jobs))
            .bind(&rule.before)
            .bind(&rule.keep_tag)
            .bind(of_one)
            .fetch_all(&self.readers)
            .await?;
        let of = |column| {
            Ok::<_, StoreError>(u64::try_from(row.try_get::<i64, _>(column)?).unwrap_or(0))
        };
        let expired = Expired {
            jobs: jobs.len() as u64,
            maneuvers: of("maneuvers")?,
            maneuver_bytes: of("bytes")?,
        };
        if dry_run {
            return Ok(expired);
        }
        self.note_expiry(rule, expired, key).await?;
        for some in jobs.chunks(AT_ONCE) {
            let mut writing = self.begin().await?;
            for job in some {
                delete(writing.connection(), job.try_get("id")?).await?;
            }
            writing.commit().await?;
        }
        self.delete_unused(rule, &unused).await?;
        let told = format!(
            "DELETE FROM deliveries WHERE next IS NULL AND created < $1 \
             AND webhook IN (SELECT id FROM webhooks WHERE project {is_wanted} $2)"
        );
        sqlx::query(AssertSqlSafe(told))
            .bind(&rule.before)
            .bind(of_one)
            .execute(&self.writer)
            .await?;
        Ok(expired)
    }
}

impl Store {
    /// Before it begins: what is deleted by one that is broken off is written down, too.
    async fn note_expiry(
        &self,
        rule: &Rule,
        expired: Expired,
        key: &str,
    ) -> Result<(), StoreError> {
        let Expired {
            jobs, maneuvers, ..
        } = expired;
        let subject = format!(
            "{jobs} jobs and {maneuvers} maneuvers from before {}",
            rule.before
        );
        let project = rule.project.as_deref().unwrap_or_default();
        let actor = Actor { project, key };
        let mut writing = self.begin().await?;
        let connection = writing.connection();
        audit::note(connection, &self.clock, actor, Deed::Expired, &subject).await?;
        writing.commit().await
    }

    /// Deletes maneuvers of which `unused` holds with what the rule says as $1, $2 and $3. Each by itself: a job that is
    /// submitted meanwhile holds its maneuvers, and is seen once it does not.
    async fn delete_unused(&self, rule: &Rule, unused: &str) -> Result<(), StoreError> {
        let of_one = rule.project.as_deref().unwrap_or_default();
        let select = format!("SELECT project, id FROM maneuvers WHERE {unused}");
        let seen = sqlx::query(AssertSqlSafe(select))
            .bind(&rule.before)
            .bind(&rule.keep_tag)
            .bind(of_one)
            .fetch_all(&self.readers)
            .await?;
        let delete = format!("DELETE FROM maneuvers WHERE {unused} AND project = $4 AND id = $5");
        for row in seen {
            let (project, id): (&str, &str) = (row.try_get("project")?, row.try_get("id")?);
            let mut writing = self.begin().await?;
            hold(self, &mut writing, project, id).await?;
            sqlx::query(AssertSqlSafe(delete.as_str()))
                .bind(&rule.before)
                .bind(&rule.keep_tag)
                .bind(of_one)
                .bind(project)
                .bind(id)
                .execute(writing.connection())
                .await?;
            writing.commit().await?;
        }
        Ok(())
    }
}

/// Waits for those who submit jobs with this maneuver; the next statement sees their jobs, and those that come later find it
/// gone.
async fn hold(
    store: &Store,
    writing: &mut Writing,
    project: &str,
    id: &str,
) -> Result<(), StoreError> {
    let locking = store.engine.locking();
    let sql = format!("SELECT id FROM maneuvers WHERE project = $1 AND id = $2 {locking}");
    sqlx::query(AssertSqlSafe(sql))
        .bind(project)
        .bind(id)
        .fetch_optional(writing.connection())
        .await?;
    Ok(())
}

async fn delete(connection: &mut AnyConnection, job: &str) -> Result<(), StoreError> {
    for sql in [
        "DELETE FROM results WHERE job = $1",
        "DELETE FROM events WHERE job = $1",
        "DELETE FROM job_tags WHERE job = $1",
        "DELETE FROM jobs WHERE id = $1",
    ] {
        sqlx::query(sql).bind(job).execute(&mut *connection).await?;
    }
    Ok(())
}
