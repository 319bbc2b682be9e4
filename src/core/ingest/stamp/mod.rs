//! Time stamps, and the seconds between them.

mod calendar;
mod clock;
mod date;
mod parts;
mod stopwatch;
mod value;

pub(super) use parts::PARTS;
pub(super) use stopwatch::Stopwatch;
pub(super) use value::Stamp;
