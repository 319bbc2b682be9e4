//! Who asks, and whether they may: found out before any handler is reached.

use axum::extract::{FromRequestParts, Request, State};
use axum::http::request::Parts;
use axum::http::{HeaderMap, HeaderValue, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;

use crate::http::caller::{Caller, needed};
use crate::http::code::Code;
use crate::http::problem::Problem;
use crate::http::service::{Server, Service};
use crate::store::KeyCheck;

/// Lets a request through to its handler if it may, and tells the handler who sent it.
pub(crate) async fn admit(
    State(server): State<Server>,
    mut request: Request,
    next: Next,
) -> Response {
    let Some(needed) = needed(request.method(), request.uri().path()) else {
        return next.run(request).await;
    };
    let is_page = !request.uri().path().starts_with("/v1/");
    match identify(&server, request.headers(), is_page).await {
        Ok(caller) if caller.scopes.contains(&needed) => {
            let span = tracing::Span::current();
            span.record("project", &caller.project);
            span.record("key", caller.submitter());
            request.extensions_mut().insert(caller);
            next.run(request).await
        }
        Ok(caller) => {
            let has: Vec<&str> = caller.scopes.iter().map(|scope| scope.name()).collect();
            let detail = format!(
                "this needs a key with the scope '{}'; this one has {}",
                needed.name(),
                has.join(", ")
            );
            Problem::new(Code::ScopeMissing, detail).into_response()
        }
        Err(problem) => problem.into_response(),
    }
}

async fn identify(server: &Server, headers: &HeaderMap, is_page: bool) -> Result<Caller, Problem> {
    let Some(key) = shown(headers)? else {
        if server.store.has_keys().await? {
            let detail = "this needs a key: send it as 'Authorization: Bearer KEY', or as the password of HTTP basic authentication";
            return Err(challenge(detail, is_page));
        }
        if !names_this_machine(headers) {
            let detail = "without keys the service answers only to the names of this machine (localhost, 127.0.0.1, [::1]), so that no web page can reach it by another name; make a key with 'trimtab key new', and other names may be used";
            return Err(Problem::new(Code::UnknownHost, detail));
        }
        return Ok(Caller::without_key());
    };
    let refused = match server.store.look_up_key(&key).await? {
        KeyCheck::Good(record) => {
            server.rates.check(record.id)?;
            return Ok(Caller {
                project: record.project,
                key: Some(record.id),
                scopes: record.scopes,
                max_priority: record.max_priority,
            });
        }
        KeyCheck::Unknown => "there is no such key; 'trimtab key new' makes one",
        KeyCheck::Revoked => "the key was revoked",
        KeyCheck::Expired => "the key has expired; 'trimtab key new' makes another",
    };
    Err(challenge(refused, is_page))
}

/// The key of a request, as a bearer token or as the password that a browser asks for.
fn shown(headers: &HeaderMap) -> Result<Option<String>, Problem> {
    let Some(value) = headers.get(header::AUTHORIZATION) else {
        return Ok(None);
    };
    let read = || {
        let (scheme, rest) = value.to_str().ok()?.split_once(' ')?;
        if scheme.eq_ignore_ascii_case("bearer") {
            return Some(rest.trim().to_string());
        }
        if !scheme.eq_ignore_ascii_case("basic") {
            return None;
        }
        let decoded = BASE64_STANDARD.decode(rest.trim()).ok()?;
        let decoded = String::from_utf8(decoded).ok()?;
        decoded.split_once(':').map(|(_, key)| key.to_string())
    };
    match read() {
        Some(key) => Ok(Some(key)),
        None => {
            let detail =
                "Authorization: 'Bearer KEY', or 'Basic' with any user and the key as password";
            Err(Problem::new(Code::InvalidHeader, detail))
        }
    }
}

/// A browser that opens a page asks its user; a program is told what it lacks.
fn challenge(detail: &str, is_page: bool) -> Problem {
    let how = if is_page {
        "Basic realm=\"Trimtab: leave the user empty, the password is your key\", charset=\"UTF-8\""
    } else {
        "Bearer realm=\"Trimtab\""
    };
    Problem::new(Code::KeyNeeded, detail)
        .with_header(header::WWW_AUTHENTICATE, HeaderValue::from_static(how))
}

/// Whether the client believes to speak to this machine: a page of another site that had its own name resolved to it
/// (DNS rebinding) does not.
fn names_this_machine(headers: &HeaderMap) -> bool {
    let host = headers
        .get(header::HOST)
        .and_then(|host| host.to_str().ok());
    let Some(host) = host else { return true };
    name_of(host).is_some_and(|name| {
        let is_loopback = |ip: std::net::IpAddr| ip.is_loopback();
        name.eq_ignore_ascii_case("localhost") || name.parse().is_ok_and(is_loopback)
    })
}

/// The host of `host`, `host:port` or `[address]:port` (RFC 9110, 7.2; RFC 3986, 3.2.2); `None` for anything else. A library
/// took `[::1].evil` for `[::1]`.
fn name_of(authority: &str) -> Option<&str> {
    let (name, port) = match authority.strip_prefix('[') {
        Some(rest) => rest.split_once(']')?,
        None => authority.split_at(authority.find(':').unwrap_or(authority.len())),
    };
    let is_port = |port: &str| port.bytes().all(|byte| byte.is_ascii_digit());
    (port.is_empty() || port.strip_prefix(':').is_some_and(is_port)).then_some(name)
}

/// The service as who asks sees it. That there is nobody is a route that [`admit`] does not stand before.
impl FromRequestParts<Server> for Service {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, server: &Server) -> Result<Self, Problem> {
        let caller = parts.extensions.get::<Caller>().cloned();
        let caller = caller.ok_or_else(Problem::internal)?;
        Ok(Self::of(server, caller))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_this_machine_do_without_keys() {
        let of = |host: &'static str| {
            names_this_machine(
                &[(header::HOST, HeaderValue::from_static(host))]
                    .into_iter()
                    .collect(),
            )
        };
        for host in [
            "localhost",
            "LOCALHOST:8300",
            "127.0.0.1:8300",
            "127.9.9.9",
            "[::1]:8300",
            "[::1]",
        ] {
            assert!(of(host), "{host}");
        }
        for host in [
            "lab.example",
            "127.0.0.1.lab.example",
            "10.0.0.1",
            "[::2]",
            "localhost.x",
            "a b",
            "[::1].evil",
            "[::1].evil:8300",
            "[::1]:8300.evil",
            "[127.0.0.1",
            "127.0.0.1:8300:evil",
            "localhost:evil",
            "evil@localhost",
            "localhost@evil",
            "::1",
        ] {
            assert!(!of(host), "{host}");
        }
    }

    #[test]
    fn a_key_comes_as_bearer_or_as_password() {
        let of = |value: &'static str| {
            let headers = [(header::AUTHORIZATION, HeaderValue::from_static(value))];
            shown(&headers.into_iter().collect())
        };
        assert_eq!(of("Bearer abc").unwrap().unwrap(), "abc");
        assert_eq!(of("basic OmFiYw==").unwrap().unwrap(), "abc");
        for unreadable in ["Bearer", "Basic !", "Basic YWJj", "Digest abc"] {
            assert!(of(unreadable).is_err(), "{unreadable}");
        }
    }
}
