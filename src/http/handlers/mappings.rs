//! `/v1/mappings`: where files have their channels, if they do not say it themselves. An upload names one of them.

use axum::Json;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::http::answer::format::{Format, cacheable};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::json::JsonBody;
use crate::http::request::query::{Id, Parameters};
use crate::http::service::{Server, Service};
use crate::ingest::Mapping;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(list_mappings, add_mapping))
        .routes(routes!(get_mapping, delete_mapping))
}

const LONGEST_NAME: usize = 64;

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct NameQuery {
    /// What uploads call it: 1 to 64 letters, digits, '-', '_' and '.'.
    #[param(example = "lab-logger-3")]
    name: String,
}

/// A mapping as lists show it.
#[derive(Serialize, ToSchema)]
#[schema(as = MappingEntry)]
pub(crate) struct MappingResource {
    /// What an upload says in `mapping`.
    #[schema(example = "lab-logger-3")]
    pub name: String,
    /// Which recordings it is for.
    pub about: String,
    /// When it was stored; one that comes with Trimtab has no such time.
    created: Option<String>,
}

/// Mappings that an upload can name.
#[derive(Serialize, ToSchema)]
struct MappingList {
    /// Those that come with Trimtab, then the project's own.
    mappings: Vec<MappingResource>,
}

/// List mappings: those that come with Trimtab, and the project's own.
#[utoipa::path(get, path = "/v1/mappings", tag = "Maneuvers", operation_id = "listMappings",
    responses((status = 200, description = "All of them.", body = MappingList)))]
async fn list_mappings(service: Service) -> Result<Json<MappingList>, Problem> {
    let mappings = all(&service).await?;
    Ok(Json(MappingList { mappings }))
}

/// Those that come with Trimtab, and then the project's own.
pub(crate) async fn all(service: &Service) -> Result<Vec<MappingResource>, Problem> {
    let about = |mapping: &Mapping| mapping.about().to_string();
    let mut mappings = Vec::new();
    for name in Mapping::names() {
        let mapping = Mapping::named_or_json(name).map_err(invalid)?;
        mappings.push(MappingResource {
            name: name.to_string(),
            about: about(&mapping),
            created: None,
        });
    }
    for record in service.store.mappings().await? {
        let mapping = Mapping::from_json(&record.document).map_err(invalid)?;
        mappings.push(MappingResource {
            name: record.name,
            about: about(&mapping),
            created: Some(record.created),
        });
    }
    Ok(mappings)
}

/// Keep a mapping, for uploads to name.
///
/// One is never changed: another document goes by another name, or this one is deleted first.
#[utoipa::path(post, path = "/v1/mappings", tag = "Maneuvers", operation_id = "addMapping",
    params(NameQuery),
    request_body = Mapping,
    responses(
        (status = 201, description = "It is kept.", body = Mapping, headers(("Location" = String, description = "Its path."))),
        (status = 409, description = "`name_taken`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`wrong_shape`, `invalid_mapping`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn add_mapping(
    service: Service,
    Parameters(NameQuery { name }): Parameters<NameQuery>,
    JsonBody { text, .. }: JsonBody<Mapping>,
) -> Result<Response, Problem> {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.".contains(&byte);
    if !(1..=LONGEST_NAME).contains(&name.len()) || !name.bytes().all(plain) {
        let detail = format!("name: 1 to {LONGEST_NAME} letters, digits, '-', '_' and '.'");
        return Err(Problem::new(Code::InvalidQuery, detail));
    }
    Mapping::from_json(&text).map_err(invalid)?;
    let is_bundled = Mapping::names().any(|bundled| bundled == name);
    if is_bundled || !service.store.add_mapping(&name, &text).await? {
        let detail = format!("there is another mapping '{name}'; take another name");
        return Err(Problem::new(Code::NameTaken, detail));
    }
    let location = [
        (header::LOCATION, format!("/v1/mappings/{name}")),
        (header::CONTENT_TYPE, "application/json".to_string()),
    ];
    Ok((StatusCode::CREATED, location, text).into_response())
}

/// A mapping.
#[utoipa::path(get, path = "/v1/mappings/{id}", tag = "Maneuvers", operation_id = "getMapping",
    params(("id" = String, Path, description = "Its name.", example = "sidpac")),
    responses(
        (status = 200, description = "The document.", body = Mapping),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 404, description = "`unknown_mapping`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_mapping(
    service: Service,
    Id(name): Id,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let document = match service.store.mapping(&name).await? {
        Some(record) => record.document,
        None if Mapping::names().any(|bundled| bundled == name) => {
            let mapping = Mapping::named_or_json(&name).map_err(invalid)?;
            serde_json::to_string(&mapping)?
        }
        None => return Err(unknown_mapping(&name)),
    };
    Ok(cacheable(&headers, Format::Json, document))
}

/// Delete a mapping of the project.
#[utoipa::path(delete, path = "/v1/mappings/{id}", tag = "Maneuvers", operation_id = "deleteMapping",
    params(("id" = String, Path, description = "Its name.", example = "lab-logger-3")),
    responses(
        (status = 204, description = "It is gone."),
        (status = 404, description = "`unknown_mapping`: the project has none of this name.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn delete_mapping(service: Service, Id(name): Id) -> Result<StatusCode, Problem> {
    if service.store.delete_mapping(&name).await? {
        Ok(StatusCode::NO_CONTENT)
    } else {
        Err(unknown_mapping(&name))
    }
}

/// What an upload says in `mapping`: a document, or the name of a mapping that is bundled or kept.
pub(crate) async fn find(service: &Service, text: &str) -> Result<Mapping, Problem> {
    if !text.trim_start().starts_with('{')
        && let Some(record) = service.store.mapping(text.trim()).await?
    {
        return Mapping::from_json(&record.document).map_err(invalid);
    }
    Mapping::named_or_json(text)
        .map_err(|fault| Problem::of_faults(Code::InvalidQuery, vec![fault]))
}

fn invalid(fault: crate::job::Fault) -> Problem {
    Problem::of_faults(Code::InvalidMapping, vec![fault])
}

fn unknown_mapping(name: &str) -> Problem {
    let name: String = name.chars().take(80).collect();
    Problem::new(
        Code::UnknownMapping,
        format!("there is no mapping '{name}'"),
    )
}
