//! `/jobs/{id}/report`: everything of a job in one file.

use axum::Router;
use axum::http::{HeaderMap, header};
use axum::response::Html;
use axum::routing::get;

use super::job;
use crate::dashboard::{ReportView, report};
use crate::diagnose::analyse;
use crate::estimate::Role;
use crate::http::problem::Problem;
use crate::http::request::query::JobId;
use crate::http::service::{Server, Service};
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
    let histories = service.store.histories(id).await?.unwrap_or_default();
    let written = service.store.clock().now_text();
    let origin = origin(&headers);
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
            histories,
            made_by,
            origin,
            written,
        })
    };
    Ok(Html(service.compute.run(write).await?))
}

/// The service as the reader's browser knows it.
fn origin(headers: &HeaderMap) -> String {
    let text = |name: &str| headers.get(name).and_then(|value| value.to_str().ok());
    let scheme = match text("x-forwarded-proto") {
        Some("https") => "https",
        _ => "http",
    };
    let host = text(header::HOST.as_str()).unwrap_or("localhost");
    format!("{scheme}://{host}/")
}
