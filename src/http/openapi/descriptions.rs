//! What every path parameter and every word that tells kinds apart is, where the types do not say it.

use utoipa::openapi::path::{Operation, ParameterIn, PathItem};
use utoipa::openapi::{OpenApi, RefOr, Schema};

/// What the `{id}` or `{code}` of a path is.
const PATHS: &[(&str, &str)] = &[
    (
        "/v1/jobs/",
        "The job's id, as the answer to its submission has it.",
    ),
    (
        "/v1/maneuvers/",
        "The recording's id, the SHA-256 of its content; that of the example is `c75e226ae88012c059af95902dbe588f535d24fdf68c58e473b92d0d9a92043b`.",
    ),
    (
        "/v1/models/",
        "A catalog name, or the id of a stored model.",
    ),
    ("/v1/mappings/", "The mapping's name."),
    (
        "/v1/keys/",
        "The key's id, as lists have it; it is not the secret.",
    ),
    ("/v1/webhooks/", "The webhook's id."),
    ("/v1/problems/", "A stable word, as `code` of a problem."),
];

/// Describes what is not described.
pub(super) fn complete(document: &mut OpenApi) {
    for (path, item) in &mut document.paths.paths {
        let known = PATHS.iter().find(|(root, _)| path.starts_with(root));
        if let Some((_, description)) = known {
            for operation in operations(item) {
                describe_path(operation, description);
            }
        }
    }
    let components = document.components.get_or_insert_default();
    components.schemas.values_mut().for_each(describe_words);
}

/// All operations of a path.
pub(super) fn operations(item: &mut PathItem) -> impl Iterator<Item = &mut Operation> {
    let all = [
        &mut item.get,
        &mut item.post,
        &mut item.patch,
        &mut item.delete,
    ];
    all.into_iter().filter_map(Option::as_mut)
}

fn describe_path(operation: &mut Operation, description: &str) {
    for parameter in operation.parameters.iter_mut().flatten() {
        let RefOr::T(parameter) = parameter else {
            continue;
        };
        if parameter.parameter_in == ParameterIn::Path {
            parameter
                .description
                .get_or_insert_with(|| description.to_string());
        }
    }
}

/// The property of each kind of a union that says which it is.
fn describe_words(schema: &mut RefOr<Schema>) {
    let RefOr::T(schema) = schema else { return };
    match schema {
        Schema::OneOf(one) => one.items.iter_mut().for_each(describe_words),
        Schema::AllOf(all) => all.items.iter_mut().for_each(describe_words),
        Schema::Object(object) => {
            for property in object.properties.values_mut() {
                if let RefOr::T(Schema::Object(word)) = property
                    && word.enum_values.is_some()
                {
                    word.description
                        .get_or_insert_with(|| "Which kind it is.".to_string());
                }
            }
        }
        _ => {}
    }
}
