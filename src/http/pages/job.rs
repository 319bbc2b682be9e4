//! `/jobs/{id}`: the page of a job.

use axum::Router;
use axum::response::Html;
use axum::routing::get;
use serde::de::DeserializeOwned;
use uuid::Uuid;

use crate::dashboard::{JobView, NamedModel, UsedManeuver, job_page};
use crate::estimate::Estimate;
use crate::http::handlers::jobs::job;
use crate::http::problem::Problem;
use crate::http::request::query::{JobId, unknown_job};
use crate::http::service::{Server, Service};
use crate::job::{EventBody, JobSpec};
use crate::store::Part;

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
    let maneuvers = (1..)
        .zip(&spec.maneuvers)
        .map(|(at, maneuver)| UsedManeuver {
            id: maneuver.id.clone(),
            label: maneuver
                .label
                .clone()
                .unwrap_or_else(|| format!("maneuver {at}")),
            role: maneuver.role,
        });
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
        maneuvers: maneuvers.collect(),
        model: NamedModel {
            name: spec.model.name().to_string(),
            id: spec.model.reference().map(ToString::to_string),
        },
        name: job.name,
        kind: job.kind,
        tags: job.tags,
        status: job.status,
        created: job.created,
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

async fn part<T: DeserializeOwned>(
    service: &Service,
    id: Uuid,
    part: Part,
) -> Result<Option<T>, Problem> {
    let text = service.store.result_part(id, part).await?;
    Ok(text.map(|text| serde_json::from_str(&text)).transpose()?)
}
