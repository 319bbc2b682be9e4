//! `/jobs/{id}`: the page of a job.

use axum::Router;
use axum::response::Html;
use axum::routing::get;
use serde::de::DeserializeOwned;
use uuid::Uuid;

use crate::dashboard::{JobView, ModelPlace, NamedModel, UsedManeuver, job_page};
use crate::estimate::Estimate;
use crate::http::handlers::jobs::job;
use crate::http::handlers::models;
use crate::http::problem::Problem;
use crate::http::request::query::{JobId, unknown_job};
use crate::http::service::{Server, Service};
use crate::job::{EventBody, JobSpec, ManeuverUse};
use crate::store::{About, Part};

pub(super) fn router() -> Router<Server> {
    Router::new().route("/jobs/{id}", get(get_job_page))
}

async fn get_job_page(service: Service, JobId(id): JobId) -> Result<Html<String>, Problem> {
    let view = view(&service, id).await?;
    Ok(Html(service.compute.run(move || job_page(&view)).await?))
}

/// All that there is to say of a job, but the time histories.
pub(super) async fn view(service: &Service, id: Uuid) -> Result<JobView, Problem> {
    let job = job::find(service, id).await?;
    let spec = service.store.job_spec(id).await?;
    let spec: JobSpec = serde_json::from_str(&spec.ok_or_else(|| unknown_job(id))?)?;
    let title = job.title();
    let maneuvers = (1..)
        .zip(&spec.maneuvers)
        .map(|(at, maneuver)| UsedManeuver {
            id: maneuver.id.clone(),
            label: label(&job.about, at, maneuver),
            role: maneuver.role,
        });
    let maneuvers = maneuvers.collect();
    // the log begins with what the job amounts to
    let log = service.store.events(id, 0, 16).await?;
    let bodies = log.entries.into_iter();
    let findings = bodies
        .filter_map(|event| match serde_json::from_str(&event.body) {
            Ok(EventBody::Prepared(prepared)) => Some(prepared.findings),
            _ => None,
        })
        .next_back()
        .unwrap_or_default();
    let estimate: Option<Estimate> = part(service, id, Part::Estimate).await?;
    // those of the data are among those of a result; one that was kept before they were has none
    let findings = match &estimate {
        Some(estimate) if !estimate.findings.is_empty() => estimate.findings.clone(),
        _ => findings,
    };
    Ok(JobView {
        id: id.to_string(),
        maneuvers,
        model: model(service, &spec, &job.about).await?,
        title,
        kind: job.kind,
        tags: job.tags,
        status: job.status,
        created: job.created,
        started: job.started,
        now: service.store.clock().now_text(),
        tolerance: spec.options.tolerance,
        attempt: job.attempt,
        faults: match job.ending {
            Some(EventBody::Failed { faults }) => faults,
            _ => Vec::new(),
        },
        findings,
        estimate,
        study: part(service, id, Part::Study).await?,
        diagnosis: part(service, id, Part::Diagnosis).await?,
    })
}

/// What a maneuver is called: one without a label by its number, which its segments are called by, and its recording.
fn label(about: &About, at: usize, used: &ManeuverUse) -> String {
    match (&used.label, about.maneuvers.get(at - 1)) {
        (Some(label), _) => label.clone(),
        (None, Some(known)) => format!("{at}: {}", known.label),
        (None, None) => format!("maneuver {at}"),
    }
}

/// The model, with the way to it as long as it is there.
async fn model(service: &Service, spec: &JobSpec, about: &About) -> Result<NamedModel, Problem> {
    let named = &about.model.name;
    let name = if named.is_empty() {
        spec.model.name()
    } else {
        named
    };
    let place = match spec.model.reference() {
        None => ModelPlace::InTheJob,
        Some(id) if models::find(service, id).await?.is_none() => ModelPlace::Deleted,
        Some(id) => ModelPlace::Kept(id.to_string()),
    };
    Ok(NamedModel {
        name: name.to_string(),
        place,
    })
}

async fn part<T: DeserializeOwned>(
    service: &Service,
    id: Uuid,
    part: Part,
) -> Result<Option<T>, Problem> {
    let text = service.store.result_part(id, part).await?;
    Ok(text.map(|text| serde_json::from_str(&text)).transpose()?)
}
