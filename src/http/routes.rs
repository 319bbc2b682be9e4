//! All routes, and what surrounds them.

use axum::Router;
use axum::http::{HeaderName, HeaderValue, Request};
use axum::middleware;
use axum::response::{IntoResponse, Redirect};
use axum::routing::get;
use tower_http::catch_panic::CatchPanicLayer;
use tower_http::compression::CompressionLayer;
use tower_http::csrf::{CsrfLayer, ProtectionError};
use tower_http::request_id::{
    MakeRequestId, PropagateRequestIdLayer, RequestId, SetRequestIdLayer,
};
use tower_http::set_header::SetResponseHeaderLayer;
use tower_http::trace::TraceLayer;
use utoipa_axum::router::OpenApiRouter;
use utoipa_swagger_ui::SwaggerUi;

use super::code::Code;
use super::problem::{self, Problem};
use super::{
    Service, coefficients, diagnosis, events, health, histories, jobs, maneuvers, models, once,
    problems, residual_analysis, results, study, submit,
};

/// Every resource.
pub(super) fn api() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .merge(maneuvers::router())
        .merge(models::router())
        .merge(submit::router())
        .merge(jobs::router())
        .merge(events::router())
        .merge(results::router())
        .merge(study::router())
        .merge(diagnosis::router())
        .merge(coefficients::router())
        .merge(histories::router())
        .merge(residual_analysis::router())
        .merge(problems::router())
        .merge(health::router())
}

pub(super) fn router(service: Service) -> Router {
    let (api, _) = api().split_for_parts();
    let docs = SwaggerUi::new("/docs").url("/openapi.json", super::document());
    let cross_origin = CsrfLayer::new().with_rejection_response(|_: ProtectionError| {
        let detail = "a browser sent this for a page of another origin; use the service's own pages, or no browser";
        Problem::new(Code::CrossOrigin, detail).into_response()
    });
    let request_id = HeaderName::from_static("x-request-id");
    let nosniff = HeaderValue::from_static("nosniff");
    let of_keys = service.clone();
    api.merge(super::pages::router())
        .with_state(service)
        .merge(docs)
        .route("/", get(|| async { Redirect::temporary("/docs/") }))
        .fallback(async || problem::unknown_route())
        .method_not_allowed_fallback(async || problem::method_not_allowed())
        // from here on upwards: the last one added is the first to see a request
        .layer(middleware::from_fn_with_state(of_keys, once::once))
        .layer(cross_origin)
        .layer(CatchPanicLayer::custom(Problem::of_panic))
        .layer(middleware::from_fn(problem::render))
        .layer(CompressionLayer::new())
        .layer(SetResponseHeaderLayer::overriding(
            HeaderName::from_static("x-content-type-options"),
            nosniff,
        ))
        .layer(TraceLayer::new_for_http().make_span_with(span))
        .layer(PropagateRequestIdLayer::new(request_id.clone()))
        .layer(SetRequestIdLayer::new(request_id, OwnRequestId))
        .layer(middleware::map_request(drop_unfit_request_id))
}

/// Requests are told apart in the log by their id.
fn span<B>(request: &Request<B>) -> tracing::Span {
    let id = request.extensions().get::<RequestId>();
    let id = id
        .and_then(|id| id.header_value().to_str().ok())
        .unwrap_or_default();
    tracing::info_span!("request", id, method = %request.method(), path = request.uri().path())
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
