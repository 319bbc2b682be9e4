//! What integration tests share. Each test program uses a part of it.
#![allow(dead_code)]

pub mod flight_data;
pub mod process;
pub mod published_cases;
pub mod random_starts;
pub mod recordings;
pub mod server;
pub mod sse;
