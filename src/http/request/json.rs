//! JSON bodies: what is wrong with one is said with its place.

use axum::extract::{FromRequest, Request};
use serde::de::{DeserializeOwned, IgnoredAny};
use serde_path_to_error::{Path, Segment};

use super::body;
use crate::http::code::Code;
use crate::http::problem::Problem;
use crate::http::service::Server;

/// A JSON body, within [`crate::http::Config::max_json_body`].
pub(crate) struct JsonBody<T> {
    pub value: T,
    /// As it was sent.
    pub text: String,
}

impl<T: DeserializeOwned> FromRequest<Server> for JsonBody<T> {
    type Rejection = Problem;

    async fn from_request(request: Request, server: &Server) -> Result<Self, Problem> {
        let (parts, body) = request.into_parts();
        let media_type = body::media_type(&parts.headers);
        if media_type != "application/json" {
            return Err(body::unsupported(&media_type, &["application/json"]));
        }
        let limit = server.config.max_json_body;
        let bytes = body::read(&parts.headers, body, limit, "--max-json-body", &server.room);
        let body::Received { bytes, room: _room } = bytes.await?;
        let text = text(bytes)?;
        Ok(Self {
            value: parse(&text)?,
            text,
        })
    }
}

/// Bytes as text.
pub(crate) fn text(bytes: Vec<u8>) -> Result<String, Problem> {
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to() + 1;
        Problem::new(Code::InvalidJson, format!("byte {at} is not UTF-8"))
    })
}

/// Reads JSON; a fault of shape comes with its JSON pointer.
pub(crate) fn parse<T: DeserializeOwned>(text: &str) -> Result<T, Problem> {
    refuse_nul(text)?;
    let invalid = |error: serde_json::Error| Problem::new(Code::InvalidJson, error.to_string());
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let pointer = pointer(error.path());
        let error = error.into_inner();
        // a number where a word is expected is a syntax error to the library; not to who sent it
        match serde_json::from_str::<IgnoredAny>(text) {
            Err(_) if !error.is_data() => invalid(error),
            _ => Problem::at(Code::WrongShape, &pointer, error.to_string()),
        }
    })?;
    deserializer.end().map_err(invalid)?;
    Ok(value)
}

/// A database may not be able to keep the character U+0000, which only an escape can bring into JSON or TOML.
pub(crate) fn refuse_nul(text: &str) -> Result<(), Problem> {
    let is_escape = |at: usize| {
        let before = text.as_bytes()[..at].iter().rev();
        before.take_while(|byte| **byte == b'\\').count() % 2 == 0
    };
    let escapes = ["\\u0000", "\\U00000000"];
    let found = escapes.iter().flat_map(|escape| text.match_indices(escape));
    match found.map(|(at, _)| at).find(|at| is_escape(*at)) {
        Some(at) => {
            let message = format!(
                "byte {}: the character U+0000 is not allowed; leave it out",
                at + 1
            );
            Err(Problem::at(Code::WrongShape, "", message))
        }
        None => Ok(()),
    }
}

/// The JSON pointer (RFC 6901) of a path.
fn pointer(path: &Path) -> String {
    let mut pointer = String::new();
    for segment in path {
        let segment = match segment {
            Segment::Seq { index } => index.to_string(),
            Segment::Map { key } => key.replace('~', "~0").replace('/', "~1"),
            // what an enum's variant is called is no place in the document
            Segment::Enum { .. } | Segment::Unknown => continue,
        };
        pointer.push('/');
        pointer.push_str(&segment);
    }
    pointer
}
