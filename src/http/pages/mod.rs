//! Pages for people, one file for each, and `/assets/{name}`: what they load.
//!
//! A page is put together here from what the store has, and rendered in the room `dashboard`.

mod compare;
mod dynamics;
mod guide;
mod job;
mod jobs;
mod maneuver;
mod maneuvers;
mod model;
mod models;
mod new_job;
mod report;

use axum::Router;
use axum::http::{HeaderMap, HeaderValue};
use axum::response::Response;
use axum::routing::get;

use crate::dashboard::asset;
use crate::http::answer::format::cacheable_as;
use crate::http::problem::{Problem, unknown_route};
use crate::http::request::query::Id;
use crate::http::service::Server;

pub(super) fn router() -> Router<Server> {
    Router::new()
        .merge(jobs::router())
        .merge(job::router())
        .merge(compare::router())
        .merge(report::router())
        .merge(dynamics::router())
        .merge(new_job::router())
        .merge(guide::router())
        .merge(maneuvers::router())
        .merge(maneuver::router())
        .merge(models::router())
        .merge(model::router())
        .route("/assets/{name}", get(get_asset))
        .route("/favicon.ico", get(get_mark))
}

async fn get_asset(Id(name): Id, headers: HeaderMap) -> Result<Response, Problem> {
    answer(&name, &headers)
}

/// Where browsers look for it of what names none: a report, an answer in JSON.
async fn get_mark(headers: HeaderMap) -> Result<Response, Problem> {
    answer("mark.svg", &headers)
}

fn answer(name: &str, headers: &HeaderMap) -> Result<Response, Problem> {
    let asset = asset(name).ok_or_else(unknown_route)?;
    let media_type = HeaderValue::from_static(asset.media_type);
    Ok(cacheable_as(headers, media_type, asset.content))
}
