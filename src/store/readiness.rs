//! Whether the database can be written, found out by writing to it.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::Mutex;
use tokio::time::{Instant, timeout};

use super::error::{StoreError, Trouble};

/// A probe that takes longer is of a database that does not answer: who asks is answered within 2 s.
const PROBE: Duration = Duration::from_millis(1500);

/// How long an answer is good: however many ask, the database is asked once.
const GOOD_FOR: Duration = Duration::from_secs(1);

/// What the last probe came to; clones share it.
#[derive(Clone, Default)]
pub(super) struct Readiness(Arc<Mutex<Option<Probed>>>);

struct Probed {
    at: Instant,
    found: Result<(), NotWritten>,
}

/// Why a probe was not written, so that it can be told to several.
#[derive(Clone)]
struct NotWritten {
    trouble: Option<Trouble>,
    why: String,
}

impl Readiness {
    /// What the last probe found, or `probe` finds. Those who ask while it is under way wait for it and share what it finds.
    ///
    /// # Errors
    /// What was probed for was not written, or not in time.
    pub(super) async fn known_or(
        &self,
        probe: impl Future<Output = sqlx::Result<()>>,
    ) -> Result<(), StoreError> {
        let mut last = self.0.lock().await;
        let found = match last.as_ref() {
            Some(probed) if probed.at.elapsed() < GOOD_FOR => probed.found.clone(),
            _ => {
                let in_time = timeout(PROBE, probe).await;
                let found = in_time.unwrap_or(Err(sqlx::Error::PoolTimedOut));
                let found = found.map_err(NotWritten::of);
                let at = Instant::now();
                last.insert(Probed { at, found }).found.clone()
            }
        };
        found.map_err(|NotWritten { trouble, why }| StoreError::NotWritten { trouble, why })
    }
}

impl NotWritten {
    fn of(error: sqlx::Error) -> Self {
        let error = StoreError::from(error);
        Self {
            trouble: error.trouble(),
            why: error.to_string(),
        }
    }
}
