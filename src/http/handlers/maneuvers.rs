//! `/v1/maneuvers`: recordings.

use std::sync::Arc;

use axum::Json;
use axum::body::Body;
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::mappings;
use crate::flight::{Channel, Maneuver};
use crate::http::answer::decimate::{Wanted, pick};
use crate::http::answer::format::{Format, cacheable, choose};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::body;
use crate::http::request::query::{Id, PageQuery, Parameters, bad_cursor, page_limit};
use crate::http::service::{Server, Service};
use crate::ingest::{self, Summary};
use crate::job::Fault;
use crate::store::{ManeuverRecord, Uploaded};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(upload_maneuver, list_maneuvers))
        .routes(routes!(get_maneuver))
        .routes(routes!(get_maneuver_data))
}

pub(crate) const LONGEST_NAME: usize = 200;

/// A recording that was uploaded.
#[derive(Serialize, ToSchema)]
#[schema(as = Maneuver)]
pub(crate) struct ManeuverResource {
    /// SHA-256 of the content: the same recording has the same id.
    #[schema(example = "3f0a1c0f6f5a7a0e8f3a0f0c8f7a1b2c3d4e5f60718293a4b5c6d7e8f9a0b1c2")]
    id: String,
    #[schema(example = "ATTAS elevator 3-2-1-1")]
    name: String,
    #[schema(example = "2026-11-21T12:00:00.123Z")]
    created: String,
    #[schema(value_type = Summary)]
    summary: Box<RawValue>,
    links: ManeuverLinks,
}

#[derive(Serialize, ToSchema)]
struct ManeuverLinks {
    #[serde(rename = "self")]
    this: String,
    data: String,
}

impl ManeuverResource {
    fn of(record: ManeuverRecord) -> Result<Self, Problem> {
        let this = format!("/v1/maneuvers/{}", record.id);
        Ok(Self {
            summary: RawValue::from_string(record.summary)?,
            id: record.id,
            name: record.name,
            created: record.created,
            links: ManeuverLinks {
                data: format!("{this}/data"),
                this,
            },
        })
    }
}

#[derive(Serialize, ToSchema)]
pub(crate) struct ManeuverPage {
    maneuvers: Vec<ManeuverResource>,
    next_cursor: Option<String>,
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct UploadQuery {
    /// For people; at most 200 characters.
    #[param(example = "ATTAS elevator 3-2-1-1")]
    name: Option<String>,
    /// Where a MAT, HDF5, TDMS or MDF file, a log or an ASCII matrix has time and channels, and in which units; for a table of text or a workbook,
    /// what it does not say, or says otherwise than is meant. The name of a mapping that is bundled (`GET /v1/mappings`) or
    /// kept there, or a JSON document. Sources are variables (`alpha`), fields of structs (`rec.alpha`,
    /// `scope.signals(1).values`), fields of messages (`IMU[1].GyrY`), datasets (`air/alpha`), channels of groups (`Fuel.mass`), columns (`data(:,2)`) or rows (`data(2,:)`) of any, or
    /// columns of the only matrix of a file (`(:,2)`). Of a table of text they are titles as they stand there, with or without
    /// their units (`Elev Pos`), or columns (`(:,2)`); its other columns are left out.
    #[param(
        example = "{\"time\": {\"from\": \"data(:,1)\", \"unit\": \"s\"}, \"channels\": {\"alpha\": {\"from\": \"data(:,2)\", \"unit\": \"deg\"}}}"
    )]
    mapping: Option<String>,
}

/// The bytes of a MAT file of any version (`save -v7.3`, `save -v7`, `save -v6`, `save -v4`).
#[derive(ToSchema)]
#[schema(value_type = String, format = Binary)]
#[expect(dead_code, reason = "it is there for the API's document")]
struct MatFile(Vec<u8>);

