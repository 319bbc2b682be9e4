//! The OpenAPI document, made from the handlers.

mod descriptions;
mod examples;
mod flat_events;

use axum::http::Method;
use utoipa::OpenApi;
use utoipa::openapi::path::{Operation, ParameterBuilder, ParameterIn};
use utoipa::openapi::schema::Type;
use utoipa::openapi::security::{Http, HttpAuthScheme, SecurityRequirement, SecurityScheme};
use utoipa::openapi::{ContentBuilder, ObjectBuilder, Ref, Required, Response, ResponseBuilder};

use super::middleware::once;
use super::{caller, handlers, problem};

#[derive(OpenApi)]
#[openapi(
    info(
        title = "Trimtab",
        description = "Estimates aircraft parameters from flight-test maneuvers.\n\n\
            Upload a recorded maneuver, post a job that names it and a model, follow the job's events, \
            and read parameters with error bounds, residuals and time histories.\n\n\
            Whatever goes wrong is answered with `application/problem+json` (RFC 9457): a stable `code`, \
            and in `errors` every place that is at fault. Lists are paged by cursor; \
            `next_cursor: null` is the only end. Results and maneuvers never change and carry an `ETag`.",
        license(name = "MIT", identifier = "MIT"),
    ),
    servers(
        (url = "/", description = "The server that this document is from."),
        (url = "http://127.0.0.1:8300", description = "A server on this machine, as `trimtab serve` starts it."),
    ),
    tags(
        (name = "Maneuvers", description = "Recordings: immutable, identified by their content."),
        (name = "Models", description = "Model documents: those that come with Trimtab, and your own."),
        (name = "Jobs", description = "Estimations: submitted, followed, cancelled."),
        (name = "Results", description = "What a finished job answers."),
        (name = "Keys", description = "Who may do what in a project."),
        (name = "Webhooks", description = "Being told of the end of jobs."),
        (name = "Problems", description = "What can go wrong."),
        (name = "Operations", description = "For those that run the service."),
    ),
)]
struct Api;

/// The document that `/openapi.json` serves and `openapi/trimtab.json` holds.
pub fn document() -> utoipa::openapi::OpenApi {
    let mut document = Api::openapi();
    document.merge(handlers::api().into_openapi());
    document.info.version = env!("CARGO_PKG_VERSION").to_string();
    let posts = document.paths.paths.values_mut();
    posts
        .filter_map(|path| path.post.as_mut())
        .for_each(takes_a_key);
    for (name, path) in &mut document.paths.paths {
        for (method, operation) in [
            (Method::GET, &mut path.get),
            (Method::POST, &mut path.post),
            (Method::PATCH, &mut path.patch),
            (Method::DELETE, &mut path.delete),
        ] {
            if let Some(operation) = operation {
                any_may_fail(operation);
                needs_a_key(operation, &method, name);
            }
        }
    }
    let schemes = &mut document.components.get_or_insert_default().security_schemes;
    for (name, scheme) in [
        (BEARER, HttpAuthScheme::Bearer),
        (BASIC, HttpAuthScheme::Basic),
    ] {
        let scheme = SecurityScheme::Http(Http::new(scheme));
        schemes.insert(name.to_string(), scheme.into());
    }
    flat_events::flatten(&mut document);
    descriptions::complete(&mut document);
    examples::put_in(&mut document);
    document
}

const BEARER: &str = "key";
const BASIC: &str = "key_as_password";

/// With which scope an operation is open to whom.
fn needs_a_key(operation: &mut Operation, method: &Method, path: &str) {
    let Some(scope) = caller::needed(method, path) else {
        return;
    };
    let either = [BEARER, BASIC].map(|name| SecurityRequirement::new::<_, _, &str>(name, []));
    operation.security = Some(either.into());
    let text = operation.description.get_or_insert_default();
    if !text.is_empty() {
        text.push_str("\n\n");
    }
    *text += &format!(
        "Needs a key with the scope `{}`, as soon as there are keys.",
        scope.name()
    );
    for (status, description) in [
        (
            "401",
            "`key_needed`: there is no key in the request, or it is no longer valid.",
        ),
        ("403", "`scope_missing`: the key is not for this."),
    ] {
        let response = problem_response(description);
        let responses = &mut operation.responses.responses;
        responses
            .entry(status.to_string())
            .or_insert(response.into());
    }
}

fn problem_response(description: &str) -> Response {
    let schema = Ref::from_schema_name("Problem");
    let content = ContentBuilder::new().schema(Some(schema)).build();
    ResponseBuilder::new()
        .description(description)
        .content(problem::MEDIA_TYPE, content)
        .build()
}

/// Every POST can be sent again.
fn takes_a_key(operation: &mut Operation) {
    let text = ObjectBuilder::new()
        .schema_type(Type::String)
        .min_length(Some(1))
        .max_length(Some(255))
        .pattern(Some("^[ -~]+$"))
        .build();
    let key = ParameterBuilder::new()
        .name(once::KEY.as_str())
        .parameter_in(ParameterIn::Header)
        .required(Required::False)
        .description(Some("Sent again with the same key within 24 hours, the request is not done again but answered as before, with the header `Idempotency-Replayed: true`; only what succeeded is kept. Another request under the key is refused (`idempotency_key_reused`), and so is a repetition while the first is in hand (`idempotency_key_in_hand`)."))
        .schema(Some(text))
        .build();
    operation
        .parameters
        .get_or_insert_default()
        .push(key.into());
}

/// What every operation may answer beside what its handler lists.
fn any_may_fail(operation: &mut Operation) {
    let response = problem_response(
        "Any other problem: a query, header or body that cannot be read, or the service itself.",
    );
    operation
        .responses
        .responses
        .insert("default".to_string(), response.into());
}
