//! `/maneuvers`: the page of all maneuvers, and of uploads.

use axum::Router;
use axum::response::Html;
use axum::routing::get;
use serde::Deserialize;

use crate::dashboard::{ManeuverRow, ManeuversView, maneuvers_page};
use crate::http::handlers::mappings;
use crate::http::problem::Problem;
use crate::http::request::query::{Parameters, bad_cursor, search};
use crate::http::service::{Server, Service};
use crate::store::{ManeuverFilter, ManeuverRecord};

pub(super) fn router() -> Router<Server> {
    Router::new().route("/maneuvers", get(get_maneuvers_page))
}

/// Maneuvers of a page.
const MANEUVERS: usize = 50;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Query {
    #[serde(default)]
    q: String,
    cursor: Option<String>,
}

async fn get_maneuvers_page(
    service: Service,
    Parameters(query): Parameters<Query>,
) -> Result<Html<String>, Problem> {
    let cursor = query.cursor.as_deref();
    let filter = ManeuverFilter {
        search: search(Some(&query.q))?,
        ..ManeuverFilter::default()
    };
    let page = service.store.maneuvers(&filter, cursor, MANEUVERS).await?;
    let page = page.map_err(bad_cursor)?;
    let older = page.next_cursor.map(|cursor| {
        let mut form = form_urlencoded::Serializer::new(String::new());
        if !query.q.is_empty() {
            form.append_pair("q", &query.q);
        }
        form.append_pair("cursor", &cursor);
        format!("/maneuvers?{}", form.finish())
    });
    let mappings = mappings::all(&service).await?.into_iter();
    let mappings = mappings.map(|mapping| (mapping.name, mapping.about));
    let mappings = mappings.collect();
    let render = move || {
        let maneuvers = page.entries.into_iter().map(row);
        maneuvers_page(&ManeuversView {
            maneuvers: maneuvers.collect(),
            mappings,
            is_later_page: query.cursor.is_some(),
            q: query.q,
            older,
        })
    };
    Ok(Html(service.compute.run(render).await?))
}

fn row(record: ManeuverRecord) -> ManeuverRow {
    let summary = serde_json::from_str(&record.summary);
    ManeuverRow {
        summary: summary
            .inspect_err(|error| tracing::error!(%error, maneuver = record.id, "its summary"))
            .ok(),
        id: record.id,
        name: record.name,
        created: record.created,
    }
}
