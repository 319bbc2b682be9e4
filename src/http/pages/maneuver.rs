//! `/maneuvers/{id}`: the page of a maneuver.

use axum::Router;
use axum::response::Html;
use axum::routing::get;

use crate::dashboard::{ManeuverView, maneuver_page};
use crate::http::handlers::maneuvers::unknown_maneuver;
use crate::http::problem::Problem;
use crate::http::request::query::Id;
use crate::http::service::{Server, Service};

pub(super) fn router() -> Router<Server> {
    Router::new().route("/maneuvers/{id}", get(get_maneuver_page))
}

async fn get_maneuver_page(service: Service, Id(id): Id) -> Result<Html<String>, Problem> {
    let record = service.store.maneuver(&id).await?;
    let record = record.ok_or_else(|| unknown_maneuver(&id))?;
    let render = move || {
        Ok::<_, Problem>(maneuver_page(&ManeuverView {
            summary: serde_json::from_str(&record.summary)?,
            id: record.id,
            name: record.name,
            created: record.created,
            flown: record.flown,
        }))
    };
    Ok(Html(service.compute.run(render).await??))
}
