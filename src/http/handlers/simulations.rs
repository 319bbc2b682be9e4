//! `POST /v1/simulations`: a recording of known truth from a scenario.

use axum::http::header;
use axum::response::{IntoResponse, Response};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::jobs::submit::find_model;
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::json::JsonBody;
use crate::http::service::{Server, Service};
use crate::ingest;
use crate::job::{NoSimulatedManeuver, SimulationSpec};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(simulate))
}

/// Samples of a simulation over HTTP.
const MOST_SAMPLES: usize = 200_000;

/// Simulate a maneuver of known truth, with noise and effects: a recording as CSV, to upload or to look at. The same scenario
/// gives the same numbers. Nothing is kept.
#[utoipa::path(post, path = "/v1/simulations", tag = "Models", operation_id = "simulate",
    request_body = SimulationSpec,
    responses(
        (status = 200, description = "The recording.", body = String, content_type = "text/csv"),
        (status = 404, description = "`unknown_model`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`wrong_shape`, `invalid_scenario`: `detail` says which part and why; `invalid_model`: `errors` lists the faults by JSON pointer.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn simulate(
    service: Service,
    JsonBody { value: spec, .. }: JsonBody<SimulationSpec>,
) -> Result<Response, Problem> {
    let document = find_model(&service, &spec.source()).await?;
    let document = document.map_err(|fault| Problem::new(Code::UnknownModel, fault.message))?;
    let fly = move || {
        let maneuver = spec.fly(&document, MOST_SAMPLES).map_err(|why| match why {
            NoSimulatedManeuver::Model(faults) => Problem::of_faults(Code::InvalidModel, faults),
            NoSimulatedManeuver::Scenario(message) => Problem::new(Code::InvalidScenario, message),
        })?;
        Ok(ingest::to_csv_as_recorded(&maneuver))
    };
    let csv: Result<String, Problem> = service.compute.run(fly).await?;
    let media_type = "text/csv; charset=utf-8; header=present";
    Ok(([(header::CONTENT_TYPE, media_type)], csv?).into_response())
}
