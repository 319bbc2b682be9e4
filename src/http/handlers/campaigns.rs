//! `/v1/campaigns`: what many jobs say of the same parameters, over the conditions in which they were flown.

use axum::http::HeaderMap;
use axum::response::Response;
use serde::Deserialize;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::fitted_jobs::{ids_of, of_ids, of_tag};
use crate::http::answer::campaign_table::campaign_as_csv;
use crate::http::answer::format::{Format, choose, plain};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::Parameters;
use crate::http::service::{Server, Service};
use crate::job::{Campaign, CampaignQuestion, campaign};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(get_campaign))
}

/// Jobs that are named one by one, at most.
const MOST_NAMED: usize = 200;

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct CampaignQuery {
    /// The tag that all jobs of the campaign have; this or `jobs`.
    #[param(example = "campaign 7")]
    tag: Option<String>,
    /// Ids of finished jobs, at most 200, with commas between; this or `tag`.
    #[param(example = "0193518e-6b6f-7d3c-9c53-b1cbb2b7a1f4,0193518e-7a10-7c44-8b1d-0a3f5e2c9d71")]
    jobs: Option<String>,
    /// Conditions with numbers over which parameters are curves, at most 4, with commas between: `alpha,mach` where jobs have tags such as
    /// `alpha=5` and `mach=0.4`; `mean(alpha)` is the mean of a channel, in SI, over what a job was fitted to. Absent: weighted means.
    #[param(example = "alpha,mach")]
    by: Option<String>,
    /// Conditions with words, at most 8, with commas between; each combination has curves of its own.
    #[param(example = "flaps")]
    group: Option<String>,
    /// Parameters, with commas between; absent: all that are shared by maneuvers and have a standard error.
    #[param(example = "Ma,Mq")]
    parameters: Option<String>,
    /// Highest degree of the polynomials, 0 to 3; absent: 2, or less where there are too few conditions.
    #[param(example = 2, maximum = 3)]
    degree: Option<usize>,
    /// `json` or `csv`; absent: as `Accept` says.
    #[param(inline)]
    format: Option<Format>,
}

/// What the finished jobs of a tag, or those that are named, say of the same parameters: a curve over conditions, which are tags or means of
/// channels (or a weighted mean), with its bounds, whether the jobs agree (χ²), and which of them are outliers. Of jobs that were fitted to the same samples, such as
/// reruns, the newest counts, and `left_out` has the others.
#[utoipa::path(get, path = "/v1/campaigns", tag = "Results", operation_id = "getCampaign",
    params(CampaignQuery),
    responses(
        (status = 200, description = "The campaign.", content((Campaign = "application/json"), (String = "text/csv"))),
        (status = 400, description = "`invalid_query`: no job has the tag, too many have it, or conditions or degree cannot be.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 404, description = "`unknown_job`, `no_result`: of `jobs`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`: of `jobs`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_campaign(
    service: Service,
    Parameters(query): Parameters<CampaignQuery>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let format = choose(query.format, &headers, &[Format::Json, Format::Csv])?;
    let refuse = |detail: String| Err(Problem::new(Code::InvalidQuery, detail));
    let names = |text: &Option<String>| -> Vec<String> {
        let all = text.iter().flat_map(|text| text.split(',')).map(str::trim);
        all.filter(|name| !name.is_empty())
            .map(ToString::to_string)
            .collect()
    };
    let question = CampaignQuestion {
        by: names(&query.by),
        group: names(&query.group),
        parameters: names(&query.parameters),
        degree: query.degree,
    };
    if let Some((field, message)) = question.fault() {
        return refuse(format!("{field}: {message}"));
    }
    let flown = match (&query.tag, &query.jobs) {
        (Some(tag), None) => {
            let flown = of_tag(&service, tag, &question.by).await?;
            if flown.is_empty() {
                return refuse(format!(
                    "tag: no finished job with a result has the tag '{tag}'"
                ));
            }
            flown
        }
        (None, Some(jobs)) => of_ids(&service, &ids_of(jobs, MOST_NAMED)?, &question.by).await?,
        _ => return refuse("tag: give a tag, or jobs with commas between, and not both".into()),
    };
    let answer = move || {
        let campaign: Campaign = campaign(&flown, &question);
        let body = match format {
            Format::Csv => campaign_as_csv(&campaign).into_bytes(),
            _ => serde_json::to_vec(&campaign)?,
        };
        Ok(plain(format, body))
    };
    service.compute.run(answer).await?
}
