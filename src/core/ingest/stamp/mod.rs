//! Time stamps, and the seconds between them.

mod calendar;
mod clock;
mod date;
mod stopwatch;
mod value;

pub(super) use stopwatch::Stopwatch;
pub(super) use value::Stamp;
