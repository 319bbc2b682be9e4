//! Time stamps, and the seconds between them.

mod calendar;
mod clock;
mod date;
mod parts;
mod stopwatch;
mod value;

pub(super) use clock::{DAY, HOUR};
pub(super) use parts::PARTS;
pub(super) use stopwatch::Stopwatch;
pub(super) use value::{ClockKind, Stamp};
