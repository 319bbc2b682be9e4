//! Who did what cannot be undone, or lets somebody in: written in the transaction that does it, and never deleted.

use sqlx::any::AnyRow;
use sqlx::{AnyConnection, Row};
use uuid::Uuid;

use super::clock::Clock;
use super::page::one_more;
use super::row::read_id;
use super::writing::Writing;
use super::{BadCursor, Page, Project, Store, StoreError};

/// Something that is written down.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Deed {
    JobDeleted,
    ManeuverDeleted,
    MappingDeleted,
    Expired,
    KeyMade,
    KeyRotated,
    KeyRevoked,
    WebhookAdded,
    WebhookRotated,
    WebhookDeleted,
}

impl Deed {
    fn name(self) -> &'static str {
        match self {
            Self::JobDeleted => "job.deleted",
            Self::ManeuverDeleted => "maneuver.deleted",
            Self::MappingDeleted => "mapping.deleted",
            Self::Expired => "expired",
            Self::KeyMade => "key.made",
            Self::KeyRotated => "key.rotated",
            Self::KeyRevoked => "key.revoked",
            Self::WebhookAdded => "webhook.added",
            Self::WebhookRotated => "webhook.rotated",
            Self::WebhookDeleted => "webhook.deleted",
        }
    }
}

/// Whose project it is, and who does it.
#[derive(Clone, Copy)]
pub(super) struct Actor<'a> {
    /// Empty: all.
    pub project: &'a str,
    /// A key, by its id; empty: nobody needs one, or who has the database at hand.
    pub key: &'a str,
}

/// A line of the audit.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct AuditRecord {
    pub id: Uuid,
    pub project: String,
    /// The key that did it; `None`: who has the database at hand, or needs no key.
    pub key: Option<String>,
    pub at: String,
    /// Such as `key.made`.
    pub deed: String,
    /// What it was done to: an id, a name; never a secret.
    pub subject: String,
}

pub(super) async fn note(
    connection: &mut AnyConnection,
    clock: &Clock,
    actor: Actor<'_>,
    deed: Deed,
    subject: &str,
) -> Result<(), StoreError> {
    let sql =
        "INSERT INTO audit (id, project, actor, at, deed, subject) VALUES ($1, $2, $3, $4, $5, $6)";
    sqlx::query(sql)
        .bind(clock.new_id().to_string())
        .bind(actor.project)
        .bind(actor.key)
        .bind(clock.now_text())
        .bind(deed.name())
        .bind(subject)
        .execute(connection)
        .await?;
    Ok(())
}

fn read_line(row: &AnyRow) -> Result<AuditRecord, StoreError> {
    let key: String = row.try_get("actor")?;
    Ok(AuditRecord {
        id: read_id(row, "id")?,
        project: row.try_get("project")?,
        key: (!key.is_empty()).then_some(key),
        at: row.try_get("at")?,
        deed: row.try_get("deed")?,
        subject: row.try_get("subject")?,
    })
}

impl Store {
    /// The audit of a project, or of all; the newest first.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn audit(
        &self,
        project: Option<&str>,
        cursor: Option<&str>,
        limit: usize,
    ) -> Result<Result<Page<AuditRecord>, BadCursor>, StoreError> {
        let before = match cursor.map(Uuid::parse_str) {
            None => Uuid::max(),
            Some(Ok(id)) => id,
            Some(Err(_)) => return Ok(Err(BadCursor)),
        };
        // what was done in all projects was done in each
        let sql = "SELECT id, project, actor, at, deed, subject FROM audit \
                   WHERE ($1 = 1 OR project = $2 OR project = '') AND id < $3 ORDER BY id DESC LIMIT $4";
        let rows = sqlx::query(sql)
            .bind(i64::from(project.is_none()))
            .bind(project.unwrap_or_default())
            .bind(before.to_string())
            .bind(one_more(limit))
            .fetch_all(&self.readers)
            .await?;
        let cursor = |line: &AuditRecord| line.id.to_string();
        Ok(Ok(Page::readable(&rows, limit, read_line, cursor)))
    }
}

impl Project {
    /// # Errors
    /// As [`Store::audit`].
    pub async fn audit(
        &self,
        cursor: Option<&str>,
        limit: usize,
    ) -> Result<Result<Page<AuditRecord>, BadCursor>, StoreError> {
        self.store.audit(Some(&self.name), cursor, limit).await
    }

    /// In the transaction that does it.
    pub(super) async fn note(
        &self,
        writing: &mut Writing,
        deed: Deed,
        subject: &str,
    ) -> Result<(), StoreError> {
        let actor = Actor {
            project: &self.name,
            key: &self.submitter,
        };
        note(
            writing.connection(),
            &self.store.clock,
            actor,
            deed,
            subject,
        )
        .await
    }
}
