//! `/v1/compare`: what some jobs say of the same parameters, side by side.

use axum::http::HeaderMap;
use axum::response::Response;
use serde::Deserialize;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::fitted_jobs::{ids_of, of_ids};
use crate::http::answer::comparison_table::comparison_as_csv;
use crate::http::answer::format::{Format, choose, plain};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::Parameters;
use crate::http::service::{Server, Service};
use crate::job::{Comparison, Flown, compare};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(compare_jobs))
}

/// Jobs that are compared at once, at most.
const MOST: usize = 50;

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct CompareQuery {
    /// Ids of 2 to 50 finished jobs, with commas between. Differences are from the first.
    #[param(example = "0193518e-6b6f-7d3c-9c53-b1cbb2b7a1f4,0193518e-7a10-7c44-8b1d-0a3f5e2c9d71")]
    jobs: String,
    /// `json` or `csv`; absent: as `Accept` says.
    #[param(inline)]
    format: Option<Format>,
}

/// Parameters of some jobs side by side: each with its standard error, and its difference from the first job's in standard
/// errors of the difference of independent estimates. Which jobs were fitted to samples of the same recording, and are not
/// independent, is said. CSV has a row for each parameter and job.
#[utoipa::path(get, path = "/v1/compare", tag = "Results", operation_id = "compareJobs",
    params(CompareQuery),
    responses(
        (status = 200, description = "The comparison.", content((Comparison = "application/json"), (String = "text/csv"))),
        (status = 400, description = "`invalid_query`: fewer jobs than 2 or more than 50.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn compare_jobs(
    service: Service,
    Parameters(query): Parameters<CompareQuery>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let format = choose(query.format, &headers, &[Format::Json, Format::Csv])?;
    let jobs = to_compare(&service, &query.jobs, &[]).await?;
    let answer = move || {
        let comparison: Comparison = compare(&jobs);
        let body = match format {
            Format::Csv => comparison_as_csv(&comparison).into_bytes(),
            _ => serde_json::to_vec(&comparison)?,
        };
        Ok(plain(format, body))
    };
    service.compute.run(answer).await?
}

/// The jobs of a query, two or more.
///
/// # Errors
/// One is unknown or has no result, or there are too few or too many.
pub(crate) async fn to_compare(
    service: &Service,
    jobs: &str,
    conditions: &[String],
) -> Result<Vec<Flown>, Problem> {
    let ids = ids_of(jobs, MOST)?;
    if ids.len() < 2 {
        let detail = "jobs: two or more are compared; name them with commas between";
        return Err(Problem::new(Code::InvalidQuery, detail));
    }
    of_ids(service, &ids, conditions).await
}
