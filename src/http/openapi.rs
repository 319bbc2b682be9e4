//! The OpenAPI document, made from the handlers.

use utoipa::OpenApi;
use utoipa::openapi::path::{Operation, ParameterBuilder, ParameterIn};
use utoipa::openapi::schema::Type;
use utoipa::openapi::{ContentBuilder, ObjectBuilder, Ref, Required, ResponseBuilder};

use super::{once, problem, routes};

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
    tags(
        (name = "Maneuvers", description = "Recordings: immutable, identified by their content."),
        (name = "Models", description = "Model documents: those that come with Trimtab, and your own."),
        (name = "Jobs", description = "Estimations: submitted, followed, cancelled."),
        (name = "Results", description = "What a finished job answers."),
        (name = "Problems", description = "What can go wrong."),
        (name = "Operations", description = "For those that run the service."),
    ),
)]
struct Api;

/// The document that `/openapi.json` serves and `openapi/trimtab.json` holds.
pub fn document() -> utoipa::openapi::OpenApi {
    let mut document = Api::openapi();
    document.merge(routes::api().into_openapi());
    document.info.version = env!("CARGO_PKG_VERSION").to_string();
    let posts = document.paths.paths.values_mut();
    posts
        .filter_map(|path| path.post.as_mut())
        .for_each(takes_a_key);
    let operations = document.paths.paths.values_mut().flat_map(|path| {
        [
            &mut path.get,
            &mut path.post,
            &mut path.put,
            &mut path.delete,
            &mut path.patch,
        ]
    });
    operations.flatten().for_each(any_may_fail);
    document
}

/// Every POST can be sent again.
fn takes_a_key(operation: &mut Operation) {
    let text = ObjectBuilder::new().schema_type(Type::String).build();
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
    let schema = Ref::from_schema_name("Problem");
    let content = ContentBuilder::new().schema(Some(schema)).build();
    let response = ResponseBuilder::new()
        .description("Any other problem: a query, header or body that cannot be read, or the service itself.")
        .content(problem::MEDIA_TYPE, content)
        .build();
    operation
        .responses
        .responses
        .insert("default".to_string(), response.into());
}
