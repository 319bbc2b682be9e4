//! Problems (RFC 9457), and the one place where errors of the rooms become problems.

use std::any::Any;

use axum::body::Body;
use axum::extract::Request;
use axum::http::{HeaderName, HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use tower_http::request_id::RequestId;
use utoipa::ToSchema;

use super::code::Code;
use crate::dashboard::{ProblemView, problem_page};
use crate::ingest::IngestError;
use crate::job::Fault;
use crate::store::{StoreError, Trouble};

pub const MEDIA_TYPE: &str = "application/problem+json";

/// What is wrong with a request, as the client gets it: `application/problem+json`.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[schema(as = Problem)]
pub struct ProblemDocument {
    /// Where the code is explained.
    #[serde(rename = "type")]
    #[schema(example = "/v1/problems/invalid_job")]
    pub kind: String,
    /// The code in words.
    #[schema(example = "The job has faults")]
    pub title: String,
    /// The HTTP status.
    #[schema(example = 422)]
    pub status: u16,
    /// A stable word: see `/v1/problems` for all of them.
    #[schema(example = "invalid_job")]
    pub code: String,
    /// What is wrong with this request, and what would put it right.
    #[schema(
        example = "1 fault prevents the job from starting: /maneuvers/0/id: there is no maneuver of this id; upload it first"
    )]
    pub detail: String,
    /// Every place that is wrong.
    pub errors: Vec<Fault>,
    /// Of a recording that was refused: the draft of a mapping that makes the choices which it leaves open, `?` where one
    /// must be made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(value_type = Option<crate::ingest::Mapping>)]
    pub mapping: Option<serde_json::Value>,
    /// The header `x-request-id`; the service's log has it too.
    #[schema(example = "0193518e-6b6f-7d3c-9c53-b1cbb2b7a1f4")]
    pub request_id: String,
}

impl ProblemDocument {
    fn page(&self) -> String {
        problem_page(&ProblemView {
            title: &self.title,
            detail: &self.detail,
            faults: &self.errors,
            request: &self.request_id,
        })
    }
}

/// A problem on its way out; [`render`] makes a [`ProblemDocument`] of it.
#[derive(Clone, Debug)]
pub struct Problem {
    code: Code,
    detail: String,
    errors: Vec<Fault>,
    mapping: Option<Box<serde_json::Value>>,
    headers: Vec<(HeaderName, HeaderValue)>,
}

impl Problem {
    pub fn new(code: Code, detail: impl Into<String>) -> Self {
        let mut detail = detail.into();
        shorten(&mut detail);
        Self {
            code,
            detail,
            errors: Vec::new(),
            mapping: None,
            headers: Vec::new(),
        }
    }

    /// A problem that consists of faults, of which there is at least one.
    pub fn of_faults(code: Code, errors: impl Into<Vec<Fault>>) -> Self {
        let mut errors = errors.into();
        for fault in &mut errors {
            shorten(&mut fault.message);
            shorten(&mut fault.pointer);
        }
        let first = errors.first().map(|fault| match fault.pointer.as_str() {
            "" => fault.message.clone(),
            pointer => format!("{pointer}: {}", fault.message),
        });
        let first = first.unwrap_or_default();
        let detail = match errors.len() {
            0 | 1 => first,
            count => format!("{count} faults, the first: {first}"),
        };
        Self {
            code,
            detail,
            errors,
            mapping: None,
            headers: Vec::new(),
        }
    }

    #[must_use]
    pub fn with_header(mut self, name: HeaderName, value: HeaderValue) -> Self {
        self.headers.push((name, value));
        self
    }

    pub fn errors(&self) -> &[Fault] {
        &self.errors
    }

    /// The fault of a single place.
    pub fn at(code: Code, pointer: &str, message: impl Into<String>) -> Self {
        Self::of_faults(code, vec![Fault::new(pointer, code.name(), message)])
    }

    fn document(self, request_id: String) -> ProblemDocument {
        ProblemDocument {
            kind: format!("/v1/problems/{}", self.code.name()),
            title: self.code.title().to_string(),
            status: self.code.status().as_u16(),
            code: self.code.name().to_string(),
            detail: self.detail,
            errors: self.errors,
            mapping: self.mapping.map(|mapping| *mapping),
            request_id,
        }
    }
}

/// What was sent is not sent back, however much of it a message repeats.
fn shorten(text: &mut String) {
    const LONGEST: usize = 1000;
    if let Some((end, _)) = text.char_indices().nth(LONGEST) {
        text.truncate(end);
        text.push('…');
    }
}

