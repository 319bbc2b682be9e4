//! `/v1/models`: model documents, those that come with Trimtab and those that users keep here.

use axum::Json;
use axum::body::Body;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;
use uuid::Uuid;

use crate::http::answer::format::{Format, cacheable, choose};
use crate::http::code::Code;
use crate::http::middleware::once::NewId;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::body;
use crate::http::request::json;
use crate::http::request::query::{Id, Parameters, bad_cursor, page_limit, search};
use crate::http::service::{Server, Service};
use crate::job::Faults;
use crate::model::{Model, ModelDocument, catalog};
use crate::store::{BadCursor, ModelRecord, Page, Search, StoreError};

/// Of what a TOML reader says, in characters.
const LONGEST_DETAIL: usize = 500;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(add_model, list_models))
        .routes(routes!(get_model, delete_model))
}

/// A model as lists show it; the document itself is at `links.self`.
#[derive(Serialize, ToSchema)]
pub(crate) struct ModelResource {
    /// What a job says in `model`: a catalog name, or the id of a stored model.
    #[schema(example = "short-period")]
    id: String,
    /// Where it comes from.
    origin: ModelOrigin,
    /// The document's `name`.
    #[schema(example = "short-period")]
    name: String,
    /// What it is, in a line.
    #[schema(example = "Longitudinal short period, two states")]
    title: String,
    /// When it was stored; a catalog model has no such time.
    #[schema(example = "2026-11-21T12:00:00.123Z")]
    created: Option<String>,
    /// Names of the inputs, in the order of the document.
    #[schema(example = json!(["de"]))]
    inputs: Vec<String>,
    /// Names of the outputs, in the order of the document.
    #[schema(example = json!(["alpha", "q"]))]
    outputs: Vec<String>,
    /// Names of the parameters, in the order of the document.
    #[schema(example = json!(["Zalpha", "Zq", "Zde"]))]
    parameters: Vec<String>,
    /// Where the rest of it is.
    links: ModelLinks,
}

/// Where a model comes from.
#[derive(Clone, Copy, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
#[schema(as = Origin)]
pub(crate) enum ModelOrigin {
    /// Comes with Trimtab.
    Catalog,
    /// Was stored here.
    Stored,
}

/// Paths of what there is of a model.
#[derive(Serialize, ToSchema)]
struct ModelLinks {
    /// The document.
    #[serde(rename = "self")]
    this: String,
}

/// A model of the list, whole.
pub(crate) struct Listed {
    /// A catalog name, or the id of a stored model.
    pub id: String,
    /// When it was stored; absent of a catalog model.
    pub created: Option<String>,
    pub document: ModelDocument,
}

impl Listed {
    fn stored(record: ModelRecord) -> Self {
        Self {
            id: record.id.to_string(),
            created: Some(record.created),
            document: record.document,
        }
    }

    fn of_catalog(document: &ModelDocument) -> Self {
        Self {
            id: document.name.clone(),
            created: None,
            document: document.clone(),
        }
    }
}

impl From<Listed> for ModelResource {
    fn from(model: Listed) -> Self {
        let document = model.document;
        Self {
            links: ModelLinks {
                this: format!("/v1/models/{}", model.id),
            },
            id: model.id,
            origin: match model.created {
                Some(_) => ModelOrigin::Stored,
                None => ModelOrigin::Catalog,
            },
            created: model.created,
            inputs: document.inputs.into_keys().collect(),
            outputs: document.outputs.into_keys().collect(),
            parameters: document.parameters.into_keys().collect(),
            name: document.name,
            title: document.title,
        }
    }
}

/// A page of models.
#[derive(Serialize, ToSchema)]
pub(crate) struct ModelPage {
    /// Those of the catalog first, then stored ones, newest first.
    models: Vec<ModelResource>,
    /// What to say in `cursor` for the next page; `null`: this is the last.
    next_cursor: Option<String>,
}

