//! `/jobs/{id}/report`: everything of a job in one file.

use axum::Router;
use axum::http::{HeaderMap, header};
use axum::response::Html;
use axum::routing::get;

use super::job;
use crate::dashboard::{JobView, ReportRecording, ReportView, report};
use crate::diagnose::analyse;
use crate::estimate::Role;
use crate::http::problem::Problem;
use crate::http::request::query::{JobId, unknown_job};
use crate::http::service::{Server, Service};
use crate::job::JobSpec;
use crate::store::Part;

pub(super) fn router() -> Router<Server> {
    Router::new().route("/jobs/{id}/report", get(get_report))
}

async fn get_report(
    service: Service,
    JobId(id): JobId,
    headers: HeaderMap,
) -> Result<Html<String>, Problem> {
    let job = job::view(&service, id).await?;
    let made_by = service.store.result_part(id, Part::Maker).await?;
    let made_by = made_by
        .map(|text| serde_json::from_str(&text))
        .transpose()?;
    let spec = service.store.job_spec(id).await?;
    let spec: JobSpec = serde_json::from_str(&spec.ok_or_else(|| unknown_job(id))?)?;
    let document = service.store.result_part(id, Part::Model).await?;
    let document = document
        .map(|text| serde_json::from_str(&text))
        .transpose()?;
    let recordings = recordings(&service, &spec, &job).await?;
    let histories = service.store.histories(id).await?.unwrap_or_default();
    let written = service.store.clock().now_text();
    let origin = origin(&headers, service.config.trusts_proxy);
    let write = move || {
        let fitted: Vec<_> = (histories.iter())
            .filter(|history| history.role == Role::Estimation)
            .cloned()
            .collect();
        report(&ReportView {
            residuals: if fitted.is_empty() {
                Vec::new()
            } else {
                analyse(&fitted)
            },
            job,
            spec,
            document,
            recordings,
            histories,
            made_by,
            origin,
            written,
        })
    };
    Ok(Html(service.compute.run(write).await?))
}

/// The maneuvers of a job with what there is to say of their recordings.
async fn recordings(
    service: &Service,
    spec: &JobSpec,
    job: &JobView,
) -> Result<Vec<ReportRecording>, Problem> {
    let mut recordings = Vec::with_capacity(spec.maneuvers.len());
    for (used, shown) in spec.maneuvers.iter().zip(&job.maneuvers) {
        let record = service.store.maneuver(&used.id).await?;
        let (name, summary, flown) = match record {
            Some(record) => {
                let summary = serde_json::from_str(&record.summary)?;
                (record.name, Some(summary), record.flown)
            }
            None => Default::default(),
        };
        recordings.push(ReportRecording {
            label: shown.label.clone(),
            flown: used.flown.clone().unwrap_or(flown),
            used: used.clone(),
            name,
            summary,
        });
    }
    Ok(recordings)
}

/// The service as the reader's browser knows it; what is said of a proxy is believed where there is one.
fn origin(headers: &HeaderMap, trusts_proxy: bool) -> String {
    let text = |name: &str| headers.get(name).and_then(|value| value.to_str().ok());
    let forwarded = |name: &str| text(name).filter(|_| trusts_proxy);
    let scheme = match forwarded("x-forwarded-proto") {
        Some("https") => "https",
        _ => "http",
    };
    // a chain of proxies: the first is the one that the browser knows
    let host = forwarded("x-forwarded-host").and_then(|hosts| hosts.split(',').next());
    let host = host.or_else(|| text(header::HOST.as_str()));
    format!("{scheme}://{}/", host.unwrap_or("localhost").trim())
}

#[cfg(test)]
mod tests {
    use axum::http::{HeaderName, HeaderValue};

    use super::*;

    #[test]
    fn a_proxy_is_believed_where_there_is_one() {
        let headers: HeaderMap = [
            ("host", "127.0.0.1:8300"),
            ("x-forwarded-host", "lab.example, inner"),
            ("x-forwarded-proto", "https"),
        ]
        .map(|(name, value)| {
            (
                HeaderName::from_static(name),
                HeaderValue::from_static(value),
            )
        })
        .into_iter()
        .collect();
        assert_eq!(origin(&headers, false), "http://127.0.0.1:8300/");
        assert_eq!(origin(&headers, true), "https://lab.example/");
        assert_eq!(origin(&HeaderMap::new(), true), "http://localhost/");
    }
}
