//! Reading bodies, within bounds of length and time.

use std::time::Duration;

use axum::body::Body;
use axum::http::{HeaderMap, header};
use http_body_util::BodyExt;
use tokio::time::{Instant, timeout, timeout_at};

use crate::http::code::Code;
use crate::http::problem::Problem;
use crate::http::room::{Occupied, Room};

/// A body of which nothing comes for this long is given up.
const IDLE: Duration = Duration::from_secs(30);

/// However steadily it comes, a body takes no longer than this.
const WHOLE: Duration = Duration::from_secs(600);

/// How long the rest of a refused body is read and thrown away.
const DISCARD: Duration = Duration::from_secs(5);

/// A body, and its room: to be kept as long as the bytes are.
pub(crate) struct Received {
    pub bytes: Vec<u8>,
    pub room: Occupied,
}

/// The whole body, if it is no longer than `limit` bytes. No more than that is ever held.
pub(crate) async fn read(
    headers: &HeaderMap,
    mut body: Body,
    limit: usize,
    setting: &str,
    room: &Room,
) -> Result<Received, Problem> {
    if let Some(encoding) = headers.get(header::CONTENT_ENCODING)
        && encoding != "identity"
    {
        let detail = "encoded bodies are not read; send it without Content-Encoding";
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
    let mut taken = Occupied::default();
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
        room.extend(&mut taken, bytes.len() + data.len()).await?;
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
pub(crate) fn media_type(headers: &HeaderMap) -> String {
    let essence = content_type(headers).split(';').next();
    essence.unwrap_or_default().trim().to_ascii_lowercase()
}

/// The `Content-Type` as it was sent, parameters and all; empty where there is none that can be read.
pub(crate) fn content_type(headers: &HeaderMap) -> &str {
    let value = headers.get(header::CONTENT_TYPE);
    value
        .and_then(|value| value.to_str().ok())
        .unwrap_or_default()
}

/// The answer to a media type that is not read here.
pub(crate) fn unsupported(found: &str, expected: &[&str]) -> Problem {
    let expected = expected.join(" or ");
    let detail = match found {
        "" => format!("there is no Content-Type; send {expected}"),
        found => format!("Content-Type '{found}' is not read here; send {expected}"),
    };
    Problem::new(Code::UnsupportedMediaType, detail)
}
