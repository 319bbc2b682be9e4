//! `POST /v1/jobs/{id}/corrected-maneuvers`: recordings without the errors that an estimate found in them.

use axum::Json;
use axum::http::StatusCode;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::kept::{Kept, none};
use crate::flight::{DerivedFrom, Flown};
use crate::http::handlers::maneuvers::{
    LONGEST_NAME, ManeuverResource, keep_maneuver, unknown_maneuver,
};
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::JobId;
use crate::http::service::{Server, Service};
use crate::ingest;
use crate::job::{self, Corrected};
use crate::store::ManeuverRecord;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(correct_maneuvers))
}

/// Upload the corrected recordings: of each segment that was fitted, what the model says of the motion (air data, rates,
/// accelerations, attitudes, velocities, positions, wind) in place of what sensors recorded, and all other channels as they
/// were recorded. Of a flight path reconstruction it is the recording without the errors of its sensors, to estimate
/// aerodynamics from.
///
/// What was said of the flight (aircraft, mass, tags, ...) is said of the corrected recording, too, and `flown.derived_from` names job and
/// recording. Done twice it is the same recording, with the same id.
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
        let with_summary = |made: Corrected| {
            let summary = serde_json::to_string(&ingest::summary(&made.maneuver))?;
            let of = kept.maneuvers[made.of].digest();
            Ok((made, of, summary))
        };
        corrected
            .into_iter()
            .map(with_summary)
            .collect::<Result<Vec<_>, Problem>>()
    };
    let mut answer = Vec::new();
    for (made, of, summary) in service.compute.run(make).await?? {
        let name = format!("{}, corrected by job {id}", made.segment);
        let name: String = name.chars().take(LONGEST_NAME).collect();
        let corrected = made.maneuver.digest();
        let kept = keep_maneuver(&service, &name, made.maneuver, summary).await?;
        let from = DerivedFrom {
            job: id.to_string(),
            maneuver: of,
            segment: made.segment,
        };
        answer.push(match kept {
            (StatusCode::CREATED, _) => as_derived(&service, &corrected, from).await?,
            // it was there before, and may have been spoken of since
            (_, resource) => resource,
        });
    }
    Ok((StatusCode::CREATED, Json(answer)))
}

/// Says of a recording what was flown in the one that it was made of, and where it comes from.
async fn as_derived(
    service: &Service,
    id: &str,
    from: DerivedFrom,
) -> Result<ManeuverResource, Problem> {
    let said = service.store.flown(&[&from.maneuver]).await?;
    let flown = Flown {
        derived_from: Some(from),
        ..said.into_iter().flatten().next().unwrap_or_default()
    };
    let change = |now: &ManeuverRecord| Ok::<_, Problem>((now.name.clone(), flown));
    let changed = service.store.change_maneuver(id, change).await?;
    ManeuverResource::of(changed.ok_or_else(|| unknown_maneuver(id))??)
}
