//! `Idempotency-Key`: a POST that is sent twice is done once.

use axum::body::{Body, Bytes};
use axum::extract::{FromRequestParts, Request, State};
use axum::http::request::Parts;
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use http_body_util::BodyExt;
use sha2::{Digest, Sha256};
use uuid::Uuid;

use crate::http::code::Code;
use crate::http::problem::Problem;
use crate::http::request::{body, multipart};
use crate::http::room::{Occupied, Room};
use crate::http::service::{Server, Service};
use crate::store::{KeptAnswer, Once};

pub(crate) const KEY: HeaderName = HeaderName::from_static("idempotency-key");
pub(crate) const REPLAYED: HeaderName = HeaderName::from_static("idempotency-replayed");
const LONGEST_KEY: usize = 255;

/// Headers that an answer has when it is given again.
const KEPT: [HeaderName; 3] = [header::CONTENT_TYPE, header::LOCATION, header::ETAG];

/// The id for what a request makes: that of its key, so that it is made once, or a new one.
pub(crate) struct NewId(pub Uuid);

#[derive(Clone, Copy)]
struct Reserved(Uuid);

impl FromRequestParts<Server> for NewId {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, server: &Server) -> Result<Self, Problem> {
        let reserved = parts.extensions.get::<Reserved>();
        Ok(Self(reserved.map_or_else(
            || server.store.clock().new_id(),
            |Reserved(id)| *id,
        )))
    }
}

/// Answers a POST with a key from what is kept, or does it and keeps the answer. What fails is not kept; an answer that is to
/// be stored nowhere is kept without its secret.
pub(crate) async fn once(State(server): State<Server>, request: Request, next: Next) -> Response {
    if request.method() != Method::POST || !request.headers().contains_key(KEY) {
        return next.run(request).await;
    }
    let (mut parts, body) = request.into_parts();
    let service = Service::from_request_parts(&mut parts, &server).await;
    let request = Request::from_parts(parts, body);
    // where there is no caller there is nothing that a POST could do
    let Ok(service) = service else {
        return next.run(request).await;
    };
    match of_key(&service, request, next).await {
        Ok(response) => response,
        Err(problem) => problem.into_response(),
    }
}

async fn of_key(service: &Service, request: Request, next: Next) -> Result<Response, Problem> {
    let key = key(request.headers())?;
    let (parts, body) = request.into_parts();
    let config = &service.config;
    let is_recording = parts.uri.path() == "/v1/maneuvers";
    let (limit, setting) = if is_recording {
        (config.max_maneuver_body, "--max-maneuver-body")
    } else {
        (config.max_json_body, "--max-json-body")
    };
    let room = &service.room;
    let body = body::read(&parts.headers, body, limit, setting, room).await?;
    let (body, _room) = (Bytes::from(body.bytes), body.room);
    let asked = digest(&parts, &body, room).await?;
    let id = match service.store.take_in_hand(&key, &asked).await? {
        Once::Do(id) => id,
        Once::Done(answer) => return Ok(replay(answer)),
        Once::InHand => {
            let detail = "a request with this key is being worked on; send it again in a while";
            let seconds = HeaderValue::from_static("2");
            return Err(
                Problem::new(Code::KeyInHand, detail).with_header(header::RETRY_AFTER, seconds)
            );
        }
        Once::Other => {
            let detail = "this key was used for another request within the last 24 h; a key is for one request and its repetitions";
            return Err(Problem::new(Code::KeyReused, detail));
        }
    };
    let mut request = Request::from_parts(parts, Body::from(body));
    request.extensions_mut().insert(Reserved(id));
    let service = service.clone();
    // a client that hangs up meanwhile and asks again finds the answer
    let done = tokio::spawn(async move {
        let response = next.run(request).await;
        keep(&service, &key, response).await
    });
    done.await.map_err(|error| {
        tracing::error!(%error, "a request with a key failed");
        Problem::internal()
    })?
}

fn key(headers: &HeaderMap) -> Result<String, Problem> {
    let text = headers.get(KEY).and_then(|value| value.to_str().ok());
    let fits = |text: &&str| (1..=LONGEST_KEY).contains(&text.len());
    text.filter(fits).map(str::to_string).ok_or_else(|| {
        let detail = format!(
            "Idempotency-Key: 1 to {LONGEST_KEY} printable ASCII characters, a UUID for instance"
        );
        Problem::new(Code::InvalidHeader, detail)
    })
}

/// What is asked for: the path with its query, the kind of the body, and the body.
async fn digest(parts: &Parts, body: &Bytes, room: &Room) -> Result<String, Problem> {
    let media_type = body::media_type(&parts.headers);
    let mut digest = Sha256::new();
    digest.update(parts.uri.to_string());
    digest.update([0]);
    digest.update(&media_type);
    digest.update([0]);
    match of_parts(parts, &media_type, body, room).await? {
        Some(parts) => digest.update(parts),
        None => digest.update(body),
    }
    Ok(hex::encode(digest.finalize()))
}

/// A body of several files is the same with another boundary. One that cannot be read is refused later, and goes by its bytes.
async fn of_parts(
    parts: &Parts,
    media_type: &str,
    body: &Bytes,
    room: &Room,
) -> Result<Option<[u8; 32]>, Problem> {
    if media_type != multipart::MEDIA_TYPE {
        return Ok(None);
    }
    // its parts stand beside it for a moment
    let mut beside = Occupied::default();
    room.extend(&mut beside, body.len()).await?;
    let content_type = body::content_type(&parts.headers);
    Ok(multipart::digest(content_type, body.clone()).await.ok())
}

async fn keep(service: &Service, key: &str, response: Response) -> Result<Response, Problem> {
    if !response.status().is_success() {
        service.store.let_go(key).await?;
        return Ok(response);
    }
    let is_secret = response
        .headers()
        .get(header::CACHE_CONTROL)
        .is_some_and(|value| value == "no-store");
    let (parts, body) = response.into_parts();
    let body = body.collect().await.map_err(|error| {
        tracing::error!(%error, "an answer could not be read");
        Problem::internal()
    })?;
    let body: Bytes = body.to_bytes();
    let headers = KEPT.iter().filter_map(|name| {
        let value = parts.headers.get(name)?.to_str().ok()?;
        Some((name.to_string(), value.to_string()))
    });
    let answer = KeptAnswer {
        status: parts.status.as_u16(),
        headers: headers.collect(),
        body: if is_secret {
            without_secret(&body)?
        } else {
            body.to_vec()
        },
    };
    service.store.keep_answer(key, &answer).await?;
    Ok(Response::from_parts(parts, Body::from(body)))
}

/// The answer as it is given again: it was made once, and its secret is shown once.
fn without_secret(body: &[u8]) -> Result<Vec<u8>, Problem> {
    let mut answer: serde_json::Map<String, serde_json::Value> = serde_json::from_slice(body)?;
    answer.remove("secret");
    Ok(serde_json::to_vec(&answer)?)
}

fn replay(answer: KeptAnswer) -> Response {
    let mut response = Response::new(Body::from(answer.body));
    *response.status_mut() = StatusCode::from_u16(answer.status).unwrap_or(StatusCode::OK);
    let headers = response.headers_mut();
    for (name, value) in answer.headers {
        if let (Ok(name), Ok(value)) = (HeaderName::try_from(name), HeaderValue::try_from(value)) {
            headers.insert(name, value);
        }
    }
    headers.insert(REPLAYED, HeaderValue::from_static("true"));
    response
}
