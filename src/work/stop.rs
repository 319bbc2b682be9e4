//! How a running job is told to stop, and how long that may take.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::Duration;

use tokio::time::{sleep, timeout};
use tokio_util::sync::CancellationToken;

use crate::stop::StopFlag;

/// How long a cancelled job may take to make a result of its best iterate.
const WIND_UP: Duration = Duration::from_millis(600);

/// How long it may take where nobody waits for it: a job that has taken as long as one may is to show for it what it can.
const LEISURE: Duration = Duration::from_secs(30);

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
    /// The job has taken as long as one may: what there is of a result is kept.
    Budget = 4,
}

/// One wish for the solver's threads and those that watch over them. The first reason stands, but that time is up, for
/// which nobody waits, gives way to any other.
#[derive(Clone, Default)]
pub(super) struct Stop {
    reason: Arc<AtomicU8>,
    flag: StopFlag,
    asked: CancellationToken,
    hurried: CancellationToken,
    overdue: CancellationToken,
}

impl Stop {
    pub(super) fn ask(&self, reason: Reason) {
        let gives_way = |before: u8| before == 0 || before == Reason::Budget as u8;
        let to = |before| gives_way(before).then_some(reason as u8);
        let _ = (self.reason).fetch_update(Ordering::Relaxed, Ordering::Relaxed, to);
        self.flag.wind_up();
        self.asked.cancel();
        if reason != Reason::Budget {
            self.hurried.cancel();
        }
    }

    pub(super) fn asked(&self) -> Option<Reason> {
        use Reason::{Budget, Cancel, LeaseLost, Shutdown};
        [Cancel, Shutdown, LeaseLost, Budget]
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
        let _ = timeout(LEISURE, self.hurried.cancelled()).await;
        // nobody is to read a result of the others
        if self.asked() == Some(Reason::Cancel) {
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
    use tokio::time::Instant;

    use super::*;

    #[test]
    fn the_first_reason_stands() {
        let stop = Stop::default();
        assert_eq!(stop.asked(), None);
        stop.clone().ask(Reason::Cancel);
        stop.ask(Reason::Shutdown);
        assert_eq!(stop.asked(), Some(Reason::Cancel));
        stop.ask(Reason::Budget);
        assert_eq!(stop.asked(), Some(Reason::Cancel));
    }

    #[test]
    fn that_time_is_up_gives_way_to_who_asks() {
        let stop = Stop::default();
        stop.ask(Reason::Budget);
        assert_eq!(stop.asked(), Some(Reason::Budget));
        stop.ask(Reason::Cancel);
        assert_eq!(stop.asked(), Some(Reason::Cancel));
    }

    /// How long somebody waits for a solver that does not hear.
    async fn pressed(stop: &Stop) -> Duration {
        let begun = Instant::now();
        tokio::select! {
            never = stop.press() => match never {},
            () = stop.overdue() => begun.elapsed(),
        }
    }

    #[tokio::test]
    async fn who_is_asked_to_cancel_may_wind_up_and_is_pressed_then() {
        for (reason, most) in [
            (Reason::Cancel, WIND_UP + PATIENCE),
            (Reason::Shutdown, PATIENCE),
            (Reason::LeaseLost, PATIENCE),
        ] {
            let stop = Stop::default();
            stop.ask(reason);
            let took = pressed(&stop).await;
            assert!(took >= most, "{reason:?}: {took:?}");
            assert!(took < LEISURE / 2, "{reason:?}: {took:?}");
        }
    }

    #[tokio::test]
    async fn whose_time_is_up_is_hurried_by_who_asks() {
        let stop = Stop::default();
        stop.ask(Reason::Budget);
        let at_leisure = timeout(2 * (WIND_UP + PATIENCE), pressed(&stop)).await;
        assert!(at_leisure.is_err(), "{at_leisure:?}");
        stop.ask(Reason::Shutdown);
        let took = pressed(&stop).await;
        assert!(took < LEISURE / 2, "{took:?}");
    }
}
