//! What integration tests share.

pub mod flight_data;
pub mod published_cases;