/// The bytes of a file that its first bytes tell: a workbook of Excel (`.xlsx`), Parquet, HDF5, TDMS, MDF 4, a log of
/// PX4 (`.ulg`) or ArduPilot (`.bin`), or any recording packed with gzip or zip.
#[derive(ToSchema)]
#[schema(value_type = String, format = Binary)]
#[expect(dead_code, reason = "it is there for the API's document")]
struct AnyFile(Vec<u8>);

/// Upload a recording.
///
/// A table of text as loggers, simulators and spreadsheets write them: lines before the header, names and units in brackets
/// or in rows of their own, behind a comment's sign or not; separated by commas, semicolons, tabs, vertical bars or blanks;
/// decimal points or commas; time in a unit or as time stamps. The charset of the media type holds, else it is found out. A
/// column that cannot be read is left out, with a finding. With a `mapping`, other names and units than it states. Or a
/// workbook of Excel, whose first sheet with a table is read so, too, a Parquet file, or HDF5 with one frame of pandas. Or
/// JSON. Or, with a `mapping`, a MAT file, another HDF5 file or an ASCII matrix. Or a TDMS or MDF 4 file, whose channels say
/// their units and times. Or a log of PX4 or ArduPilot, without a `mapping` by those called `px4` and `ardupilot`.
///
/// Whatever the `Content-Type` says, a file is what its first bytes tell; it may be packed with gzip or zip. What is not read is
/// refused with its name and how to convert it. Channels of several tables with times of their own keep their samples, and
/// have no value at the times of the others. Where a choice is to be made, the answer has the draft of a mapping that makes
/// it, as `mapping`. Values are converted to SI. Content that is here already answers 200 with the maneuver it was first
/// uploaded as.
#[utoipa::path(post, path = "/v1/maneuvers", tag = "Maneuvers", operation_id = "uploadManeuver",
    params(UploadQuery),
    request_body(content(
        (String = "text/csv", example = "t[s],alpha[deg],q[deg/s],de[deg]\n0,1.2,0,0\n0.04,1.2,0.1,-1\n0.08,1.3,0.4,-1\n"),
        (ingest::Recording = "application/json"),
        (MatFile = "application/x-matlab-data"),
        (AnyFile = "application/octet-stream"),
        (String = "text/plain", example = "0.00  1.2  0.0\n0.04  1.2  0.1\n0.08  1.3  0.4\n"),
    )),
    responses(
        (status = 201, description = "It is new.", body = ManeuverResource, headers(("Location" = String, description = "Its path."))),
        (status = 200, description = "The same content was here before.", body = ManeuverResource, headers(("Location" = String, description = "Its path."))),
        (status = 413, description = "`body_too_large`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 415, description = "`unsupported_media_type`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`invalid_maneuver`: `errors` lists all faults, by column and row or JSON pointer.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn upload_maneuver(
    service: Service,
    Parameters(query): Parameters<UploadQuery>,
    headers: HeaderMap,
    body: Body,
) -> Result<Response, Problem> {
    let media_type = body::media_type(&headers);
    let Some(format) = ingest::Format::from_content_type(&media_type) else {
        return Err(body::unsupported(
            &media_type,
            &ingest::Format::CONTENT_TYPES,
        ));
    };
    let name = query.name.unwrap_or_default();
    if name.chars().count() > LONGEST_NAME {
        let detail = format!("name: longer than {LONGEST_NAME} characters");
        return Err(Problem::new(Code::InvalidQuery, detail));
    }
    let mapping = match query.mapping.as_deref() {
        Some(text) => Some(mappings::find(&service, text).await?),
        None => None,
    };
    let limit = service.config.max_maneuver_body;
    let body = body::read(&headers, body, limit, "--max-maneuver-body", &service.room).await?;
    let (bytes, mut room) = (body.bytes, body.room);
    if ingest::is_packed(&bytes) {
        service.room.extend(&mut room, limit).await?;
    }
    let _room = room;
    let limits = ingest::Limits {
        max_bytes: limit,
        ..service.config.recording
    };
    let read = move || {
        let charset = ingest::Format::charset(&media_type);
        let read = ingest::read_recording(&bytes, format, charset, mapping.as_ref(), &limits)?;
        let mut summary = ingest::summary(&read.maneuver);
        summary.findings.splice(0..0, read.findings);
        let summary = serde_json::to_string(&summary)?;
        Ok::<_, Problem>((read.maneuver, summary))
    };
    let (maneuver, summary) = service.compute.run(read).await??;
    let (status, maneuver) = keep_maneuver(&service, &name, maneuver, summary).await?;
    let location = [(header::LOCATION, maneuver.links.this.clone())];
    Ok((status, location, Json(maneuver)).into_response())
}

/// Keeps a recording, if it is not here already, within the project's quota.
pub(crate) async fn keep_maneuver(
    service: &Service,
    name: &str,
    maneuver: Maneuver,
    summary: String,
) -> Result<(StatusCode, ManeuverResource), Problem> {
    let (stored, limit) = (
        service.store.stored_bytes().await?,
        service.config.max_stored_bytes,
    );
    if stored >= limit {
        let detail = format!(
            "the project's maneuvers take {stored} bytes, and {limit} are allowed (--max-stored-bytes); delete those that are no longer needed"
        );
        return Err(Problem::new(Code::QuotaExceeded, detail));
    }
    let uploaded = service
        .store
        .add_maneuver(name, Arc::new(maneuver), summary)
        .await?;
    let (status, record) = match uploaded {
        Uploaded::New(record) => (StatusCode::CREATED, record),
        Uploaded::Known(record) => (StatusCode::OK, record),
    };
    Ok((status, ManeuverResource::of(record)?))
}

/// List maneuvers, newest first.
#[utoipa::path(get, path = "/v1/maneuvers", tag = "Maneuvers", operation_id = "listManeuvers",
    params(PageQuery),
    responses((status = 200, description = "A page.", body = ManeuverPage)))]
