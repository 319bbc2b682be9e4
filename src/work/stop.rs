//! How a running job is told to stop, and how long that may take.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::Duration;

use tokio::time::sleep;
use tokio_util::sync::CancellationToken;

use crate::stop::StopFlag;

/// How long a cancelled job may take to make a result of its best iterate.
const WIND_UP: Duration = Duration::from_millis(600);

/// How long a solver may take to drop everything; it is not waited for any longer.
const PATIENCE: Duration = Duration::from_millis(200);

/// Why a solver should stop.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Reason {
    /// Somebody asked to cancel the job: what there is of a result is kept.
    Cancel = 1,
    /// The process ends: the job goes back to the queue.
    Shutdown = 2,
    /// The job has another worker: nothing may be written any more.
    LeaseLost = 3,
}

/// One wish for the solver's threads and those that watch over them. The first reason stands.
#[derive(Clone, Default)]
pub(super) struct Stop {
    reason: Arc<AtomicU8>,
    flag: StopFlag,
    asked: CancellationToken,
    overdue: CancellationToken,
}

impl Stop {
    pub(super) fn ask(&self, reason: Reason) {
        let none = 0;
        let _ =
            self.reason
                .compare_exchange(none, reason as u8, Ordering::Relaxed, Ordering::Relaxed);
        self.flag.wind_up();
        self.asked.cancel();
    }

    pub(super) fn asked(&self) -> Option<Reason> {
        [Reason::Cancel, Reason::Shutdown, Reason::LeaseLost]
            .into_iter()
            .find(|reason| *reason as u8 == self.reason.load(Ordering::Relaxed))
    }

    /// What the solver's loops ask.
    pub(super) fn flag(&self) -> &StopFlag {
        &self.flag
    }

    /// Presses those who were asked; to be polled beside what they do.
    pub(super) async fn press(&self) -> Infallible {
        self.asked.cancelled().await;
        // nobody is to read a result of the others
        if !matches!(self.asked(), Some(Reason::Shutdown | Reason::LeaseLost)) {
            sleep(WIND_UP).await;
        }
        self.flag.end();
        sleep(PATIENCE).await;
        self.overdue.cancel();
        std::future::pending().await
    }

    /// Until nobody waits for the solver any longer: it is in a place where it cannot be told.
    pub(super) async fn overdue(&self) {
        self.overdue.cancelled().await;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_reason_stands() {
        let stop = Stop::default();
        assert_eq!(stop.asked(), None);
        stop.clone().ask(Reason::Cancel);
        stop.ask(Reason::Shutdown);
        assert_eq!(stop.asked(), Some(Reason::Cancel));
    }

    #[tokio::test]
    async fn who_is_asked_to_cancel_may_wind_up_and_is_pressed_then() {
        for (reason, winds_up) in [(Reason::Cancel, true), (Reason::Shutdown, false)] {
            let stop = Stop::default();
            stop.ask(reason);
            let begun = tokio::time::Instant::now();
            tokio::select! {
                never = stop.press() => match never {},
                () = stop.overdue() => {}
            }
            let most = if winds_up {
                WIND_UP + PATIENCE
            } else {
                PATIENCE
            };
            let took = begun.elapsed();
            assert!(
                took >= most && took < most + Duration::from_secs(2),
                "{took:?}"
            );
        }
    }
}