/// Store a model.
///
/// The document is compiled first: what would keep it from being simulated is said at once, all of it.
#[utoipa::path(post, path = "/v1/models", tag = "Models", operation_id = "addModel",
    request_body(content((ModelDocument = "application/json"), (String = "application/toml"))),
    responses(
        (status = 201, description = "It is stored.", body = ModelResource, headers(("Location" = String, description = "Its path."))),
        (status = 400, description = "`invalid_json`, `invalid_toml`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`wrong_shape`, `invalid_model`: `errors` lists the faults by JSON pointer.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn add_model(
    service: Service,
    NewId(id): NewId,
    headers: HeaderMap,
    body: Body,
) -> Result<Response, Problem> {
    let media_type = body::media_type(&headers);
    let read: fn(&str) -> Result<ModelDocument, Problem> = match media_type.as_str() {
        "application/json" => json::parse,
        "application/toml" => parse_toml,
        other => {
            return Err(body::unsupported(
                other,
                &["application/json", "application/toml"],
            ));
        }
    };
    let limit = service.config.max_json_body;
    let body = body::read(&headers, body, limit, "--max-json-body", &service.room).await?;
    let (bytes, _room) = (body.bytes, body.room);
    let text = json::text(bytes)?;
    let check = move || {
        let document = read(&text)?;
        check_model(&document).map_err(|faults| Problem::of_faults(Code::InvalidModel, faults))?;
        Ok::<_, Problem>(document)
    };
    let document = service.compute.run(check).await??;
    let record = service.store.add_model(id, document).await?;
    let model = ModelResource::from(Listed::stored(record));
    let location = [(header::LOCATION, model.links.this.clone())];
    Ok((StatusCode::CREATED, location, Json(model)).into_response())
}

/// Compiles a model by itself; the pointers of its faults are into the document.
pub(crate) fn check_model(document: &ModelDocument) -> Result<(), Faults> {
    Model::compile(document).map(drop)
}

fn parse_toml(text: &str) -> Result<ModelDocument, Problem> {
    json::refuse_nul(text)?;
    // its message shows the line
    toml::from_str(text).map_err(|error| {
        // the message repeats the line at fault, however long that is
        let detail: String = error.to_string().chars().take(LONGEST_DETAIL).collect();
        Problem::new(Code::InvalidToml, detail)
    })
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct ListQuery {
    /// `next_cursor` of the page before; absent: the first page.
    cursor: Option<String>,
    /// Models of the page, 1 to 200; 50 if absent.
    #[param(minimum = 1, maximum = 200)]
    limit: Option<usize>,
    /// Only those that have each of these words in their name or title, upper case or lower.
    #[param(max_length = 200, example = "short period")]
    q: Option<String>,
}

/// List models: the catalog, then what was stored, newest first.
#[utoipa::path(get, path = "/v1/models", tag = "Models", operation_id = "listModels",
    params(ListQuery),
    responses((status = 200, description = "A page.", body = ModelPage)))]
async fn list_models(
    service: Service,
    Parameters(query): Parameters<ListQuery>,
) -> Result<Json<ModelPage>, Problem> {
    let limit = page_limit(query.limit)?;
    let search = search(query.q.as_deref())?;
    let page = page(&service, &search, query.cursor.as_deref(), limit)
        .await?
        .map_err(bad_cursor)?;
    Ok(Json(ModelPage {
        models: page.entries.into_iter().map(ModelResource::from).collect(),
        next_cursor: page.next_cursor,
    }))
}

