//! The flag itself: how urgent the wish is.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// Nobody wants the work to stop.
const NOT_ASKED: u8 = 0;
/// What is begun of the next iterate is dropped; what there is may be put together.
pub(super) const WIND_UP: u8 = 1;
/// Everything is dropped.
pub(super) const END: u8 = 2;

/// The work was dropped before it had come to a result.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("stopped on request before there was a result")]
pub struct Interrupted;

/// One flag for those who may stop some work and for the threads that do it. A wish once told is never taken back.
#[derive(Clone, Debug, Default)]
pub struct StopFlag(Arc<AtomicU8>);

impl StopFlag {
    /// Asks to stop soon: an iteration under way is dropped, and a result is made of the best iterate.
    pub fn wind_up(&self) {
        self.0.fetch_max(WIND_UP, Ordering::Relaxed);
    }

    /// Asks to stop at once, without a result.
    pub fn end(&self) {
        self.0.fetch_max(END, Ordering::Relaxed);
    }

    /// Whether there is a wish to stop.
    pub fn is_asked(&self) -> bool {
        self.urgency() > NOT_ASKED
    }

    pub(super) fn urgency(&self) -> u8 {
        self.0.load(Ordering::Relaxed)
    }
}
