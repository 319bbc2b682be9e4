//! The service as those see it who use it: over HTTP, on the command line, in a browser, and while it is killed.
//! `tests/postgres tests/browser cargo test --test service`; one subject by its name, `cargo test --test service jobs::`.

#[path = "../common"]
mod common {
    pub(crate) mod browser;
    pub(crate) mod chain;
    pub(crate) mod chaos;
    pub(crate) mod chromedriver;
    pub(crate) mod database;
    pub(crate) mod filter_case;
    pub(crate) mod flight_data;
    pub(crate) mod jobs;
    pub(crate) mod layouts;
    pub(crate) mod preprocessing;
    pub(crate) mod process;
    pub(crate) mod published_cases;
    pub(crate) mod recordings;
    pub(crate) mod repository;
    pub(crate) mod server;
    pub(crate) mod sse;
    pub(crate) mod swinging;
}

mod abuse;
mod again;
mod api;
mod architecture;
mod backup;
mod bad_jobs;
mod before_flight;
mod chaos;
mod cli;
mod cli_client;
mod coefficients;
mod compare;
mod derivatives;
mod diagnosis;
mod dynamics;
mod edge_numbers;
mod events;
mod examples;
mod exports;
mod filter_error;
mod findings;
mod flown;
mod guide;
mod intervals;
mod jobs;
mod keys;
mod layouts;
mod lifecycle;
mod limits;
mod logs;
mod maneuvers;
mod mappings;
mod models;
mod names;
mod once;
mod pages;
mod predictions;
mod published_cases;
mod real_flights;
mod segments;
mod several;
mod structure;
mod two_step;
mod webhooks;
