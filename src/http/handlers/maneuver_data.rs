//! `/v1/maneuvers/{id}/data`: the samples of a recording.

use axum::http::{HeaderMap, HeaderName, HeaderValue};
use axum::response::Response;
use serde::Deserialize;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::maneuvers::unknown_maneuver;
use crate::flight::{Channel, Maneuver};
use crate::http::answer::decimate::{Wanted, pick};
use crate::http::answer::format::{Format, cacheable, choose};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{Id, Parameters};
use crate::http::service::{Server, Service};
use crate::ingest;
use crate::job::Fault;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(get_maneuver_data))
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct DataQuery {
    /// Names of channels, separated by commas; absent: all.
    #[param(example = "alpha,q")]
    channels: Option<String>,
    /// Seconds of the recording: only samples from here on.
    #[param(example = 2.0)]
    from: Option<f64>,
    /// Seconds of the recording: only samples up to here.
    #[param(example = 6.5)]
    to: Option<f64>,
    /// About how many samples to answer with; absent: all. The first, the last, and the least and
    /// greatest of each channel in equal stretches of time are kept, so that a plot looks the same.
    #[param(example = 500)]
    max_points: Option<usize>,
    /// `json` or `csv`; absent: as `Accept` says.
    #[param(inline)]
    format: Option<Format>,
}

/// The samples, SI, in the form of an upload.
#[utoipa::path(get, path = "/v1/maneuvers/{id}/data", tag = "Maneuvers", operation_id = "getManeuverData",
    params(("id" = String, Path), DataQuery),
    responses(
        (status = 200, description = "The samples.", content(
            (ingest::Recording = "application/json"), (String = "text/csv")),
            headers(("x-trimtab-samples" = usize, description = "Samples of the recording, before `from`, `to` and `max_points`."))),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 400, description = "`invalid_query`: a channel is not there, `from` or `to` is no number of seconds, or no two samples lie between them.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 404, description = "`unknown_maneuver`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_maneuver_data(
    service: Service,
    Id(id): Id,
    Parameters(query): Parameters<DataQuery>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let format = choose(query.format, &headers, &[Format::Json, Format::Csv])?;
    let wanted = Wanted::of(query.from, query.to, query.max_points)?;
    let maneuver = service
        .store
        .maneuver_data(&id)
        .await?
        .ok_or_else(|| unknown_maneuver(&id))?;
    let samples = maneuver.len();
    let write = move || {
        let part = part(&maneuver, query.channels.as_deref(), wanted)?;
        let text = match format {
            Format::Csv => ingest::to_csv(&part, |_| true),
            _ => ingest::to_json(&part)?,
        };
        Ok::<_, Problem>(cacheable(&headers, format, text))
    };
    let mut response = service.compute.run(write).await??;
    let name = HeaderName::from_static("x-trimtab-samples");
    response
        .headers_mut()
        .insert(name, HeaderValue::from(samples));
    Ok(response)
}

/// Some channels and samples of a maneuver.
fn part(maneuver: &Maneuver, channels: Option<&str>, wanted: Wanted) -> Result<Maneuver, Problem> {
    let mut chosen: Vec<(&String, &Channel)> = maneuver.channels().iter().collect();
    if let Some(names) = channels {
        let names: Vec<&str> = names.split(',').map(str::trim).collect();
        let known = |name: &&str| maneuver.channels().contains_key(*name);
        let unknown = names.iter().filter(|name| !known(name));
        let faults: Vec<Fault> = unknown
            .map(|name| {
                let all: Vec<&str> = maneuver.channels().keys().map(String::as_str).collect();
                let message = format!("there is no channel '{name}'; there are {}", all.join(", "));
                Fault::new("", "unknown_channel", message)
            })
            .collect();
        if !faults.is_empty() {
            return Err(Problem::of_faults(Code::InvalidQuery, faults));
        }
        chosen.retain(|(name, _)| names.contains(&name.as_str()));
    }
    let columns: Vec<&[f64]> = chosen.iter().map(|(_, channel)| &*channel.values).collect();
    let rows = wanted.rows(maneuver.time(), &columns);
    let channels = chosen.iter().map(|(name, channel)| {
        let values = pick(&channel.values, &rows);
        let Channel {
            recorded_unit,
            unit,
            ..
        } = channel;
        let channel = Channel {
            recorded_unit: recorded_unit.clone(),
            unit: *unit,
            values,
        };
        ((*name).clone(), channel)
    });
    let time = pick(maneuver.time(), &rows);
    Maneuver::new(time, channels.collect()).map_err(|error| {
        let all = maneuver.time();
        let detail = format!(
            "between from and to: {error}; the recording goes from {} s to {} s",
            all[0],
            all[all.len() - 1]
        );
        Problem::new(Code::InvalidQuery, detail)
    })
}
