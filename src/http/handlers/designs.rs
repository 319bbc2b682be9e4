//! `POST /v1/designs`: maneuvers before they are flown, and the error bounds that they will give.

use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::jobs::submit::find_model;
use crate::design::{DesignSpec, Designs};
use crate::http::answer::format::{Format, choose};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::json::JsonBody;
use crate::http::request::query::Parameters;
use crate::http::service::{Server, Service};
use crate::job::{NoDesign, PlannedDesign};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(design_maneuvers))
}

/// Samples times free parameters times simulations of a plan over HTTP.
const MOST_WORK: f64 = 1e8;

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct DesignQuery {
    /// `json`, or `csv`: time and inputs of one maneuver, for the computer that flies it; absent: as `Accept` says.
    #[param(inline)]
    format: Option<Format>,
    /// The maneuver whose inputs are answered as CSV; absent: the only one.
    #[param(example = "3-2-1-1")]
    maneuver: Option<String>,
}

/// Design maneuvers and predict what they will tell: multisteps scaled to a mode, orthogonal multisines with low relative peak factor,
/// D-optimal inputs within limits of amplitude, rate and response; Cramér-Rao bounds of all free parameters at their a priori
/// values, for each maneuver and for all together. Nothing is kept.
#[utoipa::path(post, path = "/v1/designs", tag = "Models", operation_id = "designManeuvers",
    params(DesignQuery),
    request_body = PlannedDesign,
    responses(
        (status = 200, description = "The maneuvers.", content((Designs = "application/json"), (String = "text/csv"))),
        (status = 400, description = "`invalid_query`: there is no such maneuver.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 404, description = "`unknown_model`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`wrong_shape`, `invalid_model`, `invalid_design`: `errors` lists the faults by JSON pointer; what would take too long is one of them (`too_large`).", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn design_maneuvers(
    service: Service,
    Parameters(query): Parameters<DesignQuery>,
    headers: HeaderMap,
    JsonBody { value: spec, .. }: JsonBody<PlannedDesign>,
) -> Result<Response, Problem> {
    let format = choose(query.format, &headers, &[Format::Json, Format::Csv])?;
    let wanted = one_of(&spec.plan, format, query.maneuver)?;
    let document = find_model(&service, &spec.source()).await?;
    let document = document.map_err(|fault| Problem::new(Code::UnknownModel, fault.message))?;
    let design = move || {
        let designs = spec.design(&document, MOST_WORK).map_err(|why| match why {
            NoDesign::Model(faults) => Problem::of_faults(Code::InvalidModel, faults),
            NoDesign::Plan(faults) => Problem::of_faults(Code::InvalidDesign, faults),
        })?;
        let maneuver = wanted.and_then(|place| designs.maneuvers.get(place));
        Ok(match maneuver {
            Some(maneuver) => (
                "text/csv; charset=utf-8; header=present",
                maneuver.to_csv().into_bytes(),
            ),
            None => ("application/json", serde_json::to_vec(&designs)?),
        })
    };
    let answer: Result<(&str, Vec<u8>), Problem> = service.compute.run(design).await?;
    let (media_type, body) = answer?;
    Ok(([(header::CONTENT_TYPE, media_type)], body).into_response())
}

/// The place of the maneuver that is answered as CSV.
fn one_of(
    spec: &DesignSpec,
    format: Format,
    name: Option<String>,
) -> Result<Option<usize>, Problem> {
    let names: Vec<&str> = spec.maneuvers.iter().map(|one| one.name.as_str()).collect();
    let refused = |message: String| Err(Problem::new(Code::InvalidQuery, message));
    match (format, name) {
        (Format::Csv, None) if names.len() == 1 => Ok(Some(0)),
        (Format::Csv, None) => {
            refused("maneuver: name the one whose inputs are answered as CSV".to_string())
        }
        (Format::Csv, Some(name)) => match names.iter().position(|known| *known == name) {
            Some(place) => Ok(Some(place)),
            None => refused(format!(
                "maneuver: there is no '{name}'; there is {}",
                names.join(", ")
            )),
        },
        (_, Some(_)) => refused("maneuver: only with format=csv".to_string()),
        (_, None) => Ok(None),
    }
}
