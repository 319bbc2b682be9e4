//! Examples of requests that run as they stand, in this order: the recording first, whose id the others name, then a fit, whose
//! id `predictions` has in its path.

use serde_json::Value;
use utoipa::openapi::example::ExampleBuilder;
use utoipa::openapi::{OpenApi, RefOr};

/// Path, media type, name, in words, and the body.
type Row = (
    &'static str,
    &'static str,
    &'static str,
    &'static str,
    &'static str,
);

const JSON: &str = "application/json";

/// All of them.
const ROWS: &[Row] = &[
    (
        "/v1/maneuvers",
        JSON,
        "elevator",
        "An elevator 3-2-1-1 and doublets, which the other examples use",
        include_str!("examples/recording.json"),
    ),
    (
        "/v1/jobs",
        JSON,
        "fit",
        "A fit by output error",
        include_str!("examples/fit.json"),
    ),
    (
        "/v1/jobs",
        JSON,
        "diagnosis",
        "What the model lacks, with a part of the recording for validation",
        include_str!("examples/diagnosis.json"),
    ),
    (
        "/v1/jobs",
        JSON,
        "filter_error",
        "A fit by filter error, as in turbulence",
        include_str!("examples/filter_error.json"),
    ),
    (
        "/v1/jobs",
        JSON,
        "derivative_study",
        "Derivative techniques compared",
        include_str!("examples/study.json"),
    ),
    (
        "/v1/jobs",
        JSON,
        "structure",
        "Which terms an equation needs",
        include_str!("examples/structure.json"),
    ),
    (
        "/v1/jobs/bulk",
        JSON,
        "two_parts",
        "A fit of each part of a recording",
        include_str!("examples/bulk.json"),
    ),
    (
        "/v1/jobs/{id}/predictions",
        JSON,
        "elevator",
        "A fit predicts its own recording",
        include_str!("examples/prediction.json"),
    ),
    (
        "/v1/maneuvers/{id}/frequency-responses",
        JSON,
        "elevator",
        "The pitch rate's response to the elevator",
        include_str!("examples/frequency_responses.json"),
    ),
    (
        "/v1/simulations",
        JSON,
        "short_period",
        "An elevator 3-2-1-1 with noise",
        include_str!("examples/simulation.json"),
    ),
];

/// Puts the examples beside the bodies that they are of.
pub(super) fn put_in(document: &mut OpenApi) {
    for (path, media_type, name, words, text) in ROWS {
        let post = document.paths.paths.get_mut(*path);
        let body = post.and_then(|path| path.post.as_mut()?.request_body.as_mut());
        let content = match body {
            Some(RefOr::T(body)) => body.content.get_mut(*media_type),
            _ => None,
        };
        let value: Option<Value> = serde_json::from_str(text).ok();
        if let (Some(RefOr::T(content)), Some(value)) = (content, value) {
            let example = ExampleBuilder::new().summary(*words).value(Some(value));
            let examples = &mut content.examples;
            examples.insert((*name).to_string(), example.build().into());
        }
    }
}
