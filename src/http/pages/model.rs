//! `/models/{id}`: the page of a model, and how another differs from it.

use axum::Router;
use axum::response::Html;
use axum::routing::get;
use serde::Deserialize;
use uuid::Uuid;

use crate::dashboard::{Comparison, ModelView, OtherModel, model_page};
use crate::diagnose::difference;
use crate::http::handlers::jobs::job;
use crate::http::handlers::jobs::results;
use crate::http::handlers::models::{find, page, unknown_model};
use crate::http::problem::Problem;
use crate::http::request::query::{Id, LONGEST_PAGE, Parameters, bad_cursor, unknown_job};
use crate::http::service::{Server, Service};
use crate::model::ModelDocument;
use crate::store::{Part, Search};

pub(super) fn router() -> Router<Server> {
    Router::new().route("/models/{id}", get(get_model_page))
}

/// What begins the reference to the model as estimated in a job.
const OF_A_JOB: &str = "job:";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Query {
    /// Another model, or `job:` and the id of a job; empty where a form has none chosen.
    #[serde(default)]
    against: String,
}

async fn get_model_page(
    service: Service,
    Id(id): Id,
    Parameters(query): Parameters<Query>,
) -> Result<Html<String>, Problem> {
    let document = find(&service, &id).await?;
    let document = document.ok_or_else(|| unknown_model(&id))?;
    let listed = page(&service, &Search::default(), None, LONGEST_PAGE).await?;
    let listed = listed.map_err(bad_cursor)?.entries.into_iter();
    let others = listed
        .filter(|model| model.id != id)
        .map(|model| OtherModel {
            reference: model.id,
            name: model.document.name,
            created: model.created,
        });
    let others = others.collect();
    let against = if query.against.is_empty() {
        None
    } else {
        Some(other(&service, &query.against).await?)
    };
    let render = move || {
        let against = against.map(|other| Comparison {
            changes: difference(&document, &other.document),
            ..other
        });
        model_page(&ModelView {
            id,
            document,
            others,
            against,
        })
    };
    Ok(Html(service.compute.run(render).await?))
}

/// The other model of a comparison, not yet compared.
async fn other(service: &Service, reference: &str) -> Result<Comparison, Problem> {
    let (document, name, address): (ModelDocument, _, _) =
        if let Some(job) = reference.strip_prefix(OF_A_JOB) {
            let id = Uuid::parse_str(job).map_err(|_| unknown_job(job))?;
            let record = job::find(service, id).await?;
            let text = results::part(service, id, Part::Model).await?;
            let name = if record.name.is_empty() {
                id.to_string()
            } else {
                record.name
            };
            let name = format!("the model as estimated in the job {name}");
            (serde_json::from_str(&text)?, name, format!("/jobs/{id}"))
        } else {
            let document = find(service, reference).await?;
            let document = document.ok_or_else(|| unknown_model(reference))?;
            let name = document.name.clone();
            (document, name, format!("/models/{reference}"))
        };
    Ok(Comparison {
        reference: reference.to_string(),
        name,
        address,
        document,
        changes: Vec::new(),
    })
}
