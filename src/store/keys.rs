//! Keys: who may do what in which project. A key is shown once, when it is made; what is kept is its digest.

use std::collections::BTreeSet;
use std::fmt;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use sqlx::any::AnyRow;
use sqlx::{AssertSqlSafe, Row};
use utoipa::ToSchema;
use uuid::Uuid;

use super::row::read_id;
use super::{Clock, Project, Store, StoreError};

/// What every key begins with: tools that look for leaked secrets find it by that.
const PREFIX: &str = "trimtab_";

/// The use of a key is noted no more often than this.
const NOTED_EVERY: Duration = Duration::from_secs(600);

/// Something that a key allows.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scope {
    /// See what the project has.
    Read,
    /// Upload, submit and cancel.
    Submit,
    /// Make and revoke the project's keys, and delete what it has.
    Admin,
    /// See what the service does: numbers over all projects, and no data of any.
    Metrics,
}

impl Scope {
    pub const ALL: [Self; 4] = [Self::Read, Self::Submit, Self::Admin, Self::Metrics];

    pub fn name(self) -> &'static str {
        match self {
            Self::Read => "read",
            Self::Submit => "submit",
            Self::Admin => "admin",
            Self::Metrics => "metrics",
        }
    }
}

/// The secret itself.
#[derive(Clone, PartialEq, Eq)]
pub struct Key(String);

impl Key {
    fn new() -> Result<Self, StoreError> {
        let mut secret = [0; 32];
        getrandom::fill(&mut secret).map_err(|error| StoreError::Unwritable {
            what: "a key".into(),
            why: error.to_string(),
        })?;
        Ok(Self(format!("{PREFIX}{}", hex::encode(secret))))
    }

    /// For whom it was made for, and for nobody else.
    pub fn reveal(&self) -> &str {
        &self.0
    }
}

impl fmt::Debug for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{PREFIX}…")
    }
}

/// With 256 random bits in a key, its digest need be neither salted nor slow; and how long the database looks for one tells
/// nothing of a key, since nobody can choose what digest a guess has.
fn digest(key: &str) -> String {
    hex::encode(Sha256::digest(key))
}

/// A key to be made.
#[derive(Clone, PartialEq, Debug)]
pub struct NewKey {
    pub project: String,
    /// For people: what it is used by.
    pub name: String,
    pub scopes: BTreeSet<Scope>,
    /// The highest priority of jobs that are submitted with it.
    pub max_priority: i32,
    /// For ever, if there is none.
    pub lifetime: Option<Duration>,
}

/// A key without its secret.
#[derive(Clone, PartialEq, Debug)]
pub struct KeyRecord {
    pub id: Uuid,
    pub project: String,
    pub name: String,
    pub scopes: BTreeSet<Scope>,
    pub max_priority: i32,
    pub created: String,
    /// As it was asked for.
    pub lifetime: Option<Duration>,
    pub expires: Option<String>,
    pub revoked: Option<String>,
    /// When it was last used, to ten minutes.
    pub used: Option<String>,
}

/// What there is to say to somebody who shows a key.
#[derive(Clone, PartialEq, Debug)]
pub enum KeyCheck {
    Good(Box<KeyRecord>),
    Unknown,
    Revoked,
    Expired,
}

const COLUMNS: &str =
    "id, project, name, scopes, max_priority, created, lifetime, expires, revoked, used FROM keys";

fn read_key(row: &AnyRow) -> Result<KeyRecord, StoreError> {
    let id = read_id(row, "id")?;
    let scopes = serde_json::from_str(row.try_get("scopes")?)
        .map_err(|error| StoreError::corrupt(format!("key {id}"), error))?;
    let created: String = row.try_get("created")?;
    let expires: Option<String> = row.try_get("expires")?;
    let lifetime = match row.try_get::<Option<i64>, _>("lifetime")? {
        Some(0) => None,
        Some(seconds) => Some(Duration::from_secs(seconds.unsigned_abs())),
        // of a key from before it was kept: what it had, so that none outlives what was meant
        None => expires
            .as_deref()
            .and_then(|expires| Clock::seconds_between(&created, expires))
            .map(|seconds| Duration::from_secs_f64(seconds.max(1.0))),
    };
    Ok(KeyRecord {
        id,
        project: row.try_get("project")?,
        name: row.try_get("name")?,
        scopes,
        max_priority: i32::try_from(row.try_get::<i64, _>("max_priority")?).unwrap_or(0),
        created,
        lifetime,
        expires,
        revoked: row.try_get("revoked")?,
        used: row.try_get("used")?,
    })
}

