//! Reading bodies, within bounds of length and time.

use std::sync::Arc;
use std::time::Duration;

use axum::body::Body;
use axum::http::{HeaderMap, HeaderValue, header};
use http_body_util::BodyExt;
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::time::{Instant, timeout, timeout_at};

use super::code::Code;
use super::problem::Problem;

/// A body of which nothing comes for this long is given up.
const IDLE: Duration = Duration::from_secs(30);

/// However steadily it comes, a body takes no longer than this.
const WHOLE: Duration = Duration::from_secs(600);

/// How long the rest of a refused body is read and thrown away.
const DISCARD: Duration = Duration::from_secs(5);

/// What bodies take that are on their way in or being worked on, all together.
#[derive(Clone)]
pub(super) struct Room(Arc<Semaphore>);

/// Room is given out by so many bytes.
const STEP: usize = 65_536;

/// How long a body waits for room.
const PATIENCE: Duration = Duration::from_secs(5);

impl Room {
    pub(super) fn new(bytes: usize) -> Self {
        Self(Arc::new(Semaphore::new(
            (bytes / STEP).clamp(1, Semaphore::MAX_PERMITS),
        )))
    }

    async fn take(&self, bytes: usize) -> Result<OwnedSemaphorePermit, Problem> {
        let steps = u32::try_from(bytes.div_ceil(STEP)).unwrap_or(u32::MAX);
        let taken = timeout(PATIENCE, self.0.clone().acquire_many_owned(steps)).await;
        taken.ok().and_then(Result::ok).ok_or_else(|| {
            let detail = "other bodies on their way take all the room that there is (--max-body-memory); send it again in a while";
            let seconds = HeaderValue::from_static("5");
            Problem::new(Code::Busy, detail).with_header(header::RETRY_AFTER, seconds)
        })
    }
}

/// A body, and its room: to be kept as long as the bytes are.
pub(super) struct Received {
    pub bytes: Vec<u8>,
    pub room: Option<OwnedSemaphorePermit>,
}

/// The whole body, if it is no longer than `limit` bytes. No more than that is ever held.
pub(super) async fn read(
    headers: &HeaderMap,
    mut body: Body,
    limit: usize,
    setting: &str,
    room: &Room,
) -> Result<Received, Problem> {
    if let Some(encoding) = headers.get(header::CONTENT_ENCODING)
        && encoding != "identity"
    {
        let detail = "bodies are read as they are; send it without Content-Encoding";
        return Err(Problem::new(Code::UnsupportedMediaType, detail));
    }
    let announced = headers.get(header::CONTENT_LENGTH);
    let announced = announced.and_then(|length| length.to_str().ok()?.parse::<u64>().ok());
    if announced.is_some_and(|length| length > limit as u64) {
        // a client that waits for leave to send is better told at once
        if !headers.contains_key(header::EXPECT) {
            discard(&mut body).await;
        }
        return Err(too_large(limit, setting));
    }
    let mut bytes = Vec::new();
    let mut taken: Option<OwnedSemaphorePermit> = None;
    let deadline = Instant::now() + WHOLE;
    let too_slow = || {
        let detail = format!(
            "nothing came for {} s, or not all within {} s",
            IDLE.as_secs(),
            WHOLE.as_secs()
        );
        Problem::new(Code::BodyTimeout, detail)
    };
    loop {
        let frame = timeout(IDLE, body.frame());
        let frame = timeout_at(deadline, frame).await.map_err(|_| too_slow())?;
        let Some(frame) = frame.map_err(|_| too_slow())? else {
            return Ok(Received { bytes, room: taken });
        };
        let frame = frame.map_err(|error| {
            let detail = format!("the body broke off after {} bytes: {error}", bytes.len());
            Problem::new(Code::IncompleteBody, detail)
        })?;
        let Some(data) = frame.data_ref() else {
            continue;
        };
        if bytes.len() + data.len() > limit {
            drop(bytes);
            discard(&mut body).await;
            return Err(too_large(limit, setting));
        }
        let has = taken.as_ref().map_or(0, |taken| taken.num_permits() * STEP);
        if bytes.len() + data.len() > has {
            let more = room.take(bytes.len() + data.len() - has).await?;
            match &mut taken {
                Some(taken) => taken.merge(more),
                None => taken = Some(more),
            }
        }
        bytes.extend_from_slice(data);
    }
}

/// Many clients read the answer only when they have sent everything, and take a connection that is
/// closed before for a network fault: what is on its way is let in, for a while, and dropped.
async fn discard(body: &mut Body) {
    let rest = async { while let Some(Ok(_)) = body.frame().await {} };
    let _ = timeout(DISCARD, rest).await;
}

fn too_large(limit: usize, setting: &str) -> Problem {
    let detail = format!(
        "the body is longer than {limit} bytes ({setting}); send less, or have the limit raised"
    );
    Problem::new(Code::BodyTooLarge, detail)
}

/// The media type of a request, without its parameters, in lower case.
pub(super) fn media_type(headers: &HeaderMap) -> String {
    let value = headers
        .get(header::CONTENT_TYPE)
        .and_then(|value| value.to_str().ok());
    let essence = value
        .unwrap_or_default()
        .split(';')
        .next()
        .unwrap_or_default();
    essence.trim().to_ascii_lowercase()
}

/// The answer to a media type that is not read here.
pub(super) fn unsupported(found: &str, expected: &[&str]) -> Problem {
    let expected = expected.join(" or ");
    let detail = match found {
        "" => format!("there is no Content-Type; send {expected}"),
        found => format!("Content-Type '{found}' is not read here; send {expected}"),
    };
    Problem::new(Code::UnsupportedMediaType, detail)
}
