//! `/v1/jobs`: what became of them. Submitting is in `submit`, following in `events`.

use axum::Json;
use axum::http::{HeaderMap, StatusCode};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;
use uuid::Uuid;

use crate::estimate::{FitSummary, Outcome, Role};
use crate::flight::FindingTally;
use crate::http::answer::format::{Format, cacheable};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{JobId, Parameters, bad_cursor, page_limit, search, unknown_job};
use crate::http::service::{Server, Service};
use crate::job::{EventBody, Fault, JobKind, JobSpec, Status};
use crate::store::{CancelReply, Clock, JobFilter, JobRecord};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(list_jobs))
        .routes(routes!(get_job))
        .routes(routes!(get_job_spec))
        .routes(routes!(cancel_job))
}

/// A job.
#[derive(Serialize, ToSchema)]
#[schema(as = Job)]
pub(crate) struct JobResource {
    /// Under which it is followed and asked for.
    #[schema(example = "0193518e-6b6f-7d3c-9c53-b1cbb2b7a1f4")]
    id: Uuid,
    /// What was wanted of the model and the data.
    #[schema(value_type = JobKind)]
    kind: String,
    /// As it was submitted; empty: none was given.
    #[schema(example = "ATTAS elevator 3-2-1-1, run 1")]
    name: String,
    /// What to call it: its name, or else its model and maneuvers.
    #[schema(example = "short-period: flight 12 and flight 13")]
    title: String,
    /// The model that it was submitted with.
    model: JobModel,
    /// In the order of the spec.
    maneuvers: Vec<JobManeuver>,
    /// For people, to find jobs by.
    #[schema(example = json!(["flight 12"]))]
    tags: Vec<String>,
    /// Of two that wait, the higher is taken first.
    #[schema(example = 0)]
    priority: i32,
    /// Where it stands.
    status: Status,
    /// How many jobs, of everybody, are taken before this one; said where one job is asked for, and it waits.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = 3)]
    ahead: Option<usize>,
    /// When it was accepted, RFC 3339.
    #[schema(example = "2026-11-21T12:00:00.123Z")]
    created: String,
    /// When a worker first took it.
    started: Option<String>,
    /// When it was over.
    finished: Option<String>,
    /// How often a worker took it: more than once where one was lost or shut down.
    #[schema(example = 1)]
    attempt: u32,
    /// Why the solver stopped, once it has: how good the result is, apart from how the job went.
    outcome: Option<Outcome>,
    /// The outcome in a sentence.
    #[schema(
        example = "converged: a further step would move the estimate by 3.1e-7 standard errors"
    )]
    reason: Option<String>,
    /// Why it failed.
    faults: Vec<Fault>,
    /// Whether the result links lead to something.
    has_result: bool,
    /// How many findings the result carries, and the codes of those that matter; the estimate has each with its place.
    warnings: FindingTally,
    /// How well the output is reproduced that is reproduced worst; the estimate has all of them. Absent without an estimate.
    #[serde(skip_serializing_if = "Option::is_none")]
    fit: Option<FitSummary>,
    /// Where the rest of it is.
    links: JobLinks,
}

/// The model of a job.
#[derive(Serialize, ToSchema)]
struct JobModel {
    /// By its document's `name`.
    #[schema(example = "short-period")]
    name: String,
    /// A catalog name, or the id of a stored model, which may have been deleted since; absent of a model that only the job
    /// holds.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "short-period")]
    id: Option<String>,
}

/// A maneuver of a job.
#[derive(Serialize, ToSchema)]
struct JobManeuver {
    /// SHA-256 of the content.
    #[schema(example = "3f0a1c0f6f5a7a0e8f3a0f0c8f7a1b2c3d4e5f60718293a4b5c6d7e8f9a0b1c2")]
    id: String,
    /// The label in the spec; else the recording's name when the job was submitted, and the part in use.
    #[schema(example = "flight 12, 2 to 32.5 s")]
    label: String,
    /// Whether the model is fitted to it, or predicts it.
    role: Role,
}