impl From<IngestError> for Problem {
    fn from(error: IngestError) -> Self {
        let draft = error
            .draft()
            .and_then(|draft| serde_json::from_str(draft).ok());
        Self {
            mapping: draft.map(Box::new),
            ..Self::of_faults(Code::InvalidManeuver, error.into_faults())
        }
    }
}

impl From<StoreError> for Problem {
    fn from(error: StoreError) -> Self {
        if let StoreError::ManeuverGone { place, .. } = error {
            return Self::of_faults(Code::InvalidJob, vec![maneuver_gone(place)]);
        }
        tracing::error!(%error, "store");
        // its text may name files and tables: that is for the log
        let (code, detail) = match error.trouble() {
            None => return Self::internal(),
            Some(Trouble::Away) => (
                Code::StoreUnavailable,
                "the database does not answer; try again in a few seconds",
            ),
            Some(Trouble::Full) => (
                Code::StoreFull,
                "the database has no room left on its disk; make room there, and try again",
            ),
            Some(Trouble::ReadOnly) => (
                Code::StoreUnavailable,
                "the database can be read and not written; see to its permissions, and try again",
            ),
        };
        let seconds = HeaderValue::from_static("5");
        Self::new(code, detail).with_header(header::RETRY_AFTER, seconds)
    }
}

/// Of a job that was checked while somebody deleted what it needs.
fn maneuver_gone(place: usize) -> Fault {
    Fault::new(
        format!("/maneuvers/{place}/id"),
        "unknown_maneuver",
        "the maneuver was deleted while the job was being submitted; upload it again",
    )
}

impl From<serde_json::Error> for Problem {
    /// Of *writing* JSON; what is wrong with JSON that was read is said by `json`.
    fn from(error: serde_json::Error) -> Self {
        tracing::error!(%error, "json");
        Self::internal()
    }
}

impl Problem {
    pub fn internal() -> Self {
        let detail =
            "a defect of the service, not of the request; its log tells more under the request_id";
        Self::new(Code::Internal, detail)
    }

    /// What a panic in a handler becomes. The panic itself is in the log.
    pub fn of_panic(_: Box<dyn Any + Send>) -> Response {
        Self::internal().into_response()
    }
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let mut response = self.code.status().into_response();
        for (name, value) in &self.headers {
            response.headers_mut().insert(name, value.clone());
        }
        response.extensions_mut().insert(self);
        response
    }
}

/// Gives every failed response its document: those that a handler answered with, and those that
/// come from the libraries below without one.
pub async fn render(request: Request, next: Next) -> Response {
    let id = request.extensions().get::<RequestId>();
    let id = id
        .and_then(|id| id.header_value().to_str().ok())
        .unwrap_or_default()
        .to_string();
    let is_page = wants_page(&request);
    let mut response = next.run(request).await;
    let problem = match response.extensions_mut().remove::<Problem>() {
        Some(problem) => problem,
        None if is_bare_failure(&response) => of_status(response.status()),
        None => return response,
    };
    let document = problem.document(id);
    let (media_type, body) = if is_page {
        ("text/html; charset=utf-8", document.page().into_bytes())
    } else {
        let json = serde_json::to_vec(&document).unwrap_or_default();
        (MEDIA_TYPE, json)
    };
    let headers = response.headers_mut();
    headers.remove(header::CONTENT_LENGTH);
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(media_type));
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    *response.body_mut() = Body::from(body);
    response
}

/// Whether a browser asks for something to show to people.
fn wants_page(request: &Request) -> bool {
    let accepts = request.headers().get_all(header::ACCEPT).iter();
    let accepts_page = accepts
        .filter_map(|accept| accept.to_str().ok())
        .any(|accept| accept.contains("text/html"));
    accepts_page && !request.uri().path().starts_with("/v1/")
}

fn is_bare_failure(response: &Response) -> bool {
    let status = response.status();
    status.is_client_error() || status.is_server_error()
}

pub fn unknown_route() -> Problem {
    Problem::new(
        Code::UnknownRoute,
        "there is nothing here; /docs shows what there is",
    )
}

pub fn no_connection_left() -> Problem {
    let detail = "all connections are taken (--max-connections, --max-connections-per-peer); try again in a moment";
    let seconds = HeaderValue::from_static("1");
    Problem::new(Code::Busy, detail).with_header(header::RETRY_AFTER, seconds)
}

pub fn method_not_allowed() -> Problem {
    Problem::new(
        Code::MethodNotAllowed,
        "the header Allow lists the methods of this path",
    )
}

fn of_status(status: StatusCode) -> Problem {
    match status {
        StatusCode::NOT_FOUND => unknown_route(),
        StatusCode::METHOD_NOT_ALLOWED => method_not_allowed(),
        _ => Problem::internal(),
    }
}
