//! Trimtab estimates aircraft parameters from flight-test maneuvers.
pub mod estimate;
pub mod flight;
pub mod job;
pub mod model;
pub mod simulate;
