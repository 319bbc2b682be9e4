//! `/models`: the page of all models.

use axum::Router;
use axum::response::Html;
use axum::routing::get;
use serde::Deserialize;

use crate::dashboard::{Draft, ModelRow, ModelsView, models_page};
use crate::http::handlers::models::{Listed, find, page, unknown_model};
use crate::http::problem::Problem;
use crate::http::request::query::{Parameters, bad_cursor, search};
use crate::http::service::{Server, Service};
use crate::model::catalog;

pub(super) fn router() -> Router<Server> {
    Router::new().route("/models", get(get_models_page))
}

/// Models of a page.
const MODELS: usize = 50;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Query {
    cursor: Option<String>,
    #[serde(default)]
    q: String,
    /// A model to begin an own one with.
    from: Option<String>,
}

async fn get_models_page(
    service: Service,
    Parameters(query): Parameters<Query>,
) -> Result<Html<String>, Problem> {
    let search = search(Some(&query.q))?;
    let page = page(&service, &search, query.cursor.as_deref(), MODELS).await?;
    let page = page.map_err(bad_cursor)?;
    let draft = match &query.from {
        Some(id) => Some(draft(&service, id).await?),
        None => None,
    };
    let older = page.next_cursor.map(|cursor| {
        let mut form = form_urlencoded::Serializer::new(String::from("/models?"));
        if !query.q.is_empty() {
            form.append_pair("q", &query.q);
        }
        form.append_pair("cursor", &cursor);
        form.finish()
    });
    let view = ModelsView {
        models: page.entries.into_iter().map(row).collect(),
        is_later_page: query.cursor.is_some(),
        draft,
        q: query.q,
        older,
    };
    Ok(Html(service.compute.run(move || models_page(&view)).await?))
}

fn row(model: Listed) -> ModelRow {
    let document = model.document;
    let free = document.parameters.values();
    ModelRow {
        id: model.id,
        created: model.created,
        free: free.filter(|parameter| !parameter.fixed).count(),
        states: document.states.into_keys().collect(),
        inputs: document.inputs.into_keys().collect(),
        outputs: document.outputs.into_keys().collect(),
        name: document.name,
        title: document.title,
    }
}

/// A model as text to be changed.
async fn draft(service: &Service, id: &str) -> Result<Draft, Problem> {
    let document = find(service, id).await?;
    let document = document.ok_or_else(|| unknown_model(id))?;
    let text = match catalog::text(id) {
        Some(text) => text.to_string(),
        None => toml::to_string_pretty(&document).map_err(|error| {
            tracing::error!(%error, "toml");
            Problem::internal()
        })?,
    };
    Ok(Draft {
        name: document.name,
        text,
    })
}
