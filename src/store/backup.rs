//! A database in a file, carried to another file whole, and looked through.
//!
//! What is committed may stand beside the file for a while (`-wal`): a copy of the file alone loses it. These go by what
//! SQLite reads of both.

use std::fs::File;
use std::path::{Path, PathBuf};

use sqlx::{AnyConnection, Connection, Row};

use super::StoreError;
use super::address::{connection, is_missing, path, without_password};
use super::engine::Engine;
use super::migrate;

/// What a database has, as it was looked through.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Contents {
    /// Of the schema.
    pub version: i64,
    pub jobs: u64,
    pub results: u64,
    pub maneuvers: u64,
    pub models: u64,
}

/// Writes the database at `address`, as it is at one moment, to a file that is not there yet. Those who work with it go on.
///
/// # Errors
/// It is none in a file, there is a file of that name, or what was written is not whole.
pub async fn back_up(address: &str, to: &Path) -> Result<Contents, StoreError> {
    is_in_a_file(address)?;
    let part = beside(to)?;
    copy(address, &part).await?;
    keep(&part, to).await
}

/// Puts a backup where the database at `address` is to be, which is not there yet.
///
/// # Errors
/// The backup is not whole, the address is none of a file, or there is a database.
pub async fn restore(backup: &Path, address: &str) -> Result<Contents, StoreError> {
    let from = utf8(backup)?;
    check(from).await?;
    is_in_a_file(address)?;
    let to = Path::new(path(address));
    let log = format!("{}-wal", path(address));
    if !is_missing(address) || Path::new(&log).exists() {
        return Err(refuse(
            to,
            "there is a database already; move it away, with what stands beside it (-wal, -shm), or name another",
        ));
    }
    let part = beside(to)?;
    // through the same door: what stands beside the backup belongs to it
    copy(from, &part).await?;
    keep(&part, to).await
}

async fn copy(address: &str, part: &Path) -> Result<(), StoreError> {
    let name = utf8(part)?;
    let mut from = open(address).await?;
    let written = sqlx::query("VACUUM INTO $1").bind(name);
    let written = written.execute(&mut from).await;
    from.close().await?;
    written.map(drop).map_err(|error| {
        // half of it is none
        let _ = std::fs::remove_file(part);
        refuse(part, &error.to_string())
    })
}

/// Looks through all of a database: whether every page and every reference is right, and what there is.
///
/// # Errors
/// It is none in a file, or something is wrong with it.
pub async fn check(address: &str) -> Result<Contents, StoreError> {
    let mut database = open(address).await?;
    let contents = look_through(&mut database).await;
    database.close().await?;
    let file = Path::new(path(address));
    contents.map_err(|error| match error {
        StoreError::Database(error) => refuse(file, &Engine::Sqlite.why_not_opened(&error)),
        StoreError::Corrupt { why, .. } => refuse(file, &format!("it is damaged ({why})")),
        error => error,
    })
}

async fn look_through(database: &mut AnyConnection) -> Result<Contents, StoreError> {
    let rows = sqlx::query("PRAGMA integrity_check(5)")
        .fetch_all(&mut *database)
        .await?;
    let found = rows.iter().map(|row| row.try_get::<String, _>(0));
    let found = found.collect::<Result<Vec<_>, _>>()?;
    if found != ["ok"] {
        return Err(StoreError::corrupt("the file", found.join("; ")));
    }
    let strays = sqlx::query("SELECT COUNT(*) AS n FROM pragma_foreign_key_check")
        .fetch_one(&mut *database)
        .await?;
    let strays: i64 = strays.try_get("n")?;
    if strays > 0 {
        let why = format!("{strays} rows refer to what is not there");
        return Err(StoreError::corrupt("the file", why));
    }
    let version = sqlx::query("SELECT MAX(version) AS version FROM schema_steps")
        .fetch_one(&mut *database)
        .await?;
    let version = version.try_get::<Option<i64>, _>("version")?.unwrap_or(0);
    if version > migrate::known() {
        return Err(StoreError::LaterVersion {
            reached: version,
            known: migrate::known(),
        });
    }
    let mut count = async |sql: &'static str| {
        let row = sqlx::query(sql).fetch_one(&mut *database).await?;
        Ok::<_, StoreError>(u64::try_from(row.try_get::<i64, _>("n")?).unwrap_or(0))
    };
    Ok(Contents {
        version,
        jobs: count("SELECT COUNT(*) AS n FROM jobs").await?,
        results: count("SELECT COUNT(DISTINCT job) AS n FROM results").await?,
        maneuvers: count("SELECT COUNT(*) AS n FROM maneuvers").await?,
        models: count("SELECT COUNT(*) AS n FROM models").await?,
    })
}

/// A database in a file, as it is: its schema is not brought up to date.
async fn open(address: &str) -> Result<AnyConnection, StoreError> {
    sqlx::any::install_default_drivers();
    let url = is_in_a_file(address)?;
    let file = Path::new(path(address));
    if is_missing(address) {
        return Err(refuse(file, "there is no such file"));
    }
    let opened = AnyConnection::connect(&url).await;
    opened.map_err(|error| refuse(file, &Engine::Sqlite.why_not_opened(&error)))
}

/// Where a file is written until it is whole.
fn beside(to: &Path) -> Result<PathBuf, StoreError> {
    if to.exists() {
        return Err(refuse(to, "there is a file of this name; name another"));
    }
    let mut name = to.as_os_str().to_os_string();
    name.push(".part");
    let part = PathBuf::from(name);
    // of a command that was broken off
    match std::fs::remove_file(&part) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(refuse(&part, &error.to_string()))
        }
        _ => Ok(part),
    }
}

/// Gives a file that was written its name, once it is on the disk and was looked through.
async fn keep(part: &Path, to: &Path) -> Result<Contents, StoreError> {
    let contents = check(utf8(part)?).await?;
    let settle = || {
        File::open(part)?.sync_all()?;
        std::fs::rename(part, to)?;
        let directory = to
            .parent()
            .filter(|directory| !directory.as_os_str().is_empty());
        File::open(directory.unwrap_or(Path::new(".")))?.sync_all()
    };
    settle().map_err(|error| refuse(to, &error.to_string()))?;
    Ok(contents)
}

fn utf8(file: &Path) -> Result<&str, StoreError> {
    file.to_str()
        .ok_or_else(|| refuse(file, "its path is not UTF-8"))
}

fn refuse(file: &Path, why: &str) -> StoreError {
    StoreError::Address {
        address: file.display().to_string(),
        why: why.to_string(),
    }
}

/// The driver's address of a database in a file.
fn is_in_a_file(address: &str) -> Result<String, StoreError> {
    match connection(address)? {
        (Engine::Sqlite, url) => Ok(url),
        (Engine::Postgres, _) => Err(StoreError::Address {
            address: without_password(address),
            why: "PostgreSQL has its own tools for this: pg_dump, pg_restore, pg_amcheck"
                .to_string(),
        }),
    }
}
