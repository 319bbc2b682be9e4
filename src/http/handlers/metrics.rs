//! `/metrics`: what the service does, in the format of Prometheus.

use axum::extract::State;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::http::problem::Problem;
use crate::http::service::Server;

pub(super) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(get_metrics))
}

const MEDIA_TYPE: &str = "application/openmetrics-text; version=1.0.0; charset=utf-8";

/// What the service does, for Prometheus.
///
/// Requests and event streams are those of this process; jobs are those of all machines: how many there are by status, how
/// long they wait and run, and how they ended (of those that failed, the code of the fault).
#[utoipa::path(get, path = "/metrics", tag = "Operations", operation_id = "getMetrics",
    responses((status = 200, description = "OpenMetrics text.", body = String, content_type = "application/openmetrics-text")))]
async fn get_metrics(State(server): State<Server>) -> Result<Response, Problem> {
    let jobs = server.store.census().await?;
    let text = server.metrics.written(jobs).map_err(|error| {
        tracing::error!(%error, "metrics");
        Problem::internal()
    })?;
    Ok(([(header::CONTENT_TYPE, MEDIA_TYPE)], text).into_response())
}
