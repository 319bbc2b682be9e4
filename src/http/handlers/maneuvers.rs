//! `/v1/maneuvers`: recordings.

use std::sync::Arc;

use axum::Json;
use axum::body::Body;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::{mappings, several};
use crate::flight::{Flown, Maneuver};
use crate::http::answer::format::{Format, cacheable};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{Id, Parameters, bad_cursor, page_limit, search};
use crate::http::request::{body, multipart};
use crate::http::service::{Server, Service};
use crate::ingest::{self, Summary};
use crate::store::{ManeuverFilter, ManeuverRecord, Uploaded};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(upload_maneuver, list_maneuvers))
        .routes(routes!(upload_file))
        .routes(routes!(get_maneuver))
}

pub(crate) const LONGEST_NAME: usize = 200;

/// A recording that was uploaded.
#[derive(Serialize, ToSchema)]
#[schema(as = Maneuver)]
pub(crate) struct ManeuverResource {
    /// SHA-256 of the content: the same recording has the same id.
    #[schema(example = "3f0a1c0f6f5a7a0e8f3a0f0c8f7a1b2c3d4e5f60718293a4b5c6d7e8f9a0b1c2")]
    id: String,
    /// For people; as it was given, and empty if it was not.
    #[schema(example = "ATTAS elevator 3-2-1-1")]
    name: String,
    /// When it was first uploaded, RFC 3339.
    #[schema(example = "2026-11-21T12:00:00.123Z")]
    created: String,
    /// Its length, sampling and channels, and what is odd about it.
    #[schema(value_type = Summary)]
    summary: Box<RawValue>,
    /// What was flown, as far as it was said; `PATCH` says more of it.
    flown: Flown,
    /// Where the rest of it is.
    links: ManeuverLinks,
}

/// Paths of what there is of a recording.
#[derive(Serialize, ToSchema)]
struct ManeuverLinks {
    /// The recording without its samples.
    #[serde(rename = "self")]
    this: String,
    /// Its samples.
    data: String,
}

impl ManeuverResource {
    pub(crate) fn of(record: ManeuverRecord) -> Result<Self, Problem> {
        let this = format!("/v1/maneuvers/{}", record.id);
        Ok(Self {
            summary: RawValue::from_string(record.summary)?,
            id: record.id,
            name: record.name,
            created: record.created,
            flown: record.flown,
            links: ManeuverLinks {
                data: format!("{this}/data"),
                this,
            },
        })
    }
}

