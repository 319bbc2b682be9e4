//! `/v1/jobs/{id}/linear-system`, `/frequency-response` and `/flying-qualities`: what the estimated model does about its trim.

use axum::Json;
use axum::http::HeaderMap;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::kept::Kept;
use crate::dynamics::{
    AirplaneClass, FlightPhaseCategory, FlyingQualities, FlyingQualityQuestion, FrequencyQuestion,
    FrequencyResponse, FrequencyUnit, LinearSystem, NoLinearSystem, flying_qualities,
    frequency_responses, linear_system, linear_system_as_mat,
};
use crate::http::answer::format::{Format, cacheable, choose};
use crate::http::answer::response_table::responses_as_csv;
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{JobId, Parameters};
use crate::http::service::{Server, Service};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(get_linear_system))
        .routes(routes!(get_frequency_response))
        .routes(routes!(get_flying_qualities))
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct SegmentQuery {
    /// The label of the segment at whose start the model is linearised; absent: the first.
    #[param(example = "elevator")]
    segment: Option<String>,
    /// `json` or `mat`, a MAT file of version 4; absent: as `Accept` says.
    #[param(inline)]
    format: Option<Format>,
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct FrequencyQuery {
    /// The label of the segment at whose start the model is linearised; absent: the first.
    #[param(example = "elevator")]
    segment: Option<String>,
    /// One input; absent: all.
    #[param(example = "de")]
    input: Option<String>,
    /// One output; absent: all.
    #[param(example = "q")]
    output: Option<String>,
    /// In what frequencies are, here and in the answer; absent: `rad/s`.
    #[param(inline)]
    #[serde(default)]
    unit: FrequencyUnit,
    /// The lowest frequency; absent: a tenth of the slowest pole.
    #[param(example = 0.1)]
    from: Option<f64>,
    /// The highest frequency; absent: ten times the fastest pole.
    #[param(example = 20.0)]
    to: Option<f64>,
    /// How many frequencies, evenly spaced on a logarithmic scale, at most 10000; absent: 100.
    #[param(example = 200)]
    points: Option<usize>,
    /// `json` or `csv`; absent: as `Accept` says.
    #[param(inline)]
    format: Option<Format>,
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct FlyingQualityQuery {
    /// The label of the segment at whose start the model is linearised; absent: the first.
    #[param(example = "elevator")]
    segment: Option<String>,
    /// Category of the flight phase. Levels want category and class.
    #[param(inline)]
    category: Option<FlightPhaseCategory>,
    /// Class of the airplane.
    #[param(inline)]
    class: Option<AirplaneClass>,
    /// True airspeed, m/s, of a model that does not have it.
    #[param(example = 130.0)]
    airspeed: Option<f64>,
    /// The lowest frequency that equivalent systems are fitted over, rad/s; absent: 0.1, or above a phugoid.
    #[param(example = 0.3)]
    from: Option<f64>,
    /// The highest, rad/s; absent: 10.
    #[param(example = 10.0)]
    to: Option<f64>,
}

/// The bytes of a MAT file.
#[derive(ToSchema)]
#[schema(value_type = String, format = Binary)]
#[expect(dead_code, reason = "it is there for the API's document")]
struct MatFile(Vec<u8>);

/// Of each input and output that depends on it.
#[derive(Serialize, ToSchema)]
struct FrequencyResponses {
    /// By input, then output.
    responses: Vec<FrequencyResponse>,
}

/// The estimated model linearised at the start of a segment: A, B, C, D with standard errors, lags and delays, modes,
/// transfer functions with poles and zeros.
#[utoipa::path(get, path = "/v1/jobs/{id}/linear-system", tag = "Results", operation_id = "getLinearSystem",
    params(("id" = Uuid, Path), SegmentQuery),
    responses(
        (status = 200, description = "The linear system.", content((LinearSystem = "application/json"), (MatFile = "application/x-matlab-data"))),
        (status = 400, description = "`invalid_query`: there is no such segment.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`, `no_linear_system`, `no_trajectory`: a maneuver was deleted, or another program made the result.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_linear_system(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<SegmentQuery>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let format = choose(query.format, &headers, &[Format::Json, Format::Mat])?;
    let kept = Kept::of(&service, id).await?;
    let answer = move || {
        let plan = kept.plan_of_estimate()?;
        let segment = query.segment.as_deref();
        let system = linear_system(&plan.problem, &kept.estimate, segment).map_err(none)?;
        let body = match format {
            Format::Mat => linear_system_as_mat(&system),
            _ => serde_json::to_vec(&system)?,
        };
        Ok(cacheable(&headers, format, body))
    };
    service.compute.run(answer).await?
}

/// How outputs respond to inputs that swing: magnitude and phase with standard errors, delays exact.
#[utoipa::path(get, path = "/v1/jobs/{id}/frequency-response", tag = "Results", operation_id = "getFrequencyResponse",
    params(("id" = Uuid, Path), FrequencyQuery),
    responses(
        (status = 200, description = "The responses.", content((FrequencyResponses = "application/json"), (String = "text/csv"))),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 400, description = "`invalid_query`: there is no such segment, input or output, or frequencies cannot be.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`, `no_linear_system`, `no_trajectory`: a maneuver was deleted, or another program made the result.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_frequency_response(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<FrequencyQuery>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let format = choose(query.format, &headers, &[Format::Json, Format::Csv])?;
    let kept = Kept::of(&service, id).await?;
    let answer = move || {
        let plan = kept.plan_of_estimate()?;
        let question = FrequencyQuestion {
            segment: query.segment,
            input: query.input,
            output: query.output,
            unit: query.unit,
            from: query.from,
            to: query.to,
            points: query.points,
        };
        let responses =
            frequency_responses(&plan.problem, &kept.estimate, &question).map_err(none)?;
        let body = match format {
            Format::Csv => responses_as_csv(&responses).into_bytes(),
            _ => serde_json::to_vec(&FrequencyResponses { responses })?,
        };
        Ok(cacheable(&headers, format, body))
    };
    service.compute.run(answer).await?
}

/// Modes by name, low-order equivalent systems with delay, control anticipation parameter, attitude bandwidth and phase
/// delay, and, where category and class are said, the levels of MIL-F-8785C that they reach.
#[utoipa::path(get, path = "/v1/jobs/{id}/flying-qualities", tag = "Results", operation_id = "getFlyingQualities",
    params(("id" = Uuid, Path), FlyingQualityQuery),
    responses(
        (status = 200, description = "The flying qualities.", body = FlyingQualities),
        (status = 400, description = "`invalid_query`: there is no such segment, or an airspeed or frequencies cannot be.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`, `no_linear_system`, `no_trajectory`: a maneuver was deleted, or another program made the result.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_flying_qualities(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<FlyingQualityQuery>,
) -> Result<Json<FlyingQualities>, Problem> {
    let question = question(query)?;
    let kept = Kept::of(&service, id).await?;
    let answer = move || {
        let plan = kept.plan_of_estimate()?;
        flying_qualities(&plan.problem, &kept.estimate, &question).map_err(none)
    };
    service.compute.run(answer).await?.map(Json)
}

fn question(query: FlyingQualityQuery) -> Result<FlyingQualityQuestion, Problem> {
    let is_speed = |airspeed: f64| airspeed > 0.0 && airspeed.is_finite();
    if let Some(airspeed) = query.airspeed.filter(|&airspeed| !is_speed(airspeed)) {
        let detail = format!("airspeed: {airspeed} is not above 0; say it in m/s");
        return Err(Problem::new(Code::InvalidQuery, detail));
    }
    Ok(FlyingQualityQuestion {
        segment: query.segment,
        category: query.category,
        class: query.class,
        airspeed: query.airspeed,
        band: [query.from, query.to],
    })
}

pub(crate) fn none(why: NoLinearSystem) -> Problem {
    let code = match &why {
        NoLinearSystem::Unknown { .. } | NoLinearSystem::Frequencies(_) => Code::InvalidQuery,
        NoLinearSystem::NotFinite(_) | NoLinearSystem::NoInputs | NoLinearSystem::TooLarge(_) => {
            Code::NoLinearSystem
        }
    };
    Problem::new(code, why.to_string())
}
