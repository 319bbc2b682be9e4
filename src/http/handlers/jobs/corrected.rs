//! `POST /v1/jobs/{id}/corrected-maneuvers`: recordings without the errors that an estimate found in them.

use axum::Json;
use axum::http::StatusCode;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::kept::{Kept, none};
use crate::flight::Maneuver;
use crate::http::handlers::maneuvers::{LONGEST_NAME, ManeuverResource, keep_maneuver};
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::JobId;
use crate::http::service::{Server, Service};
use crate::ingest;
use crate::job;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(correct_maneuvers))
}

/// Upload the corrected recordings: of each segment that was fitted, what the model says of the motion (air data, rates,
/// accelerations, attitudes, velocities, positions, wind) in place of what sensors recorded, and all other channels as they
/// were recorded. Of a flight path reconstruction it is the recording without the errors of its sensors, to estimate
/// aerodynamics from.
///
/// Done twice it is the same recording, with the same id.
#[utoipa::path(post, path = "/v1/jobs/{id}/corrected-maneuvers", tag = "Results", operation_id = "correctManeuvers",
    params(("id" = Uuid, Path)),
    responses(
        (status = 201, description = "The recordings, in the order of the segments.", body = Vec<ManeuverResource>),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`, `no_trajectory`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 413, description = "`quota_exceeded`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn correct_maneuvers(
    service: Service,
    JobId(id): JobId,
) -> Result<(StatusCode, Json<Vec<ManeuverResource>>), Problem> {
    let kept = Kept::of(&service, id).await?;
    let make = move || {
        let corrected =
            job::corrected(&kept.plan()?, &kept.estimate, &kept.maneuvers).map_err(none)?;
        let with_summary = |(label, maneuver): (String, Maneuver)| {
            let summary = serde_json::to_string(&ingest::summary(&maneuver))?;
            Ok((label, maneuver, summary))
        };
        corrected
            .into_iter()
            .map(with_summary)
            .collect::<Result<Vec<_>, Problem>>()
    };
    let mut answer = Vec::new();
    for (label, maneuver, summary) in service.compute.run(make).await?? {
        let name = format!("{label}, corrected by job {id}");
        let name: String = name.chars().take(LONGEST_NAME).collect();
        answer.push(keep_maneuver(&service, &name, maneuver, summary).await?.1);
    }
    Ok((StatusCode::CREATED, Json(answer)))
}