/// A page of recordings.
#[derive(Serialize, ToSchema)]
pub(crate) struct ManeuverPage {
    /// Newest first.
    maneuvers: Vec<ManeuverResource>,
    /// What to say in `cursor` for the next page; `null`: this is the last.
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

/// The bytes of a file, which tell what it is: a table of text (CSV and its like), an ASCII matrix, a MAT file of any version, a
/// workbook of Excel (`.xlsx`), Parquet, HDF5, TDMS, MDF 4, a log of PX4 (`.ulg`) or ArduPilot (`.bin`), or any of these
/// packed with gzip or zip.
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
/// A file may come as `application/octet-stream`, or as what it is (`text/csv`, `text/plain`, `application/x-matlab-data`):
/// whatever the `Content-Type` says, a file is what its first bytes tell; it may be packed with gzip or zip. What is not read is
/// refused with its name and how to convert it. Channels of several tables with times of their own keep their samples, and
/// have no value at the times of the others. Where a choice is to be made, the answer has the draft of a mapping that makes
/// it, as `mapping`. Values are converted to SI. Content that is here already answers 200 with the maneuver it was first
/// uploaded as.
///
/// Several files of `multipart/form-data` are one recording: each keeps its times, put together by their time stamps, and by
/// `offsets` where there are none or clocks are off; nothing is interpolated.
#[utoipa::path(post, path = "/v1/maneuvers", tag = "Maneuvers", operation_id = "uploadManeuver",
    params(UploadQuery),
    request_body(content(
        (ingest::Recording = "application/json"),
        (AnyFile = "application/octet-stream"),
        (several::SeveralFiles = "multipart/form-data"),
    )),
    responses(
        (status = 201, description = "It is new.", body = ManeuverResource, headers(("Location" = String, description = "Its path."))),
        (status = 200, description = "The same content was here before.", body = ManeuverResource, headers(("Location" = String, description = "Its path."))),
        (status = 400, description = "`invalid_multipart`", body = ProblemDocument, content_type = "application/problem+json"),
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
    // with its parameters, of which the charset is one, and the boundary
    let content_type = body::content_type(&headers).to_owned();
    let media_type = body::media_type(&headers);
    let format = ingest::Format::from_content_type(&media_type);
    let is_several = media_type == multipart::MEDIA_TYPE;
    if format.is_none() && !is_several {
        let known = ingest::Format::CONTENT_TYPES.iter().copied();
        let known: Vec<&str> = known.chain([multipart::MEDIA_TYPE]).collect();
        return Err(body::unsupported(&media_type, &known));
    }
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
    if is_several || ingest::is_packed(&bytes) {
        service.room.extend(&mut room, limit).await?;
    }
    let (bytes, several) = match is_several {
        true => {
            let parts = multipart::parts(&content_type, bytes.into()).await?;
            let said = several::said(&service, &parts).await?;
            (Vec::new(), Some((parts, said)))
        }
        false => (bytes, None),
    };
    let _room = room;
    let limits = ingest::Limits {
        max_bytes: limit,
        ..service.config.recording
    };
    let read = move || {
        let mapping = mapping.as_ref();
        let read = match &several {
            Some((parts, said)) => several::read(parts, said, mapping, &limits)?,
            None => {
                let format = format.unwrap_or(ingest::Format::Unstated);
                let charset = ingest::Format::charset(&content_type);
                ingest::read_recording(&bytes, format, charset, mapping, &limits)?
            }
        };
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

/// Upload a recording's file.
///
/// The same as `POST /v1/maneuvers` with `application/octet-stream`, for clients made by generators: the body is the file's
/// bytes, and nothing else.
#[utoipa::path(post, path = "/v1/maneuvers/files", tag = "Maneuvers", operation_id = "uploadFile",
    params(UploadQuery),
    request_body(content = AnyFile, content_type = "application/octet-stream"),
    responses(
        (status = 201, description = "It is new.", body = ManeuverResource, headers(("Location" = String, description = "Its path."))),
        (status = 200, description = "The same content was here before.", body = ManeuverResource, headers(("Location" = String, description = "Its path."))),
        (status = 413, description = "`body_too_large`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 415, description = "`unsupported_media_type`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`invalid_maneuver`: `errors` lists all faults, by column and row or JSON pointer.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn upload_file(
    service: Service,
    query: Parameters<UploadQuery>,
    headers: HeaderMap,
    body: Body,
) -> Result<Response, Problem> {
    upload_maneuver(service, query, headers, body).await
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

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct ListQuery {
    /// `next_cursor` of the page before; absent: the first page.
    cursor: Option<String>,
    /// Maneuvers of the page, 1 to 200; 50 if absent.
    #[param(minimum = 1, maximum = 200)]
    limit: Option<usize>,
    /// Only those that have this tag.
    tag: Option<String>,
    /// Only those of this aircraft.
    aircraft: Option<String>,
    /// Only those of this registration.
    registration: Option<String>,
    /// Only those of this flight.
    flight: Option<String>,
    /// Only those of this test point.
    test_point: Option<String>,
    /// Only those that have each of these words in their name, tags, notes, or what else is said of the flight in words,
    /// upper case or lower.
    #[param(max_length = 200, example = "3-2-1-1 flaps")]
    q: Option<String>,
}

/// List maneuvers, newest first.
#[utoipa::path(get, path = "/v1/maneuvers", tag = "Maneuvers", operation_id = "listManeuvers",
    params(ListQuery),
    responses((status = 200, description = "A page.", body = ManeuverPage)))]
async fn list_maneuvers(
    service: Service,
    Parameters(query): Parameters<ListQuery>,
) -> Result<Json<ManeuverPage>, Problem> {
    let limit = page_limit(query.limit)?;
    let filter = ManeuverFilter {
        tag: query.tag,
        aircraft: query.aircraft,
        registration: query.registration,
        flight: query.flight,
        test_point: query.test_point,
        search: search(query.q.as_deref())?,
    };
    let page = service
        .store
        .maneuvers(&filter, query.cursor.as_deref(), limit)
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
