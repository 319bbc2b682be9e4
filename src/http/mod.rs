//! The API: JSON and CSV over HTTP, one file for each resource.
//!
//! A handler reads its request, asks the store or the core, and answers. It never waits for a job
//! and never runs long itself: reading recordings and checking models happens on blocking threads, as
//! many at a time as there are cores. What goes wrong is a [`problem::Problem`] with a [`code::Code`].

mod body;
mod bulk;
mod caller;
pub mod code;
mod coefficients;
mod compute;
mod csv;
mod decimate;
mod diagnosis;
mod drain;
mod events;
mod format;
mod headers;
mod health;
mod histories;
mod jobs;
mod json;
mod keys;
mod maneuvers;
mod mappings;
mod metrics;
mod models;
mod once;
mod openapi;
mod pages;
mod prefer;
pub mod problem;
mod problems;
mod query;
mod rates;
mod rerun;
mod residual_analysis;
mod results;
mod retention;
mod routes;
mod serve;
mod study;
mod submit;
mod webhooks;

use std::sync::Arc;

use tokio_util::sync::CancellationToken;

use crate::ingest;
use crate::store::{Project, Store};
use crate::webhook::Allowed;

pub use headers::Origin;
pub use keys::{a_day, days};
pub use openapi::document;
pub use serve::{BindError, bind, is_loopback, run};

/// The bounds of the API.
#[derive(Clone, PartialEq, Debug)]
pub struct Config {
    /// Bytes of an uploaded recording.
    pub max_maneuver_body: usize,
    /// Bytes of a job or a model.
    pub max_json_body: usize,
    /// Bytes of all bodies that are on their way in at a time, and being read.
    pub max_body_memory: usize,
    /// What a recording may hold.
    pub recording: ingest::Limits,
    /// Values (samples times channels, time included) that the maneuvers of one job may hold.
    pub max_job_values: usize,
    /// Connections at a time; those beyond wait.
    pub max_connections: usize,
    /// Jobs that wait, of everybody; beyond, submissions are refused for the time being.
    pub max_queued: usize,
    /// Jobs that wait, of one key.
    pub max_queued_per_key: usize,
    /// Requests of a key in a second, and twice as many at once; 0: as many as it will.
    pub max_requests_per_second: u32,
    /// Bytes that the maneuvers of a project may take.
    pub max_stored_bytes: u64,
    /// Where webhooks may lead.
    pub webhooks: Allowed,
    /// Other sites whose pages may use the service from a browser.
    pub origins: Vec<Origin>,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            max_maneuver_body: 100_000_000,
            max_json_body: 2_000_000,
            max_body_memory: 1_000_000_000,
            recording: ingest::Limits::default(),
            max_job_values: 100_000_000,
            max_connections: 1024,
            max_queued: 20_000,
            max_queued_per_key: 10_000,
            max_requests_per_second: 200,
            max_stored_bytes: 100_000_000_000,
            webhooks: Allowed::default(),
            origins: Vec::new(),
        }
    }
}

/// What all requests share.
#[derive(Clone)]
pub struct Server {
    store: Store,
    config: Arc<Config>,
    compute: compute::Compute,
    metrics: metrics::Metrics,
    rates: rates::Rates,
    room: body::Room,
    /// Ends what would not end by itself.
    shutdown: CancellationToken,
}

/// What a handler has: the server as the caller sees it, with the caller's own project for a store.
#[derive(Clone)]
pub struct Service {
    store: Project,
    caller: caller::Caller,
    config: Arc<Config>,
    compute: compute::Compute,
    metrics: metrics::Metrics,
    room: body::Room,
    shutdown: CancellationToken,
}