/// Paths of what there is of a job; those of results lead to something where `has_result` is true.
#[derive(Serialize, ToSchema)]
struct JobLinks {
    /// The job itself.
    #[serde(rename = "self")]
    this: String,
    /// As it was submitted.
    spec: String,
    /// Its log, live or page by page.
    events: String,
    /// Cost and parameters by iteration.
    iterations: String,
    /// POST here to end it.
    cancel: String,
    /// The whole estimate.
    estimate: String,
    /// The parameter table.
    parameters: String,
    /// Measured minus model over time.
    residuals: String,
    /// What is in the residuals.
    residual_analysis: String,
    /// Inputs and outputs over time, measured and modelled.
    time_histories: String,
    /// States and definitions over time.
    trajectories: String,
    /// The model with the estimates as start values.
    model: String,
    /// Of a job of the kind `diagnose`.
    #[serde(skip_serializing_if = "Option::is_none")]
    diagnosis: Option<String>,
    /// Of a job of the kind `structure`.
    #[serde(skip_serializing_if = "Option::is_none")]
    structure: Option<String>,
}

impl JobLinks {
    fn of(id: Uuid, kind: &str) -> Self {
        let this = format!("/v1/jobs/{id}");
        let under = |name: &str| format!("{this}/{name}");
        Self {
            spec: under("spec"),
            events: under("events"),
            iterations: under("iterations"),
            cancel: under("cancel"),
            estimate: under("estimate"),
            parameters: under("parameters"),
            residuals: under("residuals"),
            residual_analysis: under("residual-analysis"),
            time_histories: under("time-histories"),
            trajectories: under("trajectories"),
            model: under("model"),
            diagnosis: (kind == JobKind::Diagnose.name()).then(|| under("diagnosis")),
            structure: (kind == JobKind::Structure.name()).then(|| under("structure")),
            this,
        }
    }
}

impl JobResource {
    pub(crate) fn of(job: JobRecord) -> Self {
        let title = job.title();
        let (mut outcome, mut reason, mut faults, mut has_result) = (None, None, Vec::new(), false);
        let mut warnings = FindingTally::default();
        match job.ending {
            Some(EventBody::Succeeded {
                outcome: of_solver,
                reason: why,
                findings,
            }) => {
                (outcome, reason, has_result) = (Some(of_solver), Some(why), true);
                warnings = findings;
            }
            Some(EventBody::Cancelled {
                has_result: kept,
                findings,
            }) => {
                (outcome, has_result, warnings) = (Some(Outcome::Cancelled), kept, findings);
            }
            Some(EventBody::Failed { faults: why }) => faults = why,
            _ => {}
        }
        Self {
            links: JobLinks::of(job.id, &job.kind),
            id: job.id,
            title,
            model: JobModel {
                name: job.about.model.name,
                id: job.about.model.id,
            },
            maneuvers: (job.about.maneuvers.into_iter())
                .map(|used| JobManeuver {
                    id: used.id,
                    label: used.label,
                    role: used.role,
                })
                .collect(),
            kind: job.kind,
            name: job.name,
            tags: job.tags,
            priority: job.priority,
            status: job.status,
            ahead: None,
            created: job.created,
            started: job.started,
            finished: job.finished,
            attempt: job.attempt,
            outcome,
            reason,
            faults,
            has_result,
            warnings,
            fit: job.fit,
        }
    }

    pub(crate) fn path(&self) -> String {
        self.links.this.clone()
    }
}

/// A page of jobs.
#[derive(Serialize, ToSchema)]
pub(crate) struct JobPage {
    /// Newest first.
    jobs: Vec<JobResource>,
    /// What to say in `cursor` for the next page; `null`: this is the last.
    next_cursor: Option<String>,
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct ListQuery {
    /// `next_cursor` of the page before; absent: the first page.
    cursor: Option<String>,
    /// Jobs of the page, 1 to 200; 50 if absent.
    #[param(minimum = 1, maximum = 200)]
    limit: Option<usize>,
    /// Only those of this status.
    #[param(inline)]
    status: Option<Status>,
    /// Only those of this kind.
    #[param(inline)]
    kind: Option<JobKind>,
    /// Only those that have this tag.
    tag: Option<String>,
    /// Only those submitted after this moment (RFC 3339).
    #[param(format = DateTime, example = "2026-11-21T12:00:00Z")]
    created_after: Option<String>,
    /// Only those that have each of these words in their name, tags, model or labels of maneuvers, upper case or lower.
    #[param(max_length = 200, example = "flight 12")]
    q: Option<String>,
}

/// List jobs, newest first.
#[utoipa::path(get, path = "/v1/jobs", tag = "Jobs", operation_id = "listJobs",
    params(ListQuery),
    responses((status = 200, description = "A page.", body = JobPage)))]
