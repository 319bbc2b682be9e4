//! `/v1/jobs/{id}/events`: the log of a job, live or page by page.

use std::convert::Infallible;
use std::time::Duration;

use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};
use axum::response::sse::{self, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use futures_util::Stream;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;
use uuid::Uuid;

use super::job;
use crate::http::answer::format::{Format, choose};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{JobId, Parameters};
use crate::http::service::{Server, Service};
use crate::job::Event;
use crate::store::{Signal, StoredEvent};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(list_events))
}

/// A comment so often keeps proxies from taking a quiet stream for a dead one.
const KEEP_ALIVE: Duration = Duration::from_secs(15);

/// How often a stream looks without being signalled: for events of other processes.
const LOOK_AGAIN: Duration = Duration::from_secs(2);

/// Events that are read from the store at a time.
const BATCH: usize = 200;
const PAGE: usize = 200;
const LONGEST_PAGE: usize = 1000;

/// Events of a job, in order.
#[derive(Serialize, ToSchema)]
pub(crate) struct EventPage {
    /// In the order in which they happened.
    #[schema(value_type = Vec<Event>)]
    events: Vec<Box<RawValue>>,
    /// What to say in `after` for the next page.
    #[schema(example = 12)]
    next_after: u64,
    /// Whether nothing will follow any more.
    complete: bool,
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct EventsQuery {
    /// Only events behind this number; the header `Last-Event-ID` says the same and counts first.
    #[serde(default)]
    after: u64,
    /// Events of a page, 1 to 1000; 200 if absent. A stream has no limit.
    #[param(minimum = 1, maximum = 1000)]
    limit: Option<usize>,
    /// `json` or `sse`; absent: as `Accept` says.
    #[param(inline)]
    format: Option<Format>,
}

/// Follow a job.
///
/// With `Accept: text/event-stream` the answer is a stream of server-sent events: `id` is the event's
/// number, `event` its type, `data` the event as JSON. A client that was cut off goes on where it stopped
/// by sending the last number it saw as `Last-Event-ID` (browsers do so by themselves): nothing is lost,
/// nothing comes twice. Behind the last event the stream is closed; asking on is answered 204. A number behind the last event so
/// far counts as that one's.
///
/// Otherwise the answer is a page of the same events.
#[utoipa::path(get, path = "/v1/jobs/{id}/events", tag = "Jobs", operation_id = "listEvents",
    params(("id" = Uuid, Path), EventsQuery,
        ("Last-Event-ID" = Option<u64>, Header, description = "The number of the last event seen.")),
    responses(
        (status = 200, description = "The events.", content((EventPage = "application/json"), (Event = "text/event-stream"))),
        (status = 204, description = "The stream is over: there is nothing behind that number and never will be."),
        (status = 404, description = "`unknown_job`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn list_events(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<EventsQuery>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let after = last_event_id(&headers)?.unwrap_or(query.after);
    let format = choose(query.format, &headers, &[Format::Json, Format::Sse])?;
    let limit = match query.limit.unwrap_or(PAGE) {
        limit @ 1..=LONGEST_PAGE => limit,
        limit => {
            let detail = format!("limit: {limit} is not between 1 and {LONGEST_PAGE}");
            return Err(Problem::new(Code::InvalidQuery, detail));
        }
    };
    // the job first: if it is over now, all its events are there
    let job = job::find(&service, id).await?;
    let over = job.status.is_over();
    // of another job, or of a database that has gone back to a backup: what comes from now on is told, and so the end
    let after = after.min(job.last_seq);
    let page = service.store.events(id, after, limit).await?;
    if format == Format::Json {
        let complete = over && page.next_cursor.is_none();
        let next_after = page.entries.last().map_or(after, |event| event.seq);
        let events = page.entries.iter().map(raw).collect::<Result<_, _>>()?;
        let page = EventPage {
            events,
            next_after,
            complete,
        };
        return Ok(no_store(axum::Json(page).into_response()));
    }
    if over && page.entries.is_empty() {
        return Ok(StatusCode::NO_CONTENT.into_response());
    }
    let keep_alive = KeepAlive::new().interval(KEEP_ALIVE);
    let stream = Sse::new(follow(service, id, after)).keep_alive(keep_alive);
    let mut response = no_store(stream.into_response());
    // nginx would gather events and send many at once, late
    let passing = (
        HeaderName::from_static("x-accel-buffering"),
        HeaderValue::from_static("no"),
    );
    response.headers_mut().extend([passing]);
    Ok(response)
}

fn last_event_id(headers: &HeaderMap) -> Result<Option<u64>, Problem> {
    let Some(value) = headers.get("last-event-id") else {
        return Ok(None);
    };
    let number = value
        .to_str()
        .ok()
        .and_then(|text| text.trim().parse().ok());
    let detail = "Last-Event-ID: it is not the number of an event";
    number
        .map(Some)
        .ok_or_else(|| Problem::new(Code::InvalidHeader, detail))
}

fn raw(event: &StoredEvent) -> serde_json::Result<Box<RawValue>> {
    RawValue::from_string(event.to_json())
}

pub(super) fn no_store(mut response: Response) -> Response {
    let value = HeaderValue::from_static("no-store");
    response.headers_mut().insert(header::CACHE_CONTROL, value);
    response
}

/// The events behind `after`, as they come, up to the last; it ends when the service does, since it
/// would keep the service from ending. The client comes back with the number where it stopped.
fn follow(
    service: Service,
    job: Uuid,
    mut after: u64,
) -> impl Stream<Item = Result<sse::Event, Infallible>> {
    let follower = service.metrics.follower();
    async_stream::stream! {
        let _follower = follower;
        yield Ok(sse::Event::default().retry(Duration::from_secs(1)));
        loop {
            // before looking: what comes in between is not overlooked
            let mut signals = service.store.listen();
            let page = match service.store.events(job, after, BATCH).await {
                Ok(page) => page,
                Err(error) => {
                    tracing::error!(%job, %error, "a stream of events broke off");
                    return;
                }
            };
            for event in page.entries {
                after = event.seq;
                let last = event.is_last();
                yield Ok(sse::Event::default()
                    .id(event.seq.to_string())
                    .event(&event.name)
                    .data(event.to_json()));
                if last {
                    return;
                }
            }
            if page.next_cursor.is_none() {
                tokio::select! {
                    () = signals.wait_for(Signal::Log(job), LOOK_AGAIN) => {}
                    () = service.shutdown.cancelled() => return,
                }
            }
        }
    }
}
