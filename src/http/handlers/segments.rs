//! `/v1/maneuvers/{id}/segments`: where in a recording a maneuver is flown.

use axum::Json;
use serde::Deserialize;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::maneuvers::unknown_maneuver;
use crate::flight::{Proposal, Wanted, segments};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{Id, Parameters};
use crate::http::service::{Server, Service};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(propose_segments))
}

/// Seconds that a query may ask for.
const LONGEST: f64 = 3600.0;

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct SegmentsQuery {
    /// Channels whose motion makes a maneuver, separated by commas; absent: the control surfaces, by their names.
    #[param(example = "de,dr")]
    inputs: Option<String>,
    /// Nothing moves for so many seconds between two maneuvers; 5 if absent.
    #[param(minimum = 0, maximum = 3600)]
    quiet: Option<f64>,
    /// Seconds of trim before the first motion; 2 if absent.
    #[param(minimum = 0, maximum = 3600)]
    lead: Option<f64>,
    /// Seconds of free response behind the last motion, at most; 10 if absent.
    #[param(minimum = 0, maximum = 3600)]
    response: Option<f64>,
}

/// Propose segments.
///
/// Where inputs move, and the aircraft responds (`maneuver`); where an input wanders slowly (`quasi_steady`); where nothing moves
/// (`trim`). It is a proposal: `name` and `seconds` go into a job as `label` and `seconds` of a maneuver. Gaps of the
/// recording end a segment.
#[utoipa::path(get, path = "/v1/maneuvers/{id}/segments", tag = "Maneuvers", operation_id = "proposeSegments",
    params(("id" = String, Path), SegmentsQuery),
    responses(
        (status = 200, description = "The proposal.", body = Proposal),
        (status = 400, description = "`invalid_query`: a channel is not there, or none is known as an input.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 404, description = "`unknown_maneuver`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn propose_segments(
    service: Service,
    Id(id): Id,
    Parameters(query): Parameters<SegmentsQuery>,
) -> Result<Json<Proposal>, Problem> {
    let usual = Wanted::default();
    let names = query.inputs.iter().flat_map(|names| names.split(','));
    let wanted = Wanted {
        inputs: names.map(|name| name.trim().to_string()).collect(),
        quiet: seconds("quiet", query.quiet, usual.quiet)?,
        lead: seconds("lead", query.lead, usual.lead)?,
        response: seconds("response", query.response, usual.response)?,
    };
    let maneuver = service.store.maneuver_data(&id).await?;
    let maneuver = maneuver.ok_or_else(|| unknown_maneuver(&id))?;
    let propose = move || segments(&maneuver, &wanted);
    let proposal = service.compute.run(propose).await?;
    let proposal = proposal.map_err(|fault| Problem::of_faults(Code::InvalidQuery, vec![fault]))?;
    Ok(Json(proposal))
}

fn seconds(name: &str, asked: Option<f64>, usual: f64) -> Result<f64, Problem> {
    match asked.unwrap_or(usual) {
        seconds if (0.0..=LONGEST).contains(&seconds) => Ok(seconds),
        seconds => {
            let detail = format!("{name}: {seconds} is not between 0 and {LONGEST} s");
            Err(Problem::new(Code::InvalidQuery, detail))
        }
    }
}
