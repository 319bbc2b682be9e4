//! `/new`: the page where a job is made.

use axum::Router;
use axum::response::Html;
use axum::routing::get;

use crate::dashboard::new_job_page;
use crate::http::service::Server;

pub(super) fn router() -> Router<Server> {
    Router::new().route("/new", get(async || Html(new_job_page())))
}
