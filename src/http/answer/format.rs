//! In which form an answer is given, and how it is cached.

use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use sha2::{Digest, Sha256};
use utoipa::ToSchema;

use crate::http::code::Code;
use crate::http::problem::Problem;

#[derive(Clone, Copy, PartialEq, Eq, Debug, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Format {
    Json,
    Csv,
    Toml,
    /// MAT file.
    Mat,
    /// Server-sent events.
    Sse,
}

impl Format {
    fn media_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
            Self::Csv => "text/csv",
            Self::Toml => "application/toml",
            Self::Mat => "application/x-matlab-data",
            Self::Sse => "text/event-stream",
        }
    }

    fn content_type(self) -> HeaderValue {
        HeaderValue::from_static(match self {
            Self::Json => "application/json",
            Self::Csv => "text/csv; charset=utf-8; header=present",
            Self::Toml => "application/toml",
            Self::Mat => "application/x-matlab-data",
            Self::Sse => "text/event-stream",
        })
    }
}

/// What the client wants out of what is `offered`, the first being the default: `?format=` if it
/// is there, or else what `Accept` likes best.
pub(crate) fn choose(
    asked: Option<Format>,
    headers: &HeaderMap,
    offered: &[Format],
) -> Result<Format, Problem> {
    let names = || {
        offered
            .iter()
            .map(|format| format.media_type())
            .collect::<Vec<_>>()
            .join(", ")
    };
    if let Some(format) = asked {
        return if offered.contains(&format) {
            Ok(format)
        } else {
            Err(Problem::new(
                Code::NotAcceptable,
                format!("format: this is available as {}", names()),
            ))
        };
    }
    let accept: Vec<&str> = headers
        .get_all(header::ACCEPT)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .collect();
    let accept = accept.join(",");
    if accept.trim().is_empty() {
        return Ok(offered[0]);
    }
    let mut best = (0.0, offered[0]);
    for &format in offered {
        let quality = quality(&accept, format.media_type());
        if quality > best.0 {
            best = (quality, format);
        }
    }
    if best.0 > 0.0 {
        Ok(best.1)
    } else {
        Err(Problem::new(
            Code::NotAcceptable,
            format!("Accept: this is available as {}", names()),
        ))
    }
}

/// The quality that `accept` gives a media type, by its most specific range (RFC 9110, 12.5.1).
fn quality(accept: &str, media_type: &str) -> f32 {
    let kind = media_type.split('/').next().unwrap_or_default();
    let mut best = (0, 0.0);
    for range in accept.split(',') {
        let mut parts = range
            .split(';')
            .map(|part| part.trim().to_ascii_lowercase());
        let name = parts.next().unwrap_or_default();
        let specificity = match name.as_str() {
            name if name == media_type => 3,
            name if name.strip_suffix("/*") == Some(kind) => 2,
            "*/*" => 1,
            _ => continue,
        };
        let quality = parts.find_map(|part| part.strip_prefix("q=")?.trim().parse().ok());
        if specificity > best.0 {
            best = (specificity, quality.unwrap_or(1.0));
        }
    }
    best.1
}

/// An answer that is made for the asking, and not to be cached.
pub(crate) fn plain(format: Format, body: Vec<u8>) -> Response {
    let mut response = body.into_response();
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_TYPE, format.content_type());
    response
}

/// An answer that never changes: with an `ETag`, or without a body if the client has it already.
pub(crate) fn cacheable(request: &HeaderMap, format: Format, body: impl Into<Vec<u8>>) -> Response {
    cacheable_as(request, format.content_type(), body)
}

/// As [`cacheable`], of any media type.
pub(crate) fn cacheable_as(
    request: &HeaderMap,
    media_type: HeaderValue,
    body: impl Into<Vec<u8>>,
) -> Response {
    let body = body.into();
    let digest = hex::encode(&Sha256::digest(&body)[..16]);
    // weak: the same content goes out compressed or not
    let etag = format!("W/\"{digest}\"");
    let known = request
        .get_all(header::IF_NONE_MATCH)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(','))
        .any(|tag| tag.trim() == "*" || tag.trim().trim_start_matches("W/") == &etag[2..]);
    let mut response = if known {
        StatusCode::NOT_MODIFIED.into_response()
    } else {
        let mut response = body.into_response();
        response
            .headers_mut()
            .insert(header::CONTENT_TYPE, media_type);
        response
    };
    let headers = response.headers_mut();
    if let Ok(etag) = HeaderValue::from_str(&etag) {
        headers.insert(header::ETAG, etag);
    }
    headers.insert(
        header::CACHE_CONTROL,
        HeaderValue::from_static("private, no-cache"),
    );
    headers.insert(header::VARY, HeaderValue::from_static("accept"));
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    fn accept(value: &'static str) -> Result<Format, Code> {
        let headers = [(header::ACCEPT, HeaderValue::from_static(value))]
            .into_iter()
            .collect();
        choose(None, &headers, &[Format::Json, Format::Csv]).map_err(|_| Code::NotAcceptable)
    }

    #[test]
    fn the_most_specific_range_counts() {
        assert_eq!(accept("*/*"), Ok(Format::Json));
        assert_eq!(accept(""), Ok(Format::Json));
        assert_eq!(accept("text/csv"), Ok(Format::Csv));
        assert_eq!(accept("text/*, application/json;q=0.5"), Ok(Format::Csv));
        assert_eq!(accept("*/*, application/json;q=0.1"), Ok(Format::Csv));
        assert_eq!(accept("text/csv;q=0, */*"), Ok(Format::Json));
        assert_eq!(accept("image/png"), Err(Code::NotAcceptable));
        assert_eq!(accept(";;q=,,/"), Err(Code::NotAcceptable));
    }

    #[test]
    fn who_has_it_gets_no_body() {
        let first = cacheable(&HeaderMap::new(), Format::Json, "{}");
        let etag = first.headers()[header::ETAG].clone();
        let again = |value| {
            let headers = [(header::IF_NONE_MATCH, value)].into_iter().collect();
            cacheable(&headers, Format::Json, "{}").status()
        };
        assert_eq!(again(etag), StatusCode::NOT_MODIFIED);
        assert_eq!(again(HeaderValue::from_static("\"other\"")), StatusCode::OK);
    }
}
