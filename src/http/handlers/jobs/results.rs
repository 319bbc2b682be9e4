//! What a finished job answers: the estimate, its parameter table, the model as estimated. Time
//! histories are in `histories`.

use axum::http::HeaderMap;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;
use uuid::Uuid;

use super::job;
use crate::estimate::{
    Bound, CollinearSet, ErrorBoundsKind, Estimate, FilterEstimate, Outcome, ParameterEstimate,
};
use crate::flight::Finding;
use crate::http::answer::format::{Format, cacheable, choose};
use crate::http::code::Code;
use crate::http::handlers::models;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{JobId, Parameters};
use crate::http::service::{Server, Service};
use crate::ingest::CsvWriter;
use crate::job::EventBody;
use crate::model::ModelDocument;
use crate::store::{JobRecord, Part};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(get_estimate))
        .routes(routes!(get_parameters))
        .routes(routes!(get_estimated_model))
}

/// Why there is no result (yet).
pub(crate) fn without_result(job: &JobRecord) -> Problem {
    let status = job.status.name();
    if !job.status.is_over() {
        let id = job.id;
        let detail = format!(
            "the job is {status}; follow /v1/jobs/{id}/events until it is over, and ask again"
        );
        return Problem::new(Code::NotFinished, detail);
    }
    match &job.ending {
        Some(EventBody::Failed { faults }) => Problem::of_faults(Code::NoResult, faults.clone()),
        _ => Problem::new(
            Code::NoResult,
            format!("the job was {status} before there was a result"),
        ),
    }
}

/// One part of a result, as JSON.
pub(crate) async fn part(service: &Service, id: Uuid, part: Part) -> Result<String, Problem> {
    match service.store.result_part(id, part).await? {
        Some(json) => Ok(json),
        None => Err(without_result(&job::find(service, id).await?)),
    }
}

/// The whole estimate.
#[utoipa::path(get, path = "/v1/jobs/{id}/estimate", tag = "Results", operation_id = "getEstimate",
    params(("id" = Uuid, Path)),
    responses(
        (status = 200, description = "The estimate.", body = Estimate),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_estimate(
    service: Service,
    JobId(id): JobId,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let estimate = part(&service, id, Part::Estimate).await?;
    Ok(cacheable(&headers, Format::Json, estimate))
}

/// The parameter table, with what is needed to judge it.
#[derive(Serialize, Deserialize, ToSchema)]
pub(crate) struct ParameterTable {
    /// How good the result is.
    outcome: Outcome,
    /// The outcome in a sentence.
    reason: String,
    /// All of them in the order of the document, those of segments behind each other.
    parameters: Vec<ParameterEstimate>,
    /// What `standard_error` and `correlation` are made from; `null` where they would mean nothing.
    #[serde(default)]
    error_bounds: Option<ErrorBoundsKind>,
    /// Correlation of the free parameters' errors, in the order of the free parameters; with filter error the free
    /// process noises follow. Empty when singular.
    correlation: Vec<Vec<Option<f64>>>,
    /// Sets of parameters that the data cannot tell apart, or cannot see.
    collinear: Vec<CollinearSet>,
    /// With filter error: process noise and gains.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    filter: Option<FilterEstimate>,
    /// What a reader of these numbers should know: of the data in use, of the job, of the fit.
    #[serde(default)]
    findings: Vec<Finding>,
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub(super) struct FormatQuery {
    /// Absent: as `Accept` says.
    #[param(inline)]
    pub(super) format: Option<Format>,
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct TableQuery {
    /// Absent: as `Accept` says.
    #[param(inline)]
    format: Option<Format>,
    /// In CSV: whether the findings stand before the header, each as a line that begins with `#`.
    #[serde(default)]
    comments: bool,
}

/// The parameter table, as JSON or CSV.
#[utoipa::path(get, path = "/v1/jobs/{id}/parameters", tag = "Results", operation_id = "getParameters",
    params(("id" = Uuid, Path), TableQuery),
    responses(
        (status = 200, description = "The table.", content((ParameterTable = "application/json"), (String = "text/csv"))),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_parameters(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<TableQuery>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let format = choose(query.format, &headers, &[Format::Json, Format::Csv])?;
    let estimate = part(&service, id, Part::Estimate).await?;
    let table: ParameterTable = serde_json::from_str(&estimate)?;
    let body = match format {
        Format::Csv if query.comments => {
            comments(&table.findings) + &parameters_as_csv(&table.parameters)
        }
        Format::Csv => parameters_as_csv(&table.parameters),
        _ => serde_json::to_string(&table)?,
    };
    Ok(cacheable(&headers, format, body))
}

/// Each finding as a line that begins with `#`.
fn comments(findings: &[Finding]) -> String {
    let line = |finding: &Finding| {
        let (severity, code) = (finding.severity.name(), &finding.code);
        let sentence = finding.sentence().replace(['\r', '\n'], " ");
        format!("# {severity} {code}: {sentence}\n")
    };
    findings.iter().map(line).collect()
}

fn parameters_as_csv(parameters: &[ParameterEstimate]) -> String {
    let header = [
        "name",
        "segment",
        "unit",
        "start",
        "estimate",
        "standard_error",
        "fixed",
        "at_bound",
        "conventional_standard_error",
        "provisional",
    ];
    let mut csv = CsvWriter::with_header(header);
    for parameter in parameters {
        csv.text(&parameter.name);
        csv.text(parameter.segment.as_deref().unwrap_or_default());
        csv.text(&parameter.unit);
        csv.number(parameter.start);
        csv.number(parameter.estimate);
        csv.number(parameter.standard_error);
        csv.text(if parameter.fixed { "true" } else { "false" });
        csv.text(match parameter.at_bound {
            Some(Bound::Lower) => "lower",
            Some(Bound::Upper) => "upper",
            None => "",
        });
        csv.number(parameter.conventional_standard_error);
        csv.text(if parameter.provisional {
            "true"
        } else {
            "false"
        });
        csv.end_row();
    }
    csv.finish()
}

/// The model as estimated: the one that was named, with the job's edits and overrides in it.
#[utoipa::path(get, path = "/v1/jobs/{id}/model", tag = "Results", operation_id = "getEstimatedModel",
    params(("id" = Uuid, Path), FormatQuery),
    responses(
        (status = 200, description = "The document.", content((ModelDocument = "application/json"), (String = "application/toml"))),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_estimated_model(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<FormatQuery>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let format = choose(query.format, &headers, &[Format::Json, Format::Toml])?;
    let document = serde_json::from_str(&part(&service, id, Part::Model).await?)?;
    models::document_as(format, &headers, &document)
}
