//! All routes, and what surrounds them.

use axum::Router;
use axum::http::{HeaderName, HeaderValue, Request};
use axum::middleware::{from_fn, from_fn_with_state, map_request};
use axum::response::IntoResponse;
use tower_http::catch_panic::CatchPanicLayer;
use tower_http::compression::CompressionLayer;
use tower_http::csrf::{CsrfLayer, ProtectionError};
use tower_http::request_id::{
    MakeRequestId, PropagateRequestIdLayer, RequestId, SetRequestIdLayer,
};
use tower_http::trace::TraceLayer;
use utoipa_swagger_ui::SwaggerUi;

use super::code::Code;
use super::middleware::{admission, count, drain, headers, once};
use super::origin::Origin;
use super::problem::{self, Problem};
use super::service::Server;
use super::{handlers, openapi, pages};

pub(super) fn router(server: Server) -> Router {
    let (api, _) = handlers::api().split_for_parts();
    let docs = SwaggerUi::new("/docs").url("/openapi.json", openapi::document());
    let origins = server.config.origins.clone();
    let cross_origin = forgery_guard(&origins).with_rejection_response(|_: ProtectionError| {
        let detail = "a browser sent this for a page of another origin; use the service's own pages, or no browser";
        Problem::new(Code::CrossOrigin, detail).into_response()
    });
    let request_id = HeaderName::from_static("x-request-id");
    let [of_once, of_callers, of_counts] = [(); 3].map(|()| server.clone());
    api.merge(pages::router())
        .with_state(server)
        .merge(docs)
        .fallback(async || problem::unknown_route())
        .method_not_allowed_fallback(async || problem::method_not_allowed())
        // from here on upwards: the last one added is the first to see a request
        .layer(from_fn_with_state(of_once, once::once))
        .layer(from_fn_with_state(of_callers, admission::admit))
        .layer(cross_origin)
        .layer(CatchPanicLayer::custom(Problem::of_panic))
        .layer(from_fn(problem::render))
        .layer(from_fn_with_state(of_counts, count::count))
        .layer(map_request(drain::drain))
        .layer(CompressionLayer::new())
        .layer(headers::cross_origin(&origins))
        .layer(from_fn(headers::guard))
        .layer(TraceLayer::new_for_http().make_span_with(span))
        .layer(PropagateRequestIdLayer::new(request_id.clone()))
        .layer(SetRequestIdLayer::new(request_id, OwnRequestId))
        .layer(map_request(drop_unfit_request_id))
}

/// What is answered over a connection on reserve: whether the service is there, and else that it is busy.
pub(super) fn reserve(server: Server) -> Router {
    let (health, _) = handlers::health::router().split_for_parts();
    let request_id = HeaderName::from_static("x-request-id");
    health
        .with_state(server)
        .fallback(async || problem::no_connection_left())
        .layer(from_fn(problem::render))
        .layer(from_fn(headers::guard))
        .layer(PropagateRequestIdLayer::new(request_id.clone()))
        .layer(SetRequestIdLayer::new(request_id, OwnRequestId))
        .layer(map_request(drop_unfit_request_id))
}

/// Refuses what a page of another site has a browser send, other than of these.
fn forgery_guard(origins: &[Origin]) -> CsrfLayer {
    let mut guard = CsrfLayer::new();
    for origin in origins {
        match guard.clone().add_trusted_origin(origin.as_str()) {
            Ok(trusting) => guard = trusting,
            Err(error) => tracing::warn!(%error, origin = origin.as_str(), "not trusted"),
        }
    }
    guard
}

/// Requests are told apart in the log by their id.
fn span<B>(request: &Request<B>) -> tracing::Span {
    let id = request.extensions().get::<RequestId>();
    let id = id
        .and_then(|id| id.header_value().to_str().ok())
        .unwrap_or_default();
    let (method, path) = (request.method(), request.uri().path());
    // who asks is not known yet
    let (project, key) = (tracing::field::Empty, tracing::field::Empty);
    tracing::info_span!("request", id, %method, path, project, key)
}

/// UUID v7: the log can be searched by time.
#[derive(Clone, Copy)]
struct OwnRequestId;

impl MakeRequestId for OwnRequestId {
    fn make_request_id<B>(&mut self, _: &Request<B>) -> Option<RequestId> {
        let id = uuid::Uuid::now_v7().to_string();
        HeaderValue::from_str(&id).ok().map(RequestId::new)
    }
}

/// A client may bring its own request id, as long as it is short and plain.
async fn drop_unfit_request_id<B>(mut request: Request<B>) -> Request<B> {
    let fits = |value: &HeaderValue| {
        let plain = |byte: &u8| byte.is_ascii_alphanumeric() || b"-_.:".contains(byte);
        (1..=64).contains(&value.len()) && value.as_bytes().iter().all(plain)
    };
    let headers = request.headers_mut();
    if headers.get("x-request-id").is_some_and(|id| !fits(id)) {
        headers.remove("x-request-id");
    }
    request
}
