//! Keys: who may do what in which project. A key is shown once, when it is made; what is kept is its digest.

use std::time::Duration;

use sqlx::any::AnyRow;
use sqlx::{AssertSqlSafe, Row};
use uuid::Uuid;

use super::audit::{self, Actor, Deed};
use super::key::{Key, KeyCheck, KeyRecord, NewKey, digest};
use super::page::readable;
use super::row::read_id;
use super::writing::Writing;
use super::{Clock, Project, Store, StoreError};

/// The use of a key is noted no more often than this.
const NOTED_EVERY: Duration = Duration::from_secs(600);

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
        self.add_key_as(self.clock.new_id(), new, "").await
    }

    async fn add_key_as(
        &self,
        id: Uuid,
        new: &NewKey,
        actor: &str,
    ) -> Result<(KeyRecord, Key), StoreError> {
        let mut writing = self.begin().await?;
        let made = self.insert_key(&mut writing, id, new).await?;
        self.note_key(&mut writing, &made.0, Deed::KeyMade, actor, "")
            .await?;
        writing.commit().await?;
        Ok(made)
    }

    async fn note_key(
        &self,
        writing: &mut Writing,
        key: &KeyRecord,
        deed: Deed,
        actor: &str,
        more: &str,
    ) -> Result<(), StoreError> {
        let actor = Actor {
            project: &key.project,
            key: actor,
        };
        let subject = format!("{} '{}'{more}", key.id, key.name);
        audit::note(writing.connection(), &self.clock, actor, deed, &subject).await
    }

    /// Made again under the same id a key gets another secret: the first was shown to nobody, since its maker died before it
    /// answered.
    async fn insert_key(
        &self,
        writing: &mut Writing,
        id: Uuid,
        new: &NewKey,
    ) -> Result<(KeyRecord, Key), StoreError> {
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
        .execute(writing.connection())
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
        Ok(readable(&rows, read_key))
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
        self.revoke_key_as(project, id, "").await
    }

    async fn revoke_key_as(
        &self,
        project: Option<&str>,
        id: Uuid,
        actor: &str,
    ) -> Result<Option<KeyRecord>, StoreError> {
        let Some(key) = self.key(project, id).await? else {
            return Ok(None);
        };
        let mut writing = self.begin().await?;
        sqlx::query("UPDATE keys SET revoked = COALESCE(revoked, $2) WHERE id = $1")
            .bind(id.to_string())
            .bind(self.clock.now_text())
            .execute(writing.connection())
            .await?;
        if key.revoked.is_none() {
            self.note_key(&mut writing, &key, Deed::KeyRevoked, actor, "")
                .await?;
        }
        writing.commit().await?;
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
        self.rotate_key_as(project, (id, new), overlap, "").await
    }

    async fn rotate_key_as(
        &self,
        project: Option<&str>,
        (id, new_id): (Uuid, Uuid),
        overlap: Duration,
        actor: &str,
    ) -> Result<Option<(KeyRecord, Key)>, StoreError> {
        let now = self.clock.now_text();
        let is_good = |key: &KeyRecord| {
            key.revoked.is_none() && key.expires.as_ref().is_none_or(|at| *at > now)
        };
        let Some(old) = self.key(project, id).await?.filter(is_good) else {
            return Ok(None);
        };
        let new = NewKey {
            project: old.project.clone(),
            name: old.name.clone(),
            scopes: old.scopes.clone(),
            max_priority: old.max_priority,
            lifetime: old.lifetime,
        };
        let mut writing = self.begin().await?;
        let made = self.insert_key(&mut writing, new_id, &new).await?;
        let until = self.clock.text_after(overlap);
        sqlx::query(
            "UPDATE keys SET expires = $2 WHERE id = $1 AND (expires IS NULL OR expires > $2)",
        )
        .bind(id.to_string())
        .bind(until)
        .execute(writing.connection())
        .await?;
        let by = format!(" by {new_id}");
        self.note_key(&mut writing, &old, Deed::KeyRotated, actor, &by)
            .await?;
        writing.commit().await?;
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
        self.store.add_key_as(id, new, &self.submitter).await
    }

    /// # Errors
    /// As [`Store::revoke_key`].
    pub async fn revoke_key(&self, id: Uuid) -> Result<Option<KeyRecord>, StoreError> {
        self.store
            .revoke_key_as(Some(&self.name), id, &self.submitter)
            .await
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
            .rotate_key_as(Some(&self.name), (id, new), overlap, &self.submitter)
            .await
    }
}
