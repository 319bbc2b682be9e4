//! Counting and logging what is asked and how soon it is answered.

use std::time::Instant;

use axum::extract::{MatchedPath, Request, State};
use axum::middleware::Next;
use axum::response::Response;

use crate::http::metrics::Route;
use crate::http::service::Server;

/// Counts every request.
pub(crate) async fn count(State(server): State<Server>, request: Request, next: Next) -> Response {
    let began = Instant::now();
    let route = request.extensions().get::<MatchedPath>();
    let route = route.map_or("none", MatchedPath::as_str).to_string();
    // methods are anybody's invention: only those that are known become a label
    let method = match request.method().as_str() {
        known @ ("GET" | "POST" | "DELETE" | "HEAD" | "OPTIONS") => known,
        _ => "other",
    };
    let method = method.to_string();
    let response = next.run(request).await;
    let route = Route {
        method,
        route,
        status: response.status().as_u16(),
    };
    let seconds = began.elapsed().as_secs_f64();
    log(&route, seconds);
    server.metrics.answered(&route, seconds);
    response
}

/// One line for a request, within the span that has its id, path, project and key. That somebody looks every few seconds
/// whether the service is there is not worth one.
fn log(
    Route {
        method,
        route,
        status,
    }: &Route,
    seconds: f64,
) {
    let ms = (seconds * 1e6).round() / 1e3;
    if route.starts_with("/health") {
        tracing::debug!(method, route, status, ms, "answered");
    } else {
        tracing::info!(method, route, status, ms, "answered");
    }
}
