//! What integration tests share.

pub mod flight_data;
