//! What integration tests share. Each test program uses a part of it.
#![allow(dead_code)]

pub mod flight_data;
pub mod published_cases;
