//! What the service lets its users do, in numbers.

use super::origin::Origin;
use crate::ingest;
use crate::webhook::Allowed;

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
    /// Connections at a time; those beyond are told that the service is busy.
    pub max_connections: usize,
    /// Connections of one address at a time; 0: as many as there are.
    pub max_connections_per_peer: usize,
    /// Whether a proxy stands before the service that says by which host and protocol it was asked.
    pub trusts_proxy: bool,
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
            max_connections_per_peer: 512,
            trusts_proxy: false,
            max_queued: 20_000,
            max_queued_per_key: 10_000,
            max_requests_per_second: 200,
            max_stored_bytes: 100_000_000_000,
            webhooks: Allowed::default(),
            origins: Vec::new(),
        }
    }
}
