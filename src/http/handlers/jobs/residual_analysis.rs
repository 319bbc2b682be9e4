//! `/v1/jobs/{id}/residual-analysis`: what the residuals of a finished job tell.

use axum::http::HeaderMap;
use axum::response::Response;
use serde::Serialize;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::job;
use super::results::without_result;
use crate::diagnose::{ResidualAnalysis, analyse};
use crate::estimate::Role;
use crate::http::answer::format::{Format, cacheable};
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::JobId;
use crate::http::service::{Server, Service};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(get_residual_analysis))
}

/// Of the segments that the model was fitted to.
#[derive(Serialize, ToSchema)]
struct ResidualAnalyses {
    /// By output, in the order of the model.
    outputs: Vec<ResidualAnalysis>,
}

/// By output: autocorrelation, correlation with the inputs, spectrum and coherence, distribution, outliers, a portmanteau
/// test of whiteness, and where in time the residual is largest.
#[utoipa::path(get, path = "/v1/jobs/{id}/residual-analysis", tag = "Results", operation_id = "getResidualAnalysis",
    params(("id" = Uuid, Path)),
    responses(
        (status = 200, description = "The analysis.", body = ResidualAnalyses),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_residual_analysis(
    service: Service,
    JobId(id): JobId,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let Some(mut histories) = service.store.histories(id).await? else {
        return Err(without_result(&job::find(&service, id).await?));
    };
    let analysis = move || {
        histories.retain(|history| history.role == Role::Estimation);
        let outputs = analyse(&histories);
        let body = serde_json::to_vec(&ResidualAnalyses { outputs })?;
        Ok(cacheable(&headers, Format::Json, body))
    };
    service.compute.run(analysis).await?
}
