//! `/v1/jobs/{id}/trajectories`: states, definitions and outputs along the trajectory, with standard errors.

use axum::http::HeaderMap;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::kept::{Kept, none};
use crate::estimate::Trajectory;
use crate::http::answer::decimate::{Wanted, pick};
use crate::http::answer::format::{Format, cacheable, choose};
use crate::http::answer::trajectory_table::trajectories_as_csv;
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{JobId, Parameters};
use crate::http::service::{Server, Service};
use crate::job;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(get_trajectories))
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct TrajectoryQuery {
    /// Names of quantities, with commas between them; absent: all.
    #[param(example = "CL,alpha")]
    names: Option<String>,
    /// Seconds of the recording: only samples from here on.
    #[param(example = 2.0)]
    from: Option<f64>,
    /// Seconds of the recording: only samples up to here.
    #[param(example = 6.5)]
    to: Option<f64>,
    /// About how many samples of each segment to answer with; absent: all. Peaks are kept.
    #[param(example = 500)]
    max_points: Option<usize>,
    /// `json` or `csv`; absent: as `Accept` says.
    #[param(inline)]
    format: Option<Format>,
}

/// Of the segments that the model was fitted to.
#[derive(Serialize, ToSchema)]
struct Trajectories {
    /// In the order of the job.
    segments: Vec<Trajectory>,
}

/// Every state, definition (coefficients, flow angles, dynamic pressure) and output of the model along the trajectory, at
/// the estimate, each with its standard error from the covariance of the parameters. SI.
///
/// The model is simulated once more, from what was kept of the job.
#[utoipa::path(get, path = "/v1/jobs/{id}/trajectories", tag = "Results", operation_id = "getTrajectories",
    params(("id" = Uuid, Path), TrajectoryQuery),
    responses(
        (status = 200, description = "The trajectories.", content((Trajectories = "application/json"), (String = "text/csv"))),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 400, description = "`invalid_query`: a name is none of the model's; `from` or `to` is no number of seconds, or `from` is after `to`.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`, `no_trajectory`: filter error was used, a maneuver was deleted, or another program made the result.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_trajectories(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<TrajectoryQuery>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let format = choose(query.format, &headers, &[Format::Json, Format::Csv])?;
    let wanted = Wanted::of(query.from, query.to, query.max_points)?;
    let kept = Kept::of(&service, id).await?;
    let answer = move || {
        let plan = kept.plan()?;
        let mut segments = job::trajectories_of(&plan, &kept.estimate).map_err(none)?;
        if let Some(names) = &query.names {
            keep(&mut segments, names)?;
        }
        segments
            .iter_mut()
            .for_each(|segment| thin(segment, wanted));
        let body = match format {
            Format::Csv => trajectories_as_csv(&segments).into_bytes(),
            _ => serde_json::to_vec(&Trajectories { segments })?,
        };
        Ok(cacheable(&headers, format, body))
    };
    service.compute.run(answer).await?
}

/// Leaves the named quantities alone.
fn keep(segments: &mut [Trajectory], names: &str) -> Result<(), Problem> {
    let names: Vec<&str> = (names.split(',').map(str::trim))
        .filter(|name| !name.is_empty())
        .collect();
    let all = segments
        .first()
        .map_or(&[][..], |segment| &segment.quantities);
    let is_known = |name: &&&str| all.iter().any(|series| series.name == **name);
    if let Some(unknown) = names.iter().find(|name| !is_known(name)) {
        let mut known: Vec<&str> = all.iter().map(|series| series.name.as_str()).collect();
        known.sort_unstable();
        known.dedup();
        let detail = format!(
            "names: the model has no '{unknown}'; it has {}",
            known.join(", ")
        );
        return Err(Problem::new(Code::InvalidQuery, detail));
    }
    for segment in segments {
        (segment.quantities).retain(|series| names.contains(&series.name.as_str()));
    }
    Ok(())
}

fn thin(segment: &mut Trajectory, wanted: Wanted) {
    let columns: Vec<&[f64]> = (segment.quantities.iter())
        .map(|series| series.values.as_slice())
        .collect();
    let rows = wanted.rows(&segment.time, &columns);
    if rows.len() == segment.time.len() {
        return;
    }
    segment.time = pick(&segment.time, &rows);
    for series in &mut segment.quantities {
        series.values = pick(&series.values, &rows);
        if !series.standard_errors.is_empty() {
            series.standard_errors = pick(&series.standard_errors, &rows);
        }
    }
}
