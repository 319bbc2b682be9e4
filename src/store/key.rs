//! A key, and what is known of it without its secret.

use std::collections::BTreeSet;
use std::fmt;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use utoipa::ToSchema;
use uuid::Uuid;

use super::error::StoreError;

/// What every key begins with: tools that look for leaked secrets find it by that.
const PREFIX: &str = "trimtab_";

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
    pub(super) fn new() -> Result<Self, StoreError> {
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
pub(super) fn digest(key: &str) -> String {
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
