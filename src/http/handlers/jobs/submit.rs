//! `POST /v1/jobs`: everything that would keep a job from starting is said here, at once.

use std::sync::Arc;

use axum::Json;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::job::JobResource;
use crate::flight::Maneuver;
use crate::http::code::Code;
use crate::http::handlers::flown::with_flown;
use crate::http::handlers::models;
use crate::http::middleware::once::NewId;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::json::JsonBody;
use crate::http::request::prefer;
use crate::http::request::query::Parameters;
use crate::http::service::{Server, Service};
use crate::job::{self, Fault, HIGHEST_PRIORITY, JobSpec, MOST_MANEUVERS, ModelSource, Prepared};
use crate::model::ModelDocument;
use crate::store::{NewJob, NotLoaded};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(submit_job))
}

const LONGEST_NAME: usize = 200;
const MOST_TAGS: usize = 20;
const LONGEST_TAG: usize = 64;

/// What a request that is answered with 200 has led to.
#[derive(Serialize, ToSchema)]
#[serde(untagged)]
enum Submission {
    Prepared(Prepared),
    Job(Box<JobResource>),
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct SubmitQuery {
    /// Check the job and say what it amounts to, without accepting it.
    #[serde(default)]
    validate_only: bool,
}

/// Submit a job.
///
/// The model is compiled, channels and units are resolved: all faults are answered at once, with
/// their places in the spec. When this answers 202 the job is stored and will be run.
#[utoipa::path(post, path = "/v1/jobs", tag = "Jobs", operation_id = "submitJob",
    params(SubmitQuery, ("prefer" = Option<String>, Header, description = "`wait=N`: hold the answer until the job is over, for N seconds at most (60).", example = "wait=10")),
    request_body = JobSpec,
    responses(
        (status = 202, description = "It is accepted.", body = JobResource, headers(("Location" = String, description = "Its path."))),
        (status = 200, description = "With `validate_only`: what the job would amount to. With `Prefer: wait=N`: the job, which is over.", body = inline(Submission)),
        (status = 400, description = "`invalid_json`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`wrong_shape`, `invalid_job`: `errors` lists the faults by JSON pointer.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn submit_job(
    service: Service,
    NewId(id): NewId,
    Parameters(query): Parameters<SubmitQuery>,
    headers: HeaderMap,
    JsonBody { value: spec, text }: JsonBody<JobSpec>,
) -> Result<Response, Problem> {
    let (spec, text) = with_flown(&service, spec, text).await?;
    let spec = Arc::new(spec);
    let (model, prepared) = check(&service, &spec).await?;
    if query.validate_only {
        return Ok(Json(Submission::Prepared(prepared)).into_response());
    }
    room(&service, 1).await?;
    let job = new_job(&spec, text, &model)?;
    let mut job = service.store.submit(id, &job).await?;
    let wait = prefer::wait(&headers);
    if let Some(wait) = wait {
        job = prefer::until_over(&service, job, wait).await?;
    }
    // a repetition may find its job over, and is answered as the first would have been
    let status = if wait.is_some() && job.status.is_over() {
        StatusCode::OK
    } else {
        StatusCode::ACCEPTED
    };
    let job = JobResource::of(job);
    let location = [(header::LOCATION, job.path())];
    let mut response = (status, location, Json(Submission::Job(Box::new(job)))).into_response();
    response.headers_mut().extend(wait.map(prefer::applied));
    Ok(response)
}

/// What is kept of a job that was checked; `text` is its spec as it was sent.
pub(crate) fn new_job(
    spec: &JobSpec,
    text: String,
    model: &ModelDocument,
) -> Result<NewJob, Problem> {
    Ok(NewJob {
        kind: spec.kind.name().to_string(),
        name: spec.name.clone(),
        tags: spec.tags.clone(),
        priority: spec.priority,
        maneuvers: spec.maneuvers.iter().map(|used| used.id.clone()).collect(),
        spec: text,
        model: serde_json::to_string(model)?,
    })
}

/// Whether so many more jobs may wait. Several that ask at once may each be let in: it is a bound against floods.
pub(crate) async fn room(service: &Service, jobs: usize) -> Result<(), Problem> {
    let config = &service.config;
    let waiting = service.store.waiting(config.max_queued).await?;
    let refuse = |of: &str, use_: usize, limit: usize, setting: &str| {
        let detail = format!(
            "{use_} jobs of {of} wait, and {limit} may ({setting}); submit again when some are done"
        );
        let seconds = HeaderValue::from_static("10");
        Err(Problem::new(Code::QueueFull, detail).with_header(header::RETRY_AFTER, seconds))
    };
    if waiting.own + jobs > config.max_queued_per_key {
        let limit = config.max_queued_per_key;
        return refuse("this key", waiting.own, limit, "--max-queued-per-key");
    }
    if waiting.all + jobs > config.max_queued {
        return refuse("everybody", waiting.all, config.max_queued, "--max-queued");
    }
    Ok(())
}

/// What the job amounts to, and the model that it names or holds; or all that is wrong with it.
pub(crate) async fn check(
    service: &Service,
    spec: &Arc<JobSpec>,
) -> Result<(ModelDocument, Prepared), Problem> {
    let mut faults = bounds(spec, service.caller.max_priority);
    let model = resolve_model(service, spec).await?;
    let maneuvers = load(service, spec).await?;
    let (model, maneuvers) = match (model, maneuvers) {
        (Ok(model), Ok(maneuvers)) => (model, maneuvers),
        (model, maneuvers) => {
            faults.extend(maneuvers.err().unwrap_or_default());
            match model {
                Err(fault) => faults.push(fault),
                // what can be said of the model without data is said too
                Ok(model) => {
                    let checked = service
                        .compute
                        .run(move || models::check_model(&model))
                        .await?;
                    let of_model = checked.err().into_iter().flatten();
                    faults.extend(of_model.map(|fault| fault.under("/model")));
                }
            }
            return Err(Problem::of_faults(Code::InvalidJob, faults));
        }
    };
    let spec = spec.clone();
    let prepare = move || {
        let prepared = job::prepare(&spec, &model, &maneuvers).map(|plan| plan.prepared);
        prepared.map(|prepared| (model, prepared))
    };
    match service.compute.run(prepare).await? {
        Ok(checked) if faults.is_empty() => Ok(checked),
        prepared => {
            faults.extend(prepared.err().into_iter().flatten());
            Err(Problem::of_faults(Code::InvalidJob, faults))
        }
    }
}

fn bounds(spec: &JobSpec, most: i32) -> Vec<Fault> {
    let mut faults = Vec::new();
    if !(-HIGHEST_PRIORITY..=most).contains(&spec.priority) {
        let message = format!(
            "{} is not between {} and {most}, which is as much as your key allows",
            spec.priority, -HIGHEST_PRIORITY
        );
        faults.push(Fault::new("/priority", "out_of_range", message));
    }
    if spec.name.chars().count() > LONGEST_NAME {
        let message = format!("longer than {LONGEST_NAME} characters");
        faults.push(Fault::new("/name", "too_long", message));
    }
    if spec.tags.len() > MOST_TAGS {
        let message = format!("{} tags are more than {MOST_TAGS}", spec.tags.len());
        faults.push(Fault::new("/tags", "too_many_tags", message));
    }
    for (number, tag) in spec.tags.iter().enumerate().take(MOST_TAGS) {
        if !(1..=LONGEST_TAG).contains(&tag.chars().count()) {
            let message = format!("a tag has 1 to {LONGEST_TAG} characters");
            faults.push(Fault::new(format!("/tags/{number}"), "tag_length", message));
        }
    }
    faults
}

async fn resolve_model(
    service: &Service,
    spec: &JobSpec,
) -> Result<Result<ModelDocument, Fault>, Problem> {
    find_model(service, &spec.model).await
}

/// The document that a source stands for.
pub(crate) async fn find_model(
    service: &Service,
    source: &ModelSource,
) -> Result<Result<ModelDocument, Fault>, Problem> {
    let name = match source {
        ModelSource::Document(document) => return Ok(Ok((**document).clone())),
        ModelSource::Reference(name) => name,
    };
    let model = models::find(service, name).await?;
    Ok(model.ok_or_else(|| {
        let name: String = name.chars().take(80).collect();
        let message = format!(
            "there is no model '{name}'; name a catalog model by its name, a stored one by its id: /v1/models lists both"
        );
        Fault::new("/model", "unknown_model", message)
    }))
}

/// The maneuvers of the spec, in its order; or those that are not there, or are too much.
pub(crate) async fn load(
    service: &Service,
    spec: &JobSpec,
) -> Result<Result<Vec<Arc<Maneuver>>, Vec<Fault>>, Problem> {
    if spec.maneuvers.len() > MOST_MANEUVERS {
        let message = format!(
            "{} maneuvers are more than {MOST_MANEUVERS}",
            spec.maneuvers.len()
        );
        return Ok(Err(vec![Fault::new(
            "/maneuvers",
            "too_many_maneuvers",
            message,
        )]));
    }
    let limit = service.config.max_job_values;
    let ids: Vec<&str> = spec.maneuvers.iter().map(|used| used.id.as_str()).collect();
    let loaded = service.store.load(&ids, limit).await?;
    Ok(loaded.map_err(|missing| {
        missing
            .into_iter()
            .map(|why| not_loaded(why, limit))
            .collect()
    }))
}

fn not_loaded(why: NotLoaded, limit: usize) -> Fault {
    match why {
        NotLoaded::Unknown(place) => Fault::new(
            format!("/maneuvers/{place}/id"),
            "unknown_maneuver",
            "there is no maneuver of this id; upload it first, and use the id in the answer",
        ),
        NotLoaded::TooMuch(place) => Fault::new(
            format!("/maneuvers/{place}"),
            "too_much_data",
            format!(
                "the maneuvers hold more than {limit} values (--max-job-values); use fewer or shorter ones"
            ),
        ),
    }
}
