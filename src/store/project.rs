//! A project: all that one may see of the store whose key opens it.
//!
//! What users ask for is asked of a [`Project`], and each statement behind it names the project: what is another's is not
//! there. What workers and operators do is done with the [`Store`].

use std::sync::Arc;

use super::clock::Clock;
use super::database::Store;
use super::signal::Listener;

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
}
