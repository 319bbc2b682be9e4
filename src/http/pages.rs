//! `/jobs/{id}`: the page of a job, for people; `/assets/{name}`: what pages load.

use axum::Router;
use axum::http::{HeaderMap, HeaderValue};
use axum::response::{Html, Response};
use axum::routing::get;

use super::format::cacheable_as;
use super::jobs;
use super::problem::{Problem, unknown_route};
use super::query::{Id, JobId};
use super::{Server, Service};
use crate::dashboard::{JobView, asset, job_page};
use crate::flight::Finding;
use crate::job::{EventBody, JobSpec};
use crate::store::Part;

pub fn router() -> Router<Server> {
    Router::new()
        .route("/jobs/{id}", get(get_job_page))
        .route("/assets/{name}", get(get_asset))
}

async fn get_asset(Id(name): Id, headers: HeaderMap) -> Result<Response, Problem> {
    let asset = asset(&name).ok_or_else(unknown_route)?;
    let media_type = HeaderValue::from_static(asset.media_type);
    Ok(cacheable_as(&headers, media_type, asset.content))
}

async fn get_job_page(service: Service, JobId(id): JobId) -> Result<Html<String>, Problem> {
    let job = jobs::find(&service, id).await?;
    let estimate = match service.store.result_part(id, Part::Estimate).await? {
        Some(json) => Some(serde_json::from_str(&json)?),
        None => None,
    };
    let study = match service.store.result_part(id, Part::Study).await? {
        Some(json) => Some(serde_json::from_str(&json)?),
        None => None,
    };
    let histories = service.store.histories(id).await?.unwrap_or_default();
    let model = match service.store.job_spec(id).await? {
        Some(spec) => serde_json::from_str::<JobSpec>(&spec)?
            .model
            .name()
            .to_string(),
        None => String::new(),
    };
    let log = service.store.events(id, 0, usize::from(u8::MAX)).await?;
    let findings: Vec<Finding> = (log.entries.into_iter().rev())
        .find_map(|event| match serde_json::from_str(&event.body) {
            Ok(EventBody::Prepared(prepared)) => Some(prepared.findings),
            _ => None,
        })
        .unwrap_or_default();
    let render = move || {
        let faults = match &job.ending {
            Some(EventBody::Failed { faults }) => faults.as_slice(),
            _ => &[],
        };
        job_page(&JobView {
            id: &id.to_string(),
            name: &job.name,
            model: &model,
            status: job.status,
            faults,
            findings: &findings,
            estimate: estimate.as_ref(),
            study: study.as_ref(),
            histories: &histories,
        })
    };
    Ok(Html(service.compute.run(render).await?))
}
