//! `/v1/jobs/{id}/derivative-study`: what a derivative study found.

use axum::http::HeaderMap;
use axum::response::Response;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::job;
use super::results::without_result;
use crate::estimate::study::DerivativeStudy;
use crate::http::answer::format::{Format, cacheable};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::JobId;
use crate::http::service::{Server, Service};
use crate::job::Status;
use crate::store::Part;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(get_derivative_study))
}

/// Derivative techniques compared on the job's problem, of jobs of the kind `derivative_study`.
#[utoipa::path(get, path = "/v1/jobs/{id}/derivative-study", tag = "Results", operation_id = "getDerivativeStudy",
    params(("id" = Uuid, Path)),
    responses(
        (status = 200, description = "The study.", body = DerivativeStudy),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_derivative_study(
    service: Service,
    JobId(id): JobId,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    if let Some(study) = service.store.result_part(id, Part::Study).await? {
        return Ok(cacheable(&headers, Format::Json, study));
    }
    let job = job::find(&service, id).await?;
    if job.status == Status::Succeeded {
        let detail =
            "the job is no derivative study; submit it again with \"kind\": \"derivative_study\"";
        return Err(Problem::new(Code::NoResult, detail));
    }
    Err(without_result(&job))
}
