//! The OpenAPI document, made from the handlers.

use utoipa::OpenApi;
use utoipa::openapi::path::Operation;
use utoipa::openapi::{ContentBuilder, Ref, ResponseBuilder};

use super::{problem, routes};

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
        license(name = "MIT OR Apache-2.0", identifier = "MIT OR Apache-2.0"),
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
