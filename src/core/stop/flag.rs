//! The flag itself: how urgent the wish is.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// Nobody wants the work to stop.
const NOT_ASKED: u8 = 0;
/// What is begun of the next iterate is dropped; what there is may be put together.
pub(super) const WIND_UP: u8 = 1;
/// Everything is dropped.
pub(super) const END: u8 = 2;
/// Beside the urgency: somebody listens to how work goes along.
const HEARD: u8 = 0x80;

/// The work was dropped before it had come to a result.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("stopped on request before there was a result")]
pub struct Interrupted;

/// What a thread does with a flag.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Moment {
    /// It begins work that heeds the flag.
    Begins,
    /// Its work asks whether it is to end.
    Asks,
    /// It leaves that work, done or dropped.
    Leaves,
}

/// Is told what threads do, each on its own thread.
type Listener = Box<dyn Fn(&StopFlag, Moment) + Send + Sync>;

/// One flag for those who may stop some work and for the threads that do it. A wish once told is never taken back.
#[derive(Clone, Default)]
pub struct StopFlag(Arc<State>);

#[derive(Default)]
struct State {
    urgency: AtomicU8,
    listener: Option<Listener>,
}

impl StopFlag {
    /// A flag whose listener is told each time a thread asks: how long work goes on between two asks is how long it may
    /// go on when it is to end.
    pub fn heard_by(listener: impl Fn(&Self, Moment) + Send + Sync + 'static) -> Self {
        Self(Arc::new(State {
            urgency: AtomicU8::new(HEARD),
            listener: Some(Box::new(listener)),
        }))
    }

    /// Asks to stop soon: an iteration under way is dropped, and a result is made of the best iterate.
    pub fn wind_up(&self) {
        self.ask(WIND_UP);
    }

    /// Asks to stop at once, without a result.
    pub fn end(&self) {
        self.ask(END);
    }

    fn ask(&self, urgency: u8) {
        let heard = self.0.urgency.load(Ordering::Relaxed) & HEARD;
        self.0.urgency.fetch_max(heard | urgency, Ordering::Relaxed);
    }

    /// Whether there is a wish to stop.
    pub fn is_asked(&self) -> bool {
        self.urgency() > NOT_ASKED
    }

    pub(super) fn urgency(&self) -> u8 {
        self.0.urgency.load(Ordering::Relaxed) & !HEARD
    }

    /// Whether work that ends at an urgency may have to, or somebody listens: one look decides that nothing is to be done.
    #[inline]
    pub(super) fn may_reach(&self, urgency: u8) -> bool {
        self.0.urgency.load(Ordering::Relaxed) >= urgency
    }

    pub(super) fn tell(&self, moment: Moment) {
        if let Some(listener) = &self.0.listener {
            listener(self, moment);
        }
    }
}

impl fmt::Debug for StopFlag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("StopFlag").field(&self.urgency()).finish()
    }
}
