//! How much a recording may hold. Every bound is named in its fault.

use super::{code, fault::of_file};
use crate::flight::Fault;

/// Bounds of a recording.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Limits {
    /// Columns, time included.
    pub max_columns: usize,
    /// Samples (rows).
    pub max_samples: usize,
    /// Values in all: rows times columns.
    pub max_values: usize,
    /// Bytes of a channel's name.
    pub max_name_length: usize,
    /// Bytes of a file that comes packed, once it is unpacked.
    pub max_bytes: usize,
}

impl Default for Limits {
    /// Room for six hours of 25 Hz on every channel of a large aircraft, or of 100 Hz on some 20.
    fn default() -> Self {
        Self {
            max_columns: 2000,
            max_samples: 2_000_000,
            max_values: 50_000_000,
            max_name_length: 128,
            max_bytes: 1_000_000_000,
        }
    }
}

impl Limits {
    pub(super) fn columns(&self, found: usize) -> Option<Fault> {
        (found > self.max_columns).then(|| {
            of_file(
                code::TOO_MANY_COLUMNS,
                format!(
                    "{found} columns are more than max_columns = {}; leave out channels that the estimation does not need",
                    self.max_columns
                ),
            )
        })
    }

    pub(super) fn samples(&self, found: usize) -> Option<Fault> {
        (found > self.max_samples).then(|| {
            of_file(
                code::TOO_MANY_SAMPLES,
                format!(
                    "{found} samples are more than max_samples = {}; upload the maneuvers of the flight one by one, or at a lower rate",
                    self.max_samples
                ),
            )
        })
    }

    pub(super) fn values(&self, found: usize) -> Option<Fault> {
        (found > self.max_values).then(|| {
            of_file(
                code::TOO_MANY_VALUES,
                format!(
                    "{found} values are more than max_values = {}; leave out channels, or upload a shorter part",
                    self.max_values
                ),
            )
        })
    }
}
