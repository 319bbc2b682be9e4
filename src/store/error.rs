//! What may go wrong with the store.

/// What went wrong.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    #[error("the database '{address}' cannot be used: {why}")]
    Address { address: String, why: String },
    #[error(
        "the database is of a later version of Trimtab (schema {reached}, this one knows {known}); use that version, or another database"
    )]
    LaterVersion { reached: i64, known: i64 },
    #[error("database: {0}")]
    Database(#[from] sqlx::Error),
    #[error("{what} in the database cannot be read: {why}")]
    Corrupt { what: String, why: String },
    #[error("{what} cannot be written: {why}")]
    Unwritable { what: String, why: String },
    #[error("the lease of the job was lost to another worker")]
    LeaseLost,
    #[error("the database does not take a write: {why}")]
    NotWritten {
        trouble: Option<Trouble>,
        why: String,
    },
    /// By its number among those submitted together, and the maneuver's place in it.
    #[error("maneuver {place} of job {job} is not there any more")]
    ManeuverGone { job: usize, place: usize },
}

/// Trouble of a database that may pass, with nothing wrong with what was asked of it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Trouble {
    /// It does not answer, or another has locked it.
    Away,
    /// It has no room left.
    Full,
    /// It can be read, and not written.
    ReadOnly,
}

impl StoreError {
    /// Whether it is the database that does not answer, and the same may well go through in a while.
    pub fn is_passing(&self) -> bool {
        self.trouble().is_some()
    }

    /// What the database is troubled by, if it is.
    pub fn trouble(&self) -> Option<Trouble> {
        use sqlx::Error::{Io, PoolClosed, PoolTimedOut, Protocol, Tls, WorkerCrashed};
        match self {
            Self::Database(
                Io(_) | PoolClosed | PoolTimedOut | Protocol(_) | Tls(_) | WorkerCrashed,
            ) => Some(Trouble::Away),
            Self::Database(sqlx::Error::Database(error)) => {
                error.code().and_then(|code| Trouble::of_code(&code))
            }
            Self::NotWritten { trouble, .. } => *trouble,
            _ => None,
        }
    }

    pub(super) fn corrupt(what: impl Into<String>, why: impl ToString) -> Self {
        Self::Corrupt {
            what: what.into(),
            why: why.to_string(),
        }
    }
}

impl Trouble {
    /// PostgreSQL's codes have five characters; SQLite's are numbers, the kind in the lowest byte.
    fn of_code(code: &str) -> Option<Self> {
        if code.len() == 5 {
            return match code {
                // read-only transaction: a standby
                "25006" => Some(Self::ReadOnly),
                "53100" => Some(Self::Full),
                // connections, resources, operator's intervention (shutting down, starting up), serialisation, I/O
                _ => ["08", "53", "57", "58", "40"]
                    .iter()
                    .any(|class| code.starts_with(class))
                    .then_some(Self::Away),
            };
        }
        match code.parse::<u32>().ok()? & 0xff {
            SQLITE_BUSY | SQLITE_LOCKED | SQLITE_IOERR => Some(Self::Away),
            SQLITE_FULL => Some(Self::Full),
            SQLITE_READONLY => Some(Self::ReadOnly),
            _ => None,
        }
    }
}

/// Another process holds the file.
const SQLITE_BUSY: u32 = 5;
/// Another connection holds the table.
const SQLITE_LOCKED: u32 = 6;
/// The file may not be written.
const SQLITE_READONLY: u32 = 8;
/// The disk failed.
const SQLITE_IOERR: u32 = 10;
/// The disk is full.
const SQLITE_FULL: u32 = 13;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trouble_is_told_from_defects_by_code() {
        let expected = [
            ("5", Some(Trouble::Away)),
            // SQLITE_BUSY_SNAPSHOT, SQLITE_IOERR_WRITE, SQLITE_READONLY_DIRECTORY
            ("517", Some(Trouble::Away)),
            ("778", Some(Trouble::Away)),
            ("1544", Some(Trouble::ReadOnly)),
            ("13", Some(Trouble::Full)),
            ("53100", Some(Trouble::Full)),
            ("53300", Some(Trouble::Away)),
            ("57P03", Some(Trouble::Away)),
            ("25006", Some(Trouble::ReadOnly)),
            // constraints, syntax
            ("19", None),
            ("1", None),
            ("23505", None),
            ("42601", None),
        ];
        for (code, trouble) in expected {
            assert_eq!(Trouble::of_code(code), trouble, "{code}");
        }
    }
}
