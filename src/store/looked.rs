//! When this process looked for work last: whether it was cut off from the database, and what leases tell then.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A process that has not looked for so long may have been cut off from the database, and others with it.
const CUT_OFF: Duration = Duration::from_secs(8);

/// How long others then have to say that they live, before their leases tell that they do not.
const GRACE: Duration = Duration::from_secs(15);

/// When this process looked last; clones share it.
#[derive(Clone, Default)]
pub(super) struct Looked(Arc<Mutex<State>>);

#[derive(Default)]
struct State {
    last: Option<Instant>,
    grace_until: Option<Instant>,
}

impl Looked {
    /// The database has answered. Whether a lease that has run out tells of a worker that is lost: not in the first moments
    /// after the database was away.
    pub(super) fn tells(&self, now: Instant) -> bool {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let was_cut_off = state.last.is_some_and(|last| now - last > CUT_OFF);
        if was_cut_off {
            state.grace_until = Some(now + GRACE);
        }
        state.last = Some(now);
        state.grace_until.is_none_or(|until| now >= until)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn after_an_outage_others_have_a_moment_to_say_that_they_live() {
        let looked = Looked::default();
        let start = Instant::now();
        let at = |seconds: u64| looked.tells(start + Duration::from_secs(seconds));
        assert!(at(0) && at(1) && at(8));
        // away for 20 s
        assert!(!at(28) && !at(35) && !at(42));
        assert!(at(43) && at(44));
    }
}
