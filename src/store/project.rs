//! A project: all that one may see of the store whose key opens it.
//!
//! What users ask for is asked of a [`Project`], and each statement behind it names the project: what is another's is not
//! there. What workers and operators do is done with the [`Store`].

use std::sync::Arc;
use std::time::Duration;

use uuid::Uuid;

use super::{Clock, Expired, Key, KeyRecord, Listener, NewKey, Rule, Store, StoreError};

/// The project of those who need no key, and of what was stored before there were keys.
pub const DEFAULT_PROJECT: &str = "default";

/// One project's share of the store; clones share one database.
#[derive(Clone)]
pub struct Project {
    pub(super) store: Store,
    pub(super) name: Arc<str>,
    /// Whose requests these are: the id of a key, or nothing where none is needed.
    pub(super) submitter: Arc<str>,
}

impl Store {
    /// What a project sees. `submitter` is the key whose requests follow, by its id.
    pub fn project(&self, name: &str, submitter: &str) -> Project {
        Project {
            store: self.clone(),
            name: name.into(),
            submitter: submitter.into(),
        }
    }
}

impl Project {
    pub fn name(&self) -> &str {
        &self.name
    }

    /// As [`Store::clock`].
    pub fn clock(&self) -> &Clock {
        self.store.clock()
    }

    /// As [`Store::listen`].
    pub fn listen(&self) -> Listener {
        self.store.listen()
    }

    /// # Errors
    /// As [`Store::keys`].
    pub async fn keys(&self) -> Result<Vec<KeyRecord>, StoreError> {
        self.store.keys(Some(&self.name)).await
    }

    /// # Errors
    /// As [`Store::add_key`].
    pub async fn add_key(&self, new: &NewKey) -> Result<(KeyRecord, Key), StoreError> {
        self.store.add_key(new).await
    }

    /// # Errors
    /// As [`Store::revoke_key`].
    pub async fn revoke_key(&self, id: Uuid) -> Result<Option<KeyRecord>, StoreError> {
        self.store.revoke_key(Some(&self.name), id).await
    }

    /// # Errors
    /// As [`Store::rotate_key`].
    pub async fn rotate_key(
        &self,
        id: Uuid,
        overlap: Duration,
    ) -> Result<Option<(KeyRecord, Key)>, StoreError> {
        self.store.rotate_key(Some(&self.name), id, overlap).await
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
        self.store.expire(&rule, dry_run).await
    }
}
