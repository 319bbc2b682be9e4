//! Trimtab estimates aircraft parameters from flight-test maneuvers.
pub mod flight;
pub mod ingest;
