//! What made a result, and making it again.

use axum::Json;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use serde_json::value::RawValue;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;
use uuid::Uuid;

use super::job::JobResource;
use super::submit::room;
use crate::http::middleware::once::NewId;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{JobId, unknown_job};
use crate::http::service::{Server, Service};
use crate::job::{JobSpec, Maker};
use crate::model::ModelDocument;
use crate::store::Part;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(get_provenance))
        .routes(routes!(rerun_job))
}

/// All that a result was made from.
#[derive(Serialize, ToSchema)]
struct Provenance {
    /// Whose result it is.
    job: Uuid,
    /// As it was submitted.
    #[schema(value_type = JobSpec)]
    spec: Box<RawValue>,
    /// The model that the spec named or held, as it was then.
    #[schema(value_type = ModelDocument)]
    model: Box<RawValue>,
    /// SHA-256 of the content of each maneuver, in the order of the spec.
    maneuvers: Vec<String>,
    /// The program that made the result; `null` as long as there is none, or where it was not yet recorded.
    #[schema(value_type = Option<Maker>)]
    made_by: Option<Box<RawValue>>,
}

/// What a result was made from, and by which program.
#[utoipa::path(get, path = "/v1/jobs/{id}/provenance", tag = "Results", operation_id = "getProvenance",
    params(("id" = Uuid, Path)),
    responses(
        (status = 200, description = "All of it.", body = Provenance),
        (status = 404, description = "`unknown_job`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_provenance(service: Service, JobId(id): JobId) -> Result<Json<Provenance>, Problem> {
    let job = service.store.submitted(id).await?;
    let job = job.ok_or_else(|| unknown_job(id))?;
    let spec: JobSpec = serde_json::from_str(&job.spec)?;
    let maker = service.store.result_part(id, Part::Maker).await?;
    Ok(Json(Provenance {
        job: id,
        maneuvers: spec.maneuvers.into_iter().map(|used| used.id).collect(),
        spec: RawValue::from_string(job.spec)?,
        model: RawValue::from_string(job.model)?,
        made_by: maker.map(RawValue::from_string).transpose()?,
    }))
}

/// Run a job again: the same spec, the same data, the model as it was then.
///
/// The same program on the same kind of processor comes to the same numbers, to the last bit (`provenance` names both).
/// The new job has the tag `rerun:<id>`.
#[utoipa::path(post, path = "/v1/jobs/{id}/rerun", tag = "Jobs", operation_id = "rerunJob",
    params(("id" = Uuid, Path)),
    responses(
        (status = 202, description = "It is accepted.", body = JobResource, headers(("Location" = String, description = "Its path."))),
        (status = 404, description = "`unknown_job`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 429, description = "`queue_full`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn rerun_job(
    service: Service,
    NewId(new): NewId,
    JobId(id): JobId,
) -> Result<Response, Problem> {
    let job = service.store.submitted(id).await?;
    let mut job = job.ok_or_else(|| unknown_job(id))?;
    room(&service, 1).await?;
    job.tags.retain(|tag| !tag.starts_with("rerun:"));
    job.tags.push(format!("rerun:{id}"));
    job.priority = job.priority.min(service.caller.max_priority);
    let job = JobResource::of(service.store.submit(new, &job).await?);
    let location = [(header::LOCATION, job.path())];
    Ok((StatusCode::ACCEPTED, location, Json(job)).into_response())
}
