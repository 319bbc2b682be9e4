//! Deleting jobs and maneuvers.

use axum::Json;
use axum::http::StatusCode;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::keys::days;
use super::maneuvers::unknown_maneuver;
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::json::JsonBody;
use crate::http::request::query::{Id, JobId, unknown_job};
use crate::http::service::{Server, Service};
use crate::store::{Deleted, Expired};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(delete_job))
        .routes(routes!(delete_maneuver))
        .routes(routes!(expire))
}

/// Delete a job that is over, with its log and result.
#[utoipa::path(delete, path = "/v1/jobs/{id}", tag = "Jobs", operation_id = "deleteJob",
    params(("id" = Uuid, Path)),
    responses(
        (status = 204, description = "It is gone."),
        (status = 404, description = "`unknown_job`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`: cancel it first.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn delete_job(service: Service, JobId(id): JobId) -> Result<StatusCode, Problem> {
    match service.store.delete_job(id).await? {
        Deleted::Gone => Ok(StatusCode::NO_CONTENT),
        Deleted::NotOver => {
            let detail = "the job is not over; cancel it, and delete it then";
            Err(Problem::new(Code::NotFinished, detail))
        }
        Deleted::Unknown | Deleted::InUse(_) => Err(unknown_job(id)),
    }
}

/// Delete a maneuver that no job uses.
#[utoipa::path(delete, path = "/v1/maneuvers/{id}", tag = "Maneuvers", operation_id = "deleteManeuver",
    params(("id" = String, Path, description = "The id from the upload.")),
    responses(
        (status = 204, description = "It is gone."),
        (status = 404, description = "`unknown_maneuver`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`in_use`: delete the jobs first.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn delete_maneuver(service: Service, Id(id): Id) -> Result<StatusCode, Problem> {
    match service.store.delete_maneuver(&id).await? {
        Deleted::Gone => Ok(StatusCode::NO_CONTENT),
        Deleted::InUse(jobs) => {
            let detail = format!(
                "{jobs} jobs use the maneuver, and could not be run again without it; delete them first"
            );
            Err(Problem::new(Code::InUse, detail))
        }
        Deleted::Unknown | Deleted::NotOver => Err(unknown_maneuver(&id)),
    }
}

/// What need not be kept.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Retention {
    /// Jobs that ended, and maneuvers that were uploaded, more than so many days ago.
    #[schema(minimum = 1, maximum = 36500, example = 365)]
    older_than_days: u32,
    /// Jobs with this tag are kept, and what they use.
    #[serde(default = "keep")]
    #[schema(example = "keep")]
    keep_tag: String,
    /// Say how much it is, and delete nothing.
    #[serde(default)]
    dry_run: bool,
}

fn keep() -> String {
    "keep".to_string()
}

/// What was deleted, or would be.
#[derive(Serialize, ToSchema)]
struct Removed {
    /// Whether it was only asked: nothing was deleted.
    dry_run: bool,
    /// Jobs, with their results.
    jobs: u64,
    /// Those that no job uses which is left.
    maneuvers: u64,
    /// What the samples of these maneuvers take, bytes.
    maneuver_bytes: u64,
}

/// Delete what is older than it need be kept.
///
/// Of the project: jobs that are over, and maneuvers that no job uses which is left. With `dry_run` nothing is deleted, and
/// the answer says how much it would be.
#[utoipa::path(post, path = "/v1/retention", tag = "Operations", operation_id = "expire",
    request_body = Retention,
    responses(
        (status = 200, description = "It is done.", body = Removed),
        (status = 422, description = "`wrong_shape`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn expire(
    service: Service,
    JsonBody { value: wish, .. }: JsonBody<Retention>,
) -> Result<Json<Removed>, Problem> {
    if !(1..=36500).contains(&wish.older_than_days) {
        let message = "1 to 36500 days";
        return Err(Problem::at(Code::WrongShape, "/older_than_days", message));
    }
    let Expired {
        jobs,
        maneuvers,
        maneuver_bytes,
    } = service
        .store
        .expire(days(wish.older_than_days), &wish.keep_tag, wish.dry_run)
        .await?;
    Ok(Json(Removed {
        dry_run: wish.dry_run,
        jobs,
        maneuvers,
        maneuver_bytes,
    }))
}
