//! Recordings that are read: `cargo test --test ingest`.

#[path = "../common"]
mod common {
    pub(crate) mod flight_data;
    pub(crate) mod layouts;
    pub(crate) mod repository;
}

mod ames;
mod corruptions;
mod findings;
mod flight_data;
mod formats;
mod hdf5;
mod kinds;
mod layouts;
mod mdf4;
mod mutations;
mod newcomers;
mod octave;
mod parquet;
mod programs;
mod structs;
mod tdms;
mod text_logs;
mod times;
