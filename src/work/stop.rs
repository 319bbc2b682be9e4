//! The flag that a running solver asks between iterations.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

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

/// One flag for the solver's thread and those that watch over it. The first reason stands.
#[derive(Clone, Default)]
pub(super) struct Stop(Arc<AtomicU8>);

impl Stop {
    pub(super) fn ask(&self, reason: Reason) {
        let none = 0;
        let _ = self
            .0
            .compare_exchange(none, reason as u8, Ordering::Relaxed, Ordering::Relaxed);
    }

    pub(super) fn asked(&self) -> Option<Reason> {
        use Reason::{Budget, Cancel, LeaseLost, Shutdown};
        [Cancel, Shutdown, LeaseLost, Budget]
            .into_iter()
            .find(|reason| *reason as u8 == self.0.load(Ordering::Relaxed))
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
}
