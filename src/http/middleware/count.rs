//! Counting what is asked and how soon it is answered.

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
    server.metrics.answered(&route, seconds);
    response
}
