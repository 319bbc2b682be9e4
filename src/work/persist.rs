//! Writing to the store in spite of passing trouble.

use std::time::Duration;

use crate::store::{LEASE, StoreError};

/// Passing trouble is waited out this long: nobody else can take the job over while the database is away.
const PATIENCE: Duration = Duration::from_secs(600);

/// Tries again while the database is in trouble (away, locked, disk full); what else a database objects to, as long as a
/// lease lasts. That the lease is lost, or that there is no way to write what is to be written, is final.
///
/// # Errors
/// The last one met.
pub(super) async fn persist<T, F>(what: &str, mut write: impl FnMut() -> F) -> Result<T, StoreError>
where
    F: Future<Output = Result<T, StoreError>>,
{
    let start = tokio::time::Instant::now();
    let mut pause = Duration::from_millis(50);
    let patience = |error: &StoreError| match error {
        _ if error.is_passing() => PATIENCE,
        StoreError::Database(_) => LEASE,
        _ => Duration::ZERO,
    };
    loop {
        match write().await {
            Err(error) if start.elapsed() + pause < patience(&error) => {
                tracing::warn!(%error, what, "the store is in trouble; trying again");
                tokio::time::sleep(pause).await;
                pause = (pause * 2).min(Duration::from_secs(2));
            }
            result => return result,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn passing_trouble_passes_and_a_lost_lease_does_not() {
        let mut tries = 0;
        let locked_twice = || {
            tries += 1;
            let trouble = StoreError::Database(sqlx::Error::PoolTimedOut);
            std::future::ready(if tries < 3 { Err(trouble) } else { Ok(tries) })
        };
        assert!(matches!(persist("test", locked_twice).await, Ok(3)));

        let mut tries = 0;
        let lost = || {
            tries += 1;
            std::future::ready(Err::<(), _>(StoreError::LeaseLost))
        };
        let result = persist("test", lost).await;
        assert!(matches!(result, Err(StoreError::LeaseLost)));
        assert_eq!(tries, 1);
    }
}
