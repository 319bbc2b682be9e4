//! `/v1/jobs/{id}/simulator-model`: the estimated model for a simulator.

use axum::http::header;
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::kept::Kept;
use super::source_code::none_of;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{JobId, Parameters};
use crate::http::service::{Server, Service};
use crate::job::{self, SimulatorFormat};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(get_simulator_model))
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct SimulatorModelQuery {
    /// `fmu` (a functional mock-up unit of FMI 2.0, for co-simulation and model exchange) or `jsbsim` (the aerodynamics of a JSBSim
    /// aircraft); absent: `fmu`.
    #[param(inline)]
    #[serde(default)]
    format: SimulatorFormat,
    /// The label of the segment whose own parameters (initial state, biases) are in it; absent: the first.
    #[param(example = "elevator")]
    segment: Option<String>,
}

/// The estimated model for a simulator. A functional mock-up unit has the whole model, as C sources that the importing tool compiles:
/// inputs, outputs and parameters by their names, states as `state.NAME`, all in SI, parameters where they were estimated. For JSBSim it
/// is the model's aerodynamic coefficients, by the quantities of its document, as a file that `<aerodynamics file="...">` of
/// an aircraft names. Lags, delays, play and rate limits of signals are in neither: its description names them.
#[utoipa::path(get, path = "/v1/jobs/{id}/simulator-model", tag = "Results", operation_id = "getSimulatorModel",
    params(("id" = Uuid, Path), SimulatorModelQuery),
    responses(
        (status = 200, description = "The file.", content(
            (Vec<u8> = "application/zip"),
            (String = "application/xml"),
        )),
        (status = 400, description = "`invalid_query`: there is no such format or segment.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`; `no_trajectory`: a maneuver was deleted, or another program made the result; `no_aerodynamics`: the model has no coefficients, or they depend on what JSBSim does not have.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_simulator_model(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<SimulatorModelQuery>,
) -> Result<Response, Problem> {
    let kept = Kept::of(&service, id).await?;
    let media_type = match query.format {
        SimulatorFormat::Fmu => "application/zip",
        SimulatorFormat::Jsbsim => "application/xml",
    };
    let write = move || {
        let plan = kept.plan()?;
        let segment = query.segment.as_deref();
        job::simulator_model(&plan, &kept.estimate, segment, query.format).map_err(none_of)
    };
    let file: Vec<u8> = service.compute.run(write).await??;
    Ok(([(header::CONTENT_TYPE, media_type)], file).into_response())
}