async fn list_jobs(
    service: Service,
    Parameters(query): Parameters<ListQuery>,
) -> Result<Json<JobPage>, Problem> {
    let limit = page_limit(query.limit)?;
    let moment = |text: String| {
        Clock::read(&text).ok_or_else(|| {
            let detail =
                format!("created_after: '{text}' is not a time; write it as 2026-11-21T12:00:00Z");
            Problem::new(Code::InvalidQuery, detail)
        })
    };
    let filter = JobFilter {
        status: query.status,
        kind: query.kind.map(|kind| kind.name().to_string()),
        tag: query.tag,
        created_after: query.created_after.map(moment).transpose()?,
        search: search(query.q.as_deref())?,
    };
    let page = service
        .store
        .jobs(&filter, query.cursor.as_deref(), limit)
        .await?;
    let page = page.map_err(bad_cursor)?;
    let jobs = page.entries.into_iter().map(JobResource::of).collect();
    Ok(Json(JobPage {
        jobs,
        next_cursor: page.next_cursor,
    }))
}

/// What became of a job.
#[utoipa::path(get, path = "/v1/jobs/{id}", tag = "Jobs", operation_id = "getJob",
    params(("id" = Uuid, Path)),
    responses(
        (status = 200, description = "The job.", body = JobResource),
        (status = 404, description = "`unknown_job`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_job(service: Service, JobId(id): JobId) -> Result<Json<JobResource>, Problem> {
    let job = JobResource::of(find(&service, id).await?);
    let ahead = service.store.ahead(id).await?;
    Ok(Json(JobResource { ahead, ..job }))
}

pub(crate) async fn find(service: &Service, id: Uuid) -> Result<JobRecord, Problem> {
    service.store.job(id).await?.ok_or_else(|| unknown_job(id))
}

/// The job as it was submitted.
#[utoipa::path(get, path = "/v1/jobs/{id}/spec", tag = "Jobs", operation_id = "getJobSpec",
    params(("id" = Uuid, Path)),
    responses(
        (status = 200, description = "The spec.", body = JobSpec),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 404, description = "`unknown_job`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_job_spec(
    service: Service,
    JobId(id): JobId,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let spec = service
        .store
        .job_spec(id)
        .await?
        .ok_or_else(|| unknown_job(id))?;
    Ok(cacheable(&headers, Format::Json, spec))
}

/// Ask to stop a job.
///
/// A job that waits is cancelled at once. One that runs ends within a second: what is under way is dropped, and its
/// best iterate is kept as the result if one can be made of it by then. Asking twice is asking once.
#[utoipa::path(post, path = "/v1/jobs/{id}/cancel", tag = "Jobs", operation_id = "cancelJob",
    params(("id" = Uuid, Path)),
    responses(
        (status = 202, description = "It is asked.", body = JobResource),
        (status = 404, description = "`unknown_job`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`already_over`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn cancel_job(service: Service, JobId(id): JobId) -> Result<Response, Problem> {
    match service.store.cancel(id).await? {
        CancelReply::Asked(job) => {
            Ok((StatusCode::ACCEPTED, Json(JobResource::of(job))).into_response())
        }
        CancelReply::AlreadyOver(job) => {
            let detail = format!(
                "the job is {} already; there is nothing to cancel",
                job.status.name()
            );
            Err(Problem::new(Code::AlreadyOver, detail))
        }
        CancelReply::Unknown => Err(unknown_job(id)),
    }
}
