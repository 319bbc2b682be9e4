//! `/`: the page of all jobs.

use axum::Router;
use axum::response::Html;
use axum::routing::get;
use serde::Deserialize;

use crate::dashboard::{Chosen, JobRow, JobsView, jobs_page};
use crate::http::code::Code;
use crate::http::problem::Problem;
use crate::http::request::query::{Parameters, bad_cursor, search};
use crate::http::service::{Server, Service};
use crate::job::{EventBody, JobKind, Status};
use crate::store::{Clock, JobFilter, JobRecord};

pub(super) fn router() -> Router<Server> {
    Router::new().route("/", get(get_jobs_page))
}

/// Jobs of a page.
const JOBS: usize = 100;

/// As a form sends it: what is not chosen is empty.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Query {
    #[serde(default)]
    status: String,
    #[serde(default)]
    kind: String,
    #[serde(default)]
    tag: String,
    #[serde(default)]
    q: String,
    cursor: Option<String>,
}

async fn get_jobs_page(
    service: Service,
    Parameters(query): Parameters<Query>,
) -> Result<Html<String>, Problem> {
    let status = chosen(&query.status, Status::ALL, Status::name)?;
    let kind = chosen(&query.kind, JobKind::ALL, JobKind::name)?;
    let filter = JobFilter {
        status,
        kind: kind.map(|kind| kind.name().to_string()),
        tag: (!query.tag.is_empty()).then(|| query.tag.clone()),
        created_after: None,
        search: search(Some(&query.q))?,
    };
    let cursor = query.cursor.as_deref();
    let page = service.store.jobs(&filter, cursor, JOBS).await?;
    let page = page.map_err(bad_cursor)?;
    let now = service.store.clock().now_text();
    let older = page.next_cursor.map(|cursor| {
        let mut form = form_urlencoded::Serializer::new(String::new());
        form.append_pair("status", &query.status);
        form.append_pair("kind", &query.kind);
        form.append_pair("tag", &query.tag);
        form.append_pair("q", &query.q);
        form.append_pair("cursor", &cursor);
        format!("/?{}", form.finish())
    });
    let view = JobsView {
        jobs: page.entries.into_iter().map(|job| row(job, &now)).collect(),
        chosen: Chosen {
            status,
            kind,
            is_later_page: query.cursor.is_some(),
            tag: query.tag,
            q: query.q,
        },
        older,
    };
    Ok(Html(service.compute.run(move || jobs_page(&view)).await?))
}

/// What a name stands for; nothing where nothing was chosen.
fn chosen<T: Copy, const N: usize>(
    text: &str,
    all: [T; N],
    name: fn(T) -> &'static str,
) -> Result<Option<T>, Problem> {
    if text.is_empty() {
        return Ok(None);
    }
    let found = all.into_iter().find(|one| name(*one) == text);
    found.map(Some).ok_or_else(|| {
        let names = all.map(name).join(", ");
        let detail = format!("there is no '{text}'; there are {names}");
        Problem::new(Code::InvalidQuery, detail)
    })
}

fn row(job: JobRecord, now: &str) -> JobRow {
    let until = job.finished.as_deref().unwrap_or(now);
    let started = job.started.as_deref();
    let warnings = match &job.ending {
        Some(EventBody::Succeeded { findings, .. } | EventBody::Cancelled { findings, .. }) => {
            findings.faults + findings.warnings
        }
        _ => 0,
    };
    let (outcome, reason) = match &job.ending {
        Some(EventBody::Succeeded { reason, .. }) => (outcome(&job.kind, reason), reason.clone()),
        Some(EventBody::Failed { faults }) => {
            let first = faults.first().map(|fault| fault.message.clone());
            (first.clone().unwrap_or_default(), first.unwrap_or_default())
        }
        _ => Default::default(),
    };
    JobRow {
        id: job.id.to_string(),
        seconds: started.and_then(|started| Clock::seconds_between(started, until)),
        title: job.title(),
        about: if job.name.is_empty() {
            String::new()
        } else {
            job.about.title()
        },
        has_result: job.fit.is_some() || job.status == Status::Succeeded,
        fit: job.fit,
        warnings,
        outcome,
        reason,
        kind: job.kind,
        tags: job.tags,
        status: job.status,
        created: job.created,
    }
}

/// The reason in a line: what a diagnosis found, how else a solver ended.
fn outcome(kind: &str, reason: &str) -> String {
    let is_diagnosis = kind == JobKind::Diagnose.name();
    let first = reason.split_once(": ").filter(|_| !is_diagnosis);
    first.map_or(reason, |(first, _)| first).to_string()
}
