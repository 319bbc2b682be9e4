//! A recording that was read, and what was odd about the way in which it is written.

use super::Origin;
use crate::flight::{Finding, Maneuver};

/// A maneuver, and what its file had that is told and no fault: columns that were left out, lines that were passed over.
#[derive(Clone, PartialEq, Debug)]
pub struct Reading {
    /// What was read.
    pub maneuver: Maneuver,
    /// What is odd about the file. What is odd about the data is told by [`quality()`](super::quality()).
    pub findings: Vec<Finding>,
    /// What the zero of its time is; `None` where it cannot be told. Several files become one by it.
    pub origin: Option<Origin>,
}

impl From<Maneuver> for Reading {
    fn from(maneuver: Maneuver) -> Self {
        Self {
            maneuver,
            findings: Vec::new(),
            origin: Some(Origin::OWN),
        }
    }
}
