//! What answers a request: a file for each resource. Those of jobs, which are many, have a folder.

pub(super) mod compare;
pub(super) mod health;
pub(super) mod jobs;
pub(super) mod keys;
pub(super) mod maneuvers;
pub(super) mod mappings;
pub(super) mod models;

mod audit;
mod campaigns;
mod designs;
mod fitted_jobs;
mod flown;
mod frequency_responses;
mod maneuver_data;
mod metrics;
mod problems;
mod retention;
mod segments;
mod several;
mod simulations;
mod trims;
mod webhooks;

use utoipa_axum::router::OpenApiRouter;

use super::service::Server;

/// All of them, in the order of the OpenAPI document.
pub(super) fn api() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .merge(maneuvers::router())
        .merge(flown::router())
        .merge(maneuver_data::router())
        .merge(segments::router())
        .merge(frequency_responses::router())
        .merge(mappings::router())
        .merge(models::router())
        .merge(simulations::router())
        .merge(trims::router())
        .merge(designs::router())
        .merge(jobs::submit::router())
        .merge(jobs::bulk::router())
        .merge(jobs::rerun::router())
        .merge(retention::router())
        .merge(audit::router())
        .merge(jobs::job::router())
        .merge(jobs::events::router())
        .merge(jobs::results::router())
        .merge(jobs::findings::router())
        .merge(jobs::iterations::router())
        .merge(jobs::coefficients::router())
        .merge(jobs::histories::router())
        .merge(jobs::residual_analysis::router())
        .merge(jobs::trajectories::router())
        .merge(jobs::corrected::router())
        .merge(jobs::predictions::router())
        .merge(jobs::source_code::router())
        .merge(jobs::simulator_model::router())
        .merge(campaigns::router())
        .merge(compare::router())
        .merge(jobs::dynamics::router())
        .merge(problems::router())
        .merge(keys::router())
        .merge(webhooks::router())
        .merge(metrics::router())
        .merge(health::router())
}
