//! `POST /v1/maneuvers/{id}/frequency-responses`: what outputs of a recording do to its inputs, frequency by frequency.

use axum::Json;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::maneuvers::unknown_maneuver;
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::json::JsonBody;
use crate::http::request::query::Id;
use crate::http::service::{Server, Service};
use crate::response::{FrequencyResponses, ResponseOptions, frequency_responses};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(get_frequency_responses))
}

/// Frequency responses of a recording, without a model: from cross spectra over windows of several lengths, each response
/// conditioned on the other inputs, with its partial coherence and random error; and a transfer function with delay fitted to
/// each, where `transfer_function` asks for one.
///
/// Nothing is kept.
#[utoipa::path(post, path = "/v1/maneuvers/{id}/frequency-responses", tag = "Maneuvers", operation_id = "getFrequencyResponses",
    params(("id" = String, Path)),
    request_body = ResponseOptions,
    responses(
        (status = 200, description = "The responses, SI.", body = FrequencyResponses),
        (status = 404, description = "`unknown_maneuver`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`wrong_shape`, `invalid_response`: `errors` lists the faults by JSON pointer.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_frequency_responses(
    service: Service,
    Id(id): Id,
    JsonBody { value: options, .. }: JsonBody<ResponseOptions>,
) -> Result<Json<FrequencyResponses>, Problem> {
    let found = service.store.maneuver_data(&id).await?;
    let maneuver = found.ok_or_else(|| unknown_maneuver(&id))?;
    let work = move || frequency_responses(&maneuver, &options);
    let found = service.compute.run(work).await?;
    found
        .map(Json)
        .map_err(|faults| Problem::of_faults(Code::InvalidResponse, faults))
}
