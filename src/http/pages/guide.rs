//! `/guide`: the documentation.

use axum::Router;
use axum::http::{HeaderMap, HeaderValue};
use axum::response::{Html, Response};
use axum::routing::get;

use crate::dashboard::{guide_page, guide_picture};
use crate::http::answer::format::cacheable_as;
use crate::http::problem::{Problem, unknown_route};
use crate::http::request::query::Id;
use crate::http::service::Server;

pub(super) fn router() -> Router<Server> {
    Router::new()
        .route("/guide", get(async || shown("index")))
        .route("/guide/{page}", get(async |Id(page): Id| shown(&page)))
        .route("/guide/pictures/{name}", get(get_picture))
}

fn shown(page: &str) -> Result<Html<String>, Problem> {
    guide_page(page).map(Html).ok_or_else(unknown_route)
}

async fn get_picture(Id(name): Id, headers: HeaderMap) -> Result<Response, Problem> {
    let picture = guide_picture(&name).ok_or_else(unknown_route)?;
    let media_type = HeaderValue::from_static("image/png");
    Ok(cacheable_as(&headers, media_type, picture))
}
