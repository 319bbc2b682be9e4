//! What handlers work with.

use std::sync::Arc;

use tokio_util::sync::CancellationToken;

use super::caller::Caller;
use super::compute::Compute;
use super::config::Config;
use super::metrics::Metrics;
use super::rates::Rates;
use super::room::Room;
use crate::store::{Project, Store};

/// What all requests share.
#[derive(Clone)]
pub(super) struct Server {
    pub(super) store: Store,
    pub(super) config: Arc<Config>,
    pub(super) compute: Compute,
    pub(super) metrics: Metrics,
    pub(super) rates: Rates,
    pub(super) room: Room,
    /// Ends what would not end by itself.
    pub(super) shutdown: CancellationToken,
}

/// What a handler has: the server as the caller sees it, with the caller's own project for a store.
#[derive(Clone)]
pub(super) struct Service {
    pub(super) store: Project,
    pub(super) caller: Caller,
    pub(super) config: Arc<Config>,
    pub(super) compute: Compute,
    pub(super) metrics: Metrics,
    pub(super) room: Room,
    pub(super) shutdown: CancellationToken,
}

impl Service {
    pub(super) fn of(server: &Server, caller: Caller) -> Self {
        Self {
            store: server.store.project(&caller.project, &caller.submitter()),
            caller,
            config: server.config.clone(),
            compute: server.compute.clone(),
            metrics: server.metrics.clone(),
            room: server.room.clone(),
            shutdown: server.shutdown.clone(),
        }
    }
}
