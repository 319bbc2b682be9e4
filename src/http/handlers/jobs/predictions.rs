//! `POST /v1/jobs/{id}/predictions`: an estimate simulated along other recordings, with bounds.

use axum::http::HeaderMap;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::kept::Kept;
use super::submit::load;
use crate::http::answer::format::{Format, choose, plain};
use crate::http::answer::prediction_table::predictions_as_csv;
use crate::http::code::Code;
use crate::http::handlers::flown::with_flown;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::json::JsonBody;
use crate::http::request::query::{JobId, Parameters};
use crate::http::service::{Server, Service};
use crate::job::{self, JobSpec, PredictedSegment, PredictionSpec};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(predict_maneuvers))
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct PredictionQuery {
    /// `json` or `csv`; absent: as `Accept` says.
    #[param(inline)]
    format: Option<Format>,
}

/// One of each recording.
#[derive(Serialize, ToSchema)]
struct Predictions {
    /// In the order of the request.
    segments: Vec<PredictedSegment>,
}

/// Predict recordings with the job's estimate, from their inputs alone: states, definitions and outputs over time with standard
/// errors and, where draws are asked for, the range of the middle 95 of 100. Outputs that are recorded are compared: RMS
/// error, Theil's coefficient with its shares, tolerances of simulator qualification.
///
/// Nothing is estimated and nothing is kept. A maneuver with the role `validation` in a job has its own parameters estimated.
#[utoipa::path(post, path = "/v1/jobs/{id}/predictions", tag = "Results", operation_id = "predictManeuvers",
    params(("id" = Uuid, Path), PredictionQuery),
    request_body = PredictionSpec,
    responses(
        (status = 200, description = "The predictions.", content((Predictions = "application/json"), (String = "text/csv"))),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`, `no_trajectory`: a maneuver of the job was deleted.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`wrong_shape`, `invalid_prediction`: `errors` lists the faults by JSON pointer.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn predict_maneuvers(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<PredictionQuery>,
    headers: HeaderMap,
    JsonBody {
        value: mut wanted, ..
    }: JsonBody<PredictionSpec>,
) -> Result<Response, Problem> {
    let format = choose(query.format, &headers, &[Format::Json, Format::Csv])?;
    let kept = Kept::of(&service, id).await?;
    let refused = |faults| Problem::of_faults(Code::InvalidPrediction, faults);
    let spec = JobSpec {
        maneuvers: wanted.maneuvers.clone(),
        ..kept.spec.clone()
    };
    let maneuvers = load(&service, &spec).await?.map_err(refused)?;
    let (spec, _) = with_flown(&service, spec, String::new()).await?;
    wanted.maneuvers = spec.maneuvers;
    let answer = move || {
        let segments = job::predicted(
            &kept.spec,
            &wanted,
            &kept.estimated,
            &kept.estimate,
            &maneuvers,
        )
        .map_err(|faults| refused(faults.into_iter().collect()))?;
        let body = match format {
            Format::Csv => predictions_as_csv(&segments).into_bytes(),
            _ => serde_json::to_vec(&Predictions { segments })?,
        };
        Ok(plain(format, body))
    };
    service.compute.run(answer).await?
}
