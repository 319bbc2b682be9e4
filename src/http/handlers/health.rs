//! Whether the service is there, for those that start and watch it.

use axum::Json;
use axum::extract::State;
use serde::Serialize;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::http::problem::{Problem, ProblemDocument};
use crate::http::service::Server;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(live))
        .routes(routes!(ready))
}

/// That the service is there.
#[derive(Serialize, ToSchema)]
pub(crate) struct Health {
    /// `ok`; what is not is a problem instead.
    #[schema(example = "ok")]
    status: &'static str,
    /// The version of the program.
    #[schema(example = "0.1.0")]
    version: &'static str,
}

const OK: Health = Health {
    status: "ok",
    version: env!("CARGO_PKG_VERSION"),
};

/// Whether the process answers.
#[utoipa::path(get, path = "/health/live", tag = "Operations", operation_id = "live",
    responses((status = 200, description = "It does.", body = Health)))]
async fn live() -> Json<Health> {
    Json(OK)
}

/// Whether requests can be served: the store answers, and can be written.
#[utoipa::path(get, path = "/health/ready", tag = "Operations", operation_id = "ready",
    responses(
        (status = 200, description = "They can.", body = Health),
        (status = 503, description = "`store_unavailable`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 507, description = "`store_full`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn ready(State(server): State<Server>) -> Result<Json<Health>, Problem> {
    server.store.ping().await?;
    Ok(Json(OK))
}
