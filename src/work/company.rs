//! Which jobs run at the same time in this process (any, but beside one under suspicion none), and for how long.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::{OwnedRwLockReadGuard, OwnedRwLockWriteGuard, RwLock};

/// The workers of a process; clones are the same.
#[derive(Clone, Default)]
pub(super) struct Company {
    lock: Arc<RwLock<()>>,
    longest_job: Option<Duration>,
}

/// Leave to run a job, as long as it is kept.
pub(super) enum Seat {
    /// Others may run theirs beside it.
    Beside(#[expect(dead_code, reason = "it is held")] OwnedRwLockReadGuard<()>),
    /// Nobody else runs one.
    Alone(#[expect(dead_code, reason = "it is held")] OwnedRwLockWriteGuard<()>),
}

impl Company {
    pub(super) fn new(longest_job: Option<Duration>) -> Self {
        Self {
            lock: Arc::default(),
            longest_job,
        }
    }

    /// Returns when a job that begins now has taken as long as one may.
    pub(super) async fn time_is_up(&self) {
        match self.longest_job {
            Some(longest) => tokio::time::sleep(longest).await,
            None => std::future::pending().await,
        }
    }

    /// Waits as long as somebody runs, or waits to run, alone.
    pub(super) async fn beside(&self) -> Seat {
        Seat::Beside(self.lock.clone().read_owned().await)
    }

    /// Waits until nobody else runs anything. Who has a seat already gives it back first, or waits for itself.
    pub(super) async fn alone(&self) -> Seat {
        Seat::Alone(self.lock.clone().write_owned().await)
    }
}

#[cfg(test)]
mod tests {
    use tokio::time::timeout;

    use super::*;

    #[tokio::test]
    async fn one_alone_waits_for_the_others_and_they_for_it() {
        let company = Company::default();
        let soon = Duration::from_millis(20);
        let seats = (company.beside().await, company.beside().await);
        let other = company.clone();
        let alone = tokio::spawn(async move { other.alone().await });
        tokio::time::sleep(soon).await;
        assert!(!alone.is_finished());
        assert!(
            timeout(soon, company.beside()).await.is_err(),
            "it would wait for ever"
        );
        drop(seats);
        let alone = alone.await.unwrap();
        assert!(timeout(soon, company.beside()).await.is_err());
        drop(alone);
        assert!(timeout(soon, company.beside()).await.is_ok());
    }
}