impl Store {
    /// Whether there was ever a key: from then on nobody comes in without, even if all were revoked.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn has_keys(&self) -> Result<bool, StoreError> {
        let row = sqlx::query("SELECT id FROM keys LIMIT 1")
            .fetch_optional(&self.readers)
            .await?;
        Ok(row.is_some())
    }

    /// Makes a key. Its secret is not kept: whoever loses it makes another.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn add_key(&self, new: &NewKey) -> Result<(KeyRecord, Key), StoreError> {
        self.add_key_as(self.clock.new_id(), new).await
    }

    /// As [`Store::add_key`]. Made again under the same id it gets another secret: the first was shown to nobody, since its
    /// maker died before it answered.
    async fn add_key_as(&self, id: Uuid, new: &NewKey) -> Result<(KeyRecord, Key), StoreError> {
        let key = Key::new()?;
        let record = KeyRecord {
            id,
            project: new.project.clone(),
            name: new.name.clone(),
            scopes: new.scopes.clone(),
            max_priority: new.max_priority,
            created: self.clock.now_text(),
            lifetime: new.lifetime,
            expires: new.lifetime.map(|time| self.clock.text_after(time)),
            revoked: None,
            used: None,
        };
        let names: Vec<&str> = record.scopes.iter().map(|scope| scope.name()).collect();
        sqlx::query(
            "INSERT INTO keys (id, project, name, digest, scopes, max_priority, created, lifetime, expires) \
             VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9) ON CONFLICT (id) DO UPDATE SET digest = excluded.digest",
        )
        .bind(record.id.to_string())
        .bind(&record.project)
        .bind(&record.name)
        .bind(digest(key.reveal()))
        .bind(serde_json::Value::from(names).to_string())
        .bind(i64::from(record.max_priority))
        .bind(&record.created)
        .bind(new.lifetime.map_or(0, |time| i64::try_from(time.as_secs().max(1)).unwrap_or(i64::MAX)))
        .bind(&record.expires)
        .execute(&self.writer)
        .await?;
        Ok((record, key))
    }

    /// Who shows this key.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn look_up_key(&self, key: &str) -> Result<KeyCheck, StoreError> {
        let row = sqlx::query(AssertSqlSafe(format!("SELECT {COLUMNS} WHERE digest = $1")))
            .bind(digest(key))
            .fetch_optional(&self.readers)
            .await?;
        let Some(row) = row else {
            return Ok(KeyCheck::Unknown);
        };
        let record = read_key(&row)?;
        let now = self.clock.now_text();
        if record.revoked.is_some() {
            return Ok(KeyCheck::Revoked);
        }
        if record
            .expires
            .as_ref()
            .is_some_and(|expires| *expires <= now)
        {
            return Ok(KeyCheck::Expired);
        }
        // whoever has a good key comes in, even where that cannot be written down
        if let Err(error) = self.note_use(&record).await {
            tracing::warn!(%error, key = %record.id, "its use was not noted");
        }
        Ok(KeyCheck::Good(Box::new(record)))
    }

    async fn note_use(&self, key: &KeyRecord) -> Result<(), StoreError> {
        let recent = self.clock.text_before(NOTED_EVERY);
        if key.used.as_ref().is_some_and(|used| *used > recent) {
            return Ok(());
        }
        sqlx::query("UPDATE keys SET used = $2 WHERE id = $1")
            .bind(key.id.to_string())
            .bind(self.clock.now_text())
            .execute(&self.writer)
            .await?;
        Ok(())
    }

    /// The keys of a project, or all of them; the newest first.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn keys(&self, project: Option<&str>) -> Result<Vec<KeyRecord>, StoreError> {
        let sql = format!("SELECT {COLUMNS} WHERE project = $1 OR $2 = 1 ORDER BY id DESC");
        let rows = sqlx::query(AssertSqlSafe(sql))
            .bind(project.unwrap_or_default())
            .bind(i64::from(project.is_none()))
            .fetch_all(&self.readers)
            .await?;
        rows.iter().map(read_key).collect()
    }

    /// Revokes a key from now on; of this project, if one is named. `None`: there is none. Twice is once.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn revoke_key(
        &self,
        project: Option<&str>,
        id: Uuid,
    ) -> Result<Option<KeyRecord>, StoreError> {
        if self.key(project, id).await?.is_none() {
            return Ok(None);
        }
        sqlx::query("UPDATE keys SET revoked = COALESCE(revoked, $2) WHERE id = $1")
            .bind(id.to_string())
            .bind(self.clock.now_text())
            .execute(&self.writer)
            .await?;
        self.key(project, id).await
    }

    /// Makes a key that may do what this one may, and for as long from now; the old one ends after `overlap`: time to carry the new one to where it is used.
    /// `None`: there is none that is good.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn rotate_key(
        &self,
        project: Option<&str>,
        id: Uuid,
        overlap: Duration,
    ) -> Result<Option<(KeyRecord, Key)>, StoreError> {
        let new = self.clock.new_id();
        self.rotate_key_as(project, id, new, overlap).await
    }

    async fn rotate_key_as(
        &self,
        project: Option<&str>,
        id: Uuid,
        new_id: Uuid,
        overlap: Duration,
    ) -> Result<Option<(KeyRecord, Key)>, StoreError> {
        let now = self.clock.now_text();
        let is_good = |key: &KeyRecord| {
            key.revoked.is_none() && key.expires.as_ref().is_none_or(|at| *at > now)
        };
        let Some(old) = self.key(project, id).await?.filter(is_good) else {
            return Ok(None);
        };
        let new = NewKey {
            project: old.project,
            name: old.name,
            scopes: old.scopes,
            max_priority: old.max_priority,
            lifetime: old.lifetime,
        };
        let made = self.add_key_as(new_id, &new).await?;
        let until = self.clock.text_after(overlap);
        sqlx::query(
            "UPDATE keys SET expires = $2 WHERE id = $1 AND (expires IS NULL OR expires > $2)",
        )
        .bind(id.to_string())
        .bind(until)
        .execute(&self.writer)
        .await?;
        Ok(Some(made))
    }

    async fn key(&self, project: Option<&str>, id: Uuid) -> Result<Option<KeyRecord>, StoreError> {
        let sql = format!("SELECT {COLUMNS} WHERE id = $1 AND (project = $2 OR $3 = 1)");
        let row = sqlx::query(AssertSqlSafe(sql))
            .bind(id.to_string())
            .bind(project.unwrap_or_default())
            .bind(i64::from(project.is_none()))
            .fetch_optional(&self.readers)
            .await?;
        row.as_ref().map(read_key).transpose()
    }
}

