//! All routes, and what surrounds them.

use axum::Router;
use axum::http::{HeaderName, HeaderValue, Request};
use axum::middleware;
use axum::response::IntoResponse;
use tower_http::catch_panic::CatchPanicLayer;
use tower_http::compression::CompressionLayer;
use tower_http::csrf::{CsrfLayer, ProtectionError};
use tower_http::request_id::{
    MakeRequestId, PropagateRequestIdLayer, RequestId, SetRequestIdLayer,
};
use tower_http::trace::TraceLayer;
use utoipa_axum::router::OpenApiRouter;
use utoipa_swagger_ui::SwaggerUi;

use super::code::Code;
use super::headers::Origin;
use super::problem::{self, Problem};
use super::{
    Server, bulk, caller, coefficients, diagnosis, drain, events, headers, health, histories, jobs,
    keys, maneuvers, mappings, metrics, models, once, problems, rerun, residual_analysis, results,
    retention, study, submit, webhooks,
};

/// Every resource.
pub(super) fn api() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .merge(maneuvers::router())
        .merge(mappings::router())
        .merge(models::router())
        .merge(submit::router())
        .merge(bulk::router())
        .merge(rerun::router())
        .merge(retention::router())
        .merge(jobs::router())
        .merge(events::router())
        .merge(results::router())
        .merge(study::router())
        .merge(diagnosis::router())
        .merge(coefficients::router())
        .merge(histories::router())
        .merge(residual_analysis::router())
        .merge(problems::router())
        .merge(keys::router())
        .merge(webhooks::router())
        .merge(metrics::router())
        .merge(health::router())
}

pub(super) fn router(server: Server) -> Router {
    let (api, _) = api().split_for_parts();
    let docs = SwaggerUi::new("/docs").url("/openapi.json", super::document());
    let origins = server.config.origins.clone();
    let cross_origin = forgery_guard(&origins).with_rejection_response(|_: ProtectionError| {
        let detail = "a browser sent this for a page of another origin; use the service's own pages, or no browser";
        Problem::new(Code::CrossOrigin, detail).into_response()
    });
    let request_id = HeaderName::from_static("x-request-id");
    let [of_once, of_callers, of_counts] = [(); 3].map(|()| server.clone());
    api.merge(super::pages::router())
        .with_state(server)
        .merge(docs)
        .fallback(async || problem::unknown_route())
        .method_not_allowed_fallback(async || problem::method_not_allowed())
        // from here on upwards: the last one added is the first to see a request
        .layer(middleware::from_fn_with_state(of_once, once::once))
        .layer(middleware::from_fn_with_state(of_callers, caller::admit))
        .layer(cross_origin)
        .layer(CatchPanicLayer::custom(Problem::of_panic))
        .layer(middleware::from_fn(problem::render))
        .layer(middleware::from_fn_with_state(of_counts, metrics::count))
        .layer(middleware::map_request(drain::drain))
        .layer(CompressionLayer::new())
        .layer(headers::cross_origin(&origins))
        .layer(middleware::from_fn(headers::guard))
        .layer(TraceLayer::new_for_http().make_span_with(span))
        .layer(PropagateRequestIdLayer::new(request_id.clone()))
        .layer(SetRequestIdLayer::new(request_id, OwnRequestId))
        .layer(middleware::map_request(drop_unfit_request_id))
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
