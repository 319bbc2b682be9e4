//! `POST /v1/jobs/{id}/coefficients`: an estimate's derivatives made nondimensional.

use axum::Json;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::results;
use crate::estimate::{Coefficient, Estimate, coefficients};
use crate::flight::Aircraft;
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::json::JsonBody;
use crate::http::request::query::JobId;
use crate::http::service::{Server, Service};
use crate::store::Part;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(get_coefficients))
}

/// Nondimensional coefficients from a job's dimensional derivatives, for the aircraft in the body.
///
/// Nothing is kept. Parameters that are no derivatives by name (`Ma`, `Zq`, `Ldr`, ...) and unit are passed over.
/// `L` and `N` derivatives are taken as those of the equations of motion, with the product of inertia in them.
#[utoipa::path(post, path = "/v1/jobs/{id}/coefficients", tag = "Results", operation_id = "getCoefficients",
    params(("id" = Uuid, Path)),
    request_body = Aircraft,
    responses(
        (status = 200, description = "The coefficients, in the order of the parameter table.", body = Vec<Coefficient>),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`wrong_shape`, `invalid_aircraft`: `errors` lists the faults by JSON pointer.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_coefficients(
    service: Service,
    JobId(id): JobId,
    JsonBody {
        value: aircraft, ..
    }: JsonBody<Aircraft>,
) -> Result<Json<Vec<Coefficient>>, Problem> {
    let estimate = results::part(&service, id, Part::Estimate).await?;
    let estimate: Estimate = serde_json::from_str(&estimate)?;
    coefficients(&estimate, &aircraft)
        .map(Json)
        .map_err(|faults| Problem::of_faults(Code::InvalidAircraft, faults))
}