/// What a project does with its own keys.
impl Project {
    /// # Errors
    /// As [`Store::keys`].
    pub async fn keys(&self) -> Result<Vec<KeyRecord>, StoreError> {
        self.store.keys(Some(&self.name)).await
    }

    /// # Errors
    /// The database does not answer.
    pub async fn key(&self, id: Uuid) -> Result<Option<KeyRecord>, StoreError> {
        self.store.key(Some(&self.name), id).await
    }

    /// Makes a key of this id; made again it gets another secret.
    ///
    /// # Errors
    /// As [`Store::add_key`].
    pub async fn add_key(&self, id: Uuid, new: &NewKey) -> Result<(KeyRecord, Key), StoreError> {
        self.store.add_key_as(id, new).await
    }

    /// # Errors
    /// As [`Store::revoke_key`].
    pub async fn revoke_key(&self, id: Uuid) -> Result<Option<KeyRecord>, StoreError> {
        self.store.revoke_key(Some(&self.name), id).await
    }

    /// Replaces key `id` by one whose id is `new`.
    ///
    /// # Errors
    /// As [`Store::rotate_key`].
    pub async fn rotate_key(
        &self,
        id: Uuid,
        new: Uuid,
        overlap: Duration,
    ) -> Result<Option<(KeyRecord, Key)>, StoreError> {
        self.store
            .rotate_key_as(Some(&self.name), id, new, overlap)
            .await
    }
}
