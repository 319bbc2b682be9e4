//! What jobs of one kind alone find: `/v1/jobs/{id}/derivative-study`, and `/v1/jobs/{id}/diagnosis`: what the model of a
//! job lacks; `/v1/jobs/{id}/structure`: which terms an equation needs.

use axum::http::HeaderMap;
use axum::response::Response;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;
use uuid::Uuid;

use super::job;
use super::results::without_result;
use crate::diagnose::Diagnosis;
use crate::estimate::study::DerivativeStudy;
use crate::http::answer::format::{Format, cacheable};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::JobId;
use crate::http::service::{Server, Service};
use crate::job::Status;
use crate::store::Part;
use crate::structure::Structure;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(get_derivative_study))
        .routes(routes!(get_diagnosis))
        .routes(routes!(get_structure))
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
    let of_another_kind =
        "the job is not a derivative study; submit it again with \"kind\": \"derivative_study\"";
    found(&service, id, &headers, Part::Study, of_another_kind).await
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
    let of_another_kind = "the job is not a diagnosis; submit it again with \"kind\": \"diagnose\"";
    found(&service, id, &headers, Part::Diagnosis, of_another_kind).await
}

/// Which terms the equation of an output needs, step by step, of jobs of the kind `structure`.
#[utoipa::path(get, path = "/v1/jobs/{id}/structure", tag = "Results", operation_id = "getStructure",
    params(("id" = Uuid, Path)),
    responses(
        (status = 200, description = "The structure, and the steps by which it was found.", body = Structure),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_structure(
    service: Service,
    JobId(id): JobId,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let of_another_kind =
        "the job is not a structure determination; submit it again with \"kind\": \"structure\"";
    found(&service, id, &headers, Part::Structure, of_another_kind).await
}

/// A part of a result that only one kind of job has.
async fn found(
    service: &Service,
    id: Uuid,
    headers: &HeaderMap,
    part: Part,
    of_another_kind: &str,
) -> Result<Response, Problem> {
    if let Some(found) = service.store.result_part(id, part).await? {
        return Ok(cacheable(headers, Format::Json, found));
    }
    let job = job::find(service, id).await?;
    if job.status == Status::Succeeded {
        return Err(Problem::new(Code::NoResult, of_another_kind));
    }
    Err(without_result(&job))
}
