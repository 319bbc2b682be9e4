//! What integration tests share. Each test program uses a part of it.
#![allow(dead_code)]

pub mod browser;
pub mod chaos;
pub mod database;
pub mod estimation;
pub mod filter_case;
pub mod flight_data;
pub mod plans;
pub mod preprocessing;
pub mod printed_adjoint;
pub mod process;
pub mod published_cases;
pub mod random_starts;
pub mod recordings;
pub mod server;
pub mod sse;
pub mod study_problems;
