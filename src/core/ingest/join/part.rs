//! A file of several that are one recording.

use super::super::Reading;

/// A file of several that are one recording.
pub struct Part {
    /// What the file is called.
    pub name: String,
    /// What was read of it.
    pub reading: Reading,
    /// Seconds that are added to its times, once the zeros of the files are put together. It must be said where their clocks
    /// are of different kinds.
    pub offset: Option<f64>,
}