async fn list_maneuvers(
    service: Service,
    Parameters(query): Parameters<PageQuery>,
) -> Result<Json<ManeuverPage>, Problem> {
    let limit = page_limit(query.limit)?;
    let page = service
        .store
        .maneuvers(query.cursor.as_deref(), limit)
        .await?;
    let page = page.map_err(bad_cursor)?;
    let maneuvers = page.entries.into_iter().map(ManeuverResource::of);
    Ok(Json(ManeuverPage {
        maneuvers: maneuvers.collect::<Result<_, _>>()?,
        next_cursor: page.next_cursor,
    }))
}

pub(crate) fn unknown_maneuver(id: &str) -> Problem {
    let id: String = id.chars().take(80).collect();
    Problem::new(
        Code::UnknownManeuver,
        format!("there is no maneuver '{id}'; upload it first"),
    )
}

/// What a maneuver is, without its samples.
#[utoipa::path(get, path = "/v1/maneuvers/{id}", tag = "Maneuvers", operation_id = "getManeuver",
    params(("id" = String, Path)),
    responses(
        (status = 200, description = "The maneuver.", body = ManeuverResource),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 404, description = "`unknown_maneuver`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_maneuver(
    service: Service,
    Id(id): Id,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let record = service
        .store
        .maneuver(&id)
        .await?
        .ok_or_else(|| unknown_maneuver(&id))?;
    let json = serde_json::to_vec(&ManeuverResource::of(record)?)?;
    Ok(cacheable(&headers, Format::Json, json))
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
        (status = 404, description = "`unknown_maneuver`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_maneuver_data(
    service: Service,
    Id(id): Id,
    Parameters(query): Parameters<DataQuery>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let format = choose(query.format, &headers, &[Format::Json, Format::Csv])?;
    let maneuver = service
        .store
        .maneuver_data(&id)
        .await?
        .ok_or_else(|| unknown_maneuver(&id))?;
    let samples = maneuver.len();
    let wanted = Wanted {
        from: query.from,
        to: query.to,
        most: query.max_points,
    };
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
