//! `/v1/jobs/{id}/diagnosis`: what the model of a job lacks, and what its residuals tell.

use axum::http::HeaderMap;
use axum::response::Response;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::job;
use super::results::without_result;
use crate::diagnose::Diagnosis;
use crate::http::answer::format::{Format, cacheable};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::JobId;
use crate::http::service::{Server, Service};
use crate::job::Status;
use crate::store::Part;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(get_diagnosis))
}

/// What the declared model lacks, of jobs of the kind `diagnose`.
#[utoipa::path(get, path = "/v1/jobs/{id}/diagnosis", tag = "Results", operation_id = "getDiagnosis",
    params(("id" = Uuid, Path)),
    responses(
        (status = 200, description = "The diagnosis.", body = Diagnosis),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_diagnosis(
    service: Service,
    JobId(id): JobId,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    if let Some(diagnosis) = service.store.result_part(id, Part::Diagnosis).await? {
        return Ok(cacheable(&headers, Format::Json, diagnosis));
    }
    let job = job::find(&service, id).await?;
    if job.status == Status::Succeeded {
        let detail = "the job is no diagnosis; submit it again with \"kind\": \"diagnose\"";
        return Err(Problem::new(Code::NoResult, detail));
    }
    Err(without_result(&job))
}
