//! `POST /v1/jobs/bulk`: one job for each of many maneuvers.

use std::sync::Arc;

use axum::Json;
use axum::http::StatusCode;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;
use uuid::Uuid;

use super::job::JobResource;
use super::submit::{check, new_job, room};
use crate::http::code::Code;
use crate::http::handlers::flown::with_flown;
use crate::http::middleware::once::NewId;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::json::{self, JsonBody};
use crate::http::service::{Server, Service};
use crate::job::{Fault, JobSpec, ManeuverUse};
use crate::store::{NewJob, StoreError};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(submit_jobs))
}

const MOST_JOBS: usize = 500;

/// What the specs of all jobs may take: each keeps its own.
const MOST_BYTES: usize = 20_000_000;

/// Beyond so many, further faults tell nothing new.
const MOST_FAULTS: usize = 100;

/// One job for each of many maneuvers.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Bulk {
    /// What the jobs have in common: a job without `maneuvers`.
    #[schema(value_type = Object, example = json!({"model": "short-period", "tags": ["flight 12"]}))]
    job: Map<String, Value>,
    /// Each becomes a job of its own, up to 500.
    #[schema(value_type = Vec<ManeuverUse>, min_items = 1, max_items = 500)]
    maneuvers: Vec<Value>,
}

/// Jobs that were accepted.
#[derive(Serialize, ToSchema)]
struct Submitted {
    /// In the order of the maneuvers.
    jobs: Vec<JobResource>,
}

/// Submit one job for each of many maneuvers.
///
/// All of them are checked, and all are accepted or none. The pointers of faults are into the body: `/job/model`,
/// `/maneuvers/3/id`.
#[utoipa::path(post, path = "/v1/jobs/bulk", tag = "Jobs", operation_id = "submitJobs",
    request_body = Bulk,
    responses(
        (status = 202, description = "They are accepted.", body = Submitted),
        (status = 413, description = "`body_too_large`: all specs together.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`wrong_shape`, `invalid_job`: `errors` lists all faults by JSON pointer.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 429, description = "`queue_full`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn submit_jobs(
    service: Service,
    NewId(first): NewId,
    JsonBody { value: bulk, .. }: JsonBody<Bulk>,
) -> Result<(StatusCode, Json<Submitted>), Problem> {
    if !(1..=MOST_JOBS).contains(&bulk.maneuvers.len()) {
        let message = format!("{} maneuvers; 1 to {MOST_JOBS}", bulk.maneuvers.len());
        return Err(Problem::at(Code::WrongShape, "/maneuvers", message));
    }
    if bulk.job.contains_key("maneuvers") {
        let message = "maneuvers stand beside the job, not in it";
        return Err(Problem::at(Code::WrongShape, "/job/maneuvers", message));
    }
    let each = serde_json::to_string(&bulk.job)?.len();
    if each.saturating_mul(bulk.maneuvers.len()) > MOST_BYTES {
        let detail = format!(
            "{} jobs of {each} bytes each are more than {MOST_BYTES} bytes; store the model (POST /v1/models) and name it by its id",
            bulk.maneuvers.len()
        );
        return Err(Problem::new(Code::BodyTooLarge, detail));
    }
    room(&service, bulk.maneuvers.len()).await?;
    let (mut jobs, mut faults) = (Vec::new(), Vec::new());
    for (number, maneuver) in bulk.maneuvers.into_iter().enumerate() {
        match one(&service, &bulk.job, maneuver).await {
            Ok(job) => jobs.push(job),
            Err(problem) if problem.errors().is_empty() => return Err(problem),
            Err(problem) => note(&mut faults, problem.errors(), number),
        }
        if faults.len() >= MOST_FAULTS {
            break;
        }
    }
    if !faults.is_empty() {
        return Err(Problem::of_faults(Code::InvalidJob, faults));
    }
    let numbered = (first.as_u128()..).map(Uuid::from_u128);
    let jobs: Vec<(Uuid, &NewJob)> = numbered.zip(&jobs).collect();
    let jobs = service.store.submit_all(&jobs).await;
    let jobs = jobs.map_err(|error| match error {
        // each job has one maneuver, by the number of the job
        StoreError::ManeuverGone { job: place, .. } => StoreError::ManeuverGone { job: 0, place },
        error => error,
    })?;
    let jobs = jobs.into_iter().map(JobResource::of).collect();
    Ok((StatusCode::ACCEPTED, Json(Submitted { jobs })))
}

async fn one(
    service: &Service,
    common: &Map<String, Value>,
    maneuver: Value,
) -> Result<NewJob, Problem> {
    let mut job = common.clone();
    job.insert("maneuvers".to_string(), Value::Array(vec![maneuver]));
    let text = Value::Object(job).to_string();
    let (spec, text) = with_flown(service, json::parse::<JobSpec>(&text)?, text).await?;
    let spec = Arc::new(spec);
    let (model, _) = check(service, &spec).await?;
    new_job(&spec, text, &model)
}

/// What is wrong with what all have in common is said once.
fn note(faults: &mut Vec<Fault>, found: &[Fault], number: usize) {
    for fault in found {
        let pointer = match fault.pointer.strip_prefix("/maneuvers/0") {
            Some(rest) => format!("/maneuvers/{number}{rest}"),
            None => format!("/job{}", fault.pointer),
        };
        let fault = Fault {
            pointer,
            ..fault.clone()
        };
        if !faults.contains(&fault) {
            faults.push(fault);
        }
    }
}
