//! `/v1/jobs/{id}/source-code`: the estimated model as functions in C, Python or MATLAB.

use axum::http::header;
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::kept::Kept;
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{JobId, Parameters};
use crate::http::service::{Server, Service};
use crate::job::{self, NoSourceCode};
use crate::model::SourceLanguage;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(get_source_code))
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct SourceCodeQuery {
    /// `c` (C99), `python` (Python 3, standard library alone) or `matlab` (also Octave, and a MATLAB Function block of Simulink);
    /// absent: `c`.
    #[param(inline)]
    #[serde(default)]
    language: SourceLanguage,
    /// The label of the segment whose own parameters (initial state, biases) are in it; absent: the first.
    #[param(example = "elevator")]
    segment: Option<String>,
}

/// The estimated model as source code: functions for the initial state, the derivative and the outputs, in SI, with the
/// estimates as numbers in them. Lags, delays, play and rate limits of signals are not in them: the head of the file names them.
#[utoipa::path(get, path = "/v1/jobs/{id}/source-code", tag = "Results", operation_id = "getSourceCode",
    params(("id" = Uuid, Path), SourceCodeQuery),
    responses(
        (status = 200, description = "The file.", body = String, content_type = "text/plain"),
        (status = 400, description = "`invalid_query`: there is no such language or segment.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`, `no_trajectory`: a maneuver was deleted, or another program made the result.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_source_code(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<SourceCodeQuery>,
) -> Result<Response, Problem> {
    let kept = Kept::of(&service, id).await?;
    let write = move || {
        let plan = kept.plan()?;
        let segment = query.segment.as_deref();
        job::source_code(&plan, &kept.estimate, segment, query.language).map_err(none_of)
    };
    let text: String = service.compute.run(write).await??;
    Ok(([(header::CONTENT_TYPE, "text/plain; charset=utf-8")], text).into_response())
}

pub(super) fn none_of(why: NoSourceCode) -> Problem {
    let code = match &why {
        NoSourceCode::Estimate(_) => Code::NoTrajectory,
        NoSourceCode::Segment { .. } => Code::InvalidQuery,
        NoSourceCode::Aerodynamics(_) => Code::NoAerodynamics,
    };
    Problem::new(code, why.to_string())
}