/// What a search finds of the catalog, then of what was stored. The cursor of a catalog model is its name, that of a stored one its id.
pub(crate) async fn page(
    service: &Service,
    search: &Search,
    cursor: Option<&str>,
    limit: usize,
) -> Result<Result<Page<Listed>, BadCursor>, StoreError> {
    let catalog = catalog::all();
    let behind_name = |name| {
        catalog
            .iter()
            .position(|model| model.name == name)
            .map(|at| at + 1)
    };
    let (from, before) = match cursor {
        None => (0, None),
        Some(text) => match (behind_name(text), Uuid::parse_str(text)) {
            (Some(from), _) => (from, None),
            (None, Ok(id)) => (catalog.len(), Some(id)),
            (None, Err(_)) => return Ok(Err(BadCursor)),
        },
    };
    let found = catalog[from..].iter().filter(|model| {
        let words = format!("{}\n{}", model.name, model.title);
        search.finds(&words)
    });
    let mut models: Vec<_> = found.map(Listed::of_catalog).collect();
    if models.len() <= limit {
        // one more than fits tells whether there is another page
        let stored = service
            .store
            .models(search, before, limit + 1 - models.len())
            .await?;
        models.extend(stored.entries.into_iter().map(Listed::stored));
    }
    Ok(Ok(Page::new(models, limit, |model| model.id.clone())))
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct DocumentQuery {
    /// `json` or `toml`; absent: as `Accept` says.
    #[param(inline)]
    format: Option<Format>,
}

/// A model document, as JSON or as TOML.
#[utoipa::path(get, path = "/v1/models/{id}", tag = "Models", operation_id = "getModel",
    params(("id" = String, Path, description = "A catalog name, or the id of a stored model.", example = "short-period"), DocumentQuery),
    responses(
        (status = 200, description = "The document.", content((ModelDocument = "application/json"), (String = "application/toml"))),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 404, description = "`unknown_model`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_model(
    service: Service,
    Id(id): Id,
    Parameters(query): Parameters<DocumentQuery>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let format = choose(query.format, &headers, &[Format::Json, Format::Toml])?;
    if let (Format::Toml, Some(text)) = (format, catalog::text(&id)) {
        // as it was written, comments and all
        return Ok(cacheable(&headers, format, text));
    }
    let document = find(&service, &id)
        .await?
        .ok_or_else(|| unknown_model(&id))?;
    document_as(format, &headers, &document)
}

/// Delete a stored model.
///
/// Jobs that name it are what they were: each keeps the document as it was submitted. Models of the catalog stay.
#[utoipa::path(delete, path = "/v1/models/{id}", tag = "Models", operation_id = "deleteModel",
    params(("id" = String, Path, description = "The id of a stored model.", example = "0193518e-6b6f-7d3c-9c53-b1cbb2b7a1f4")),
    responses(
        (status = 204, description = "It is gone."),
        (status = 404, description = "`unknown_model`: none of this id is stored.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`of_catalog`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn delete_model(service: Service, Id(id): Id) -> Result<StatusCode, Problem> {
    if catalog::find(&id).is_some() {
        let detail = format!(
            "'{id}' is a model of the catalog, which comes with Trimtab; only stored models can be deleted"
        );
        return Err(Problem::new(Code::OfCatalog, detail));
    }
    match Uuid::parse_str(&id) {
        Ok(stored) if service.store.delete_model(stored).await? => Ok(StatusCode::NO_CONTENT),
        _ => Err(unknown_model(&id)),
    }
}

pub(crate) fn unknown_model(id: &str) -> Problem {
    let id: String = id.chars().take(80).collect();
    let detail = format!(
        "there is no model '{id}'; name a catalog model by its name, a stored one by its id"
    );
    Problem::new(Code::UnknownModel, detail)
}

/// A model by its catalog name or its id.
pub(crate) async fn find(service: &Service, id: &str) -> Result<Option<ModelDocument>, StoreError> {
    if let Some(document) = catalog::find(id) {
        return Ok(Some(document));
    }
    let Ok(id) = Uuid::parse_str(id) else {
        return Ok(None);
    };
    Ok(service.store.model(id).await?.map(|record| record.document))
}

pub(crate) fn document_as(
    format: Format,
    headers: &HeaderMap,
    document: &ModelDocument,
) -> Result<Response, Problem> {
    let text = match format {
        Format::Toml => toml::to_string_pretty(document).map_err(|error| {
            tracing::error!(%error, "toml");
            Problem::internal()
        })?,
        _ => serde_json::to_string(document)?,
    };
    Ok(cacheable(headers, format, text))
}
