//! `POST /v1/trims`, `POST /v1/jobs/{id}/trim`: steady flight of a model, and of an estimate.

use axum::Json;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::jobs::kept::Kept;
use super::jobs::submit::find_model;
use crate::dynamics::{self, Trim, TrimSpec};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::json::JsonBody;
use crate::http::request::query::{JobId, Parameters};
use crate::http::service::{Server, Service};
use crate::job::ModelTrimSpec;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(trim_model))
        .routes(routes!(trim_job))
}

/// Trim a model: states and inputs at which its states stand still, or change as it is asked for, and other quantities have the values
/// that are held. Nothing is kept.
#[utoipa::path(post, path = "/v1/trims", tag = "Models", operation_id = "trimModel",
    request_body = ModelTrimSpec,
    responses(
        (status = 200, description = "The steady flight; `outcome` says whether there is one.", body = Trim),
        (status = 404, description = "`unknown_model`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`wrong_shape`, `invalid_trim`: `errors` lists the faults by JSON pointer.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn trim_model(
    service: Service,
    JsonBody { value: spec, .. }: JsonBody<ModelTrimSpec>,
) -> Result<Json<Trim>, Problem> {
    let document = find_model(&service, &spec.model).await?;
    let document = document.map_err(|fault| Problem::new(Code::UnknownModel, fault.message))?;
    let find = move || {
        let refused = |faults| Problem::of_faults(Code::InvalidTrim, faults);
        spec.trim(&document).map_err(refused)
    };
    Ok(Json(service.compute.run(find).await??))
}

#[derive(serde::Deserialize, utoipa::IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct TrimQuery {
    /// The label of the segment whose own parameters (biases, wind) count; absent: the first.
    #[param(example = "elevator")]
    segment: Option<String>,
}

/// Trim the estimated model, with the standard errors that those of the parameters carry over. Nothing is kept.
#[utoipa::path(post, path = "/v1/jobs/{id}/trim", tag = "Results", operation_id = "trimJob",
    params(("id" = Uuid, Path), TrimQuery),
    request_body = TrimSpec,
    responses(
        (status = 200, description = "The steady flight; `outcome` says whether there is one.", body = Trim),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`, `no_trajectory`: a maneuver was deleted, or another program made the result.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`wrong_shape`, `invalid_trim`: `errors` lists the faults by JSON pointer.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn trim_job(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<TrimQuery>,
    JsonBody { value: spec, .. }: JsonBody<TrimSpec>,
) -> Result<Json<Trim>, Problem> {
    let kept = Kept::of(&service, id).await?;
    let find = move || {
        let plan = kept.plan_of_estimate()?;
        let segment = query.segment.as_deref();
        dynamics::trim_of_estimate(&plan.problem, &kept.estimate, segment, &spec)
            .map_err(|faults| Problem::of_faults(Code::InvalidTrim, faults))
    };
    Ok(Json(service.compute.run(find).await??))
}
