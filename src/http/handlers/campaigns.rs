//! `/v1/campaigns`: what many jobs say of the same parameters, over the conditions in which they were flown.

use axum::http::HeaderMap;
use axum::response::Response;
use serde::Deserialize;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::http::answer::campaign_table::campaign_as_csv;
use crate::http::answer::format::{Format, choose, plain};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{LONGEST_PAGE, Parameters, bad_cursor};
use crate::http::service::{Server, Service};
use crate::job::{
    Campaign, CampaignQuestion, Flown, JobSpec, Status, UsedRecording, campaign, conditions_of,
};
use crate::store::{JobFilter, JobRecord, Part};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(get_campaign))
}

/// Jobs of one campaign, at most.
const MOST_JOBS: usize = 1000;

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct CampaignQuery {
    /// The tag that all jobs of the campaign have.
    #[param(example = "campaign 7")]
    tag: String,
    /// Conditions with numbers over which parameters are curves, at most 4, with commas between: `alpha,mach` where jobs have tags such as
    /// `alpha=5` and `mach=0.4`. Absent: weighted means.
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

/// What the finished jobs of a tag say of the same parameters: a curve over the conditions in their tags (or a weighted mean), with
/// its bounds, whether the jobs agree (χ²), and which of them are outliers. Of jobs that were fitted to the same samples, such as
/// reruns, the newest counts, and `left_out` has the others.
#[utoipa::path(get, path = "/v1/campaigns", tag = "Results", operation_id = "getCampaign",
    params(CampaignQuery),
    responses(
        (status = 200, description = "The campaign.", content((Campaign = "application/json"), (String = "text/csv"))),
        (status = 400, description = "`invalid_query`: no job has the tag, too many have it, or conditions or degree cannot be.", body = ProblemDocument, content_type = "application/problem+json"),
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
    let flown = flown(&service, &query.tag).await?;
    if flown.is_empty() {
        return refuse(format!(
            "tag: no finished job with a result has the tag '{}'",
            query.tag
        ));
    }
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

/// The finished jobs of a tag, oldest first.
async fn flown(service: &Service, tag: &str) -> Result<Vec<Flown>, Problem> {
    let filter = JobFilter {
        status: Some(Status::Succeeded),
        tag: Some(tag.to_string()),
        ..JobFilter::default()
    };
    let (mut records, mut cursor): (Vec<JobRecord>, Option<String>) = (Vec::new(), None);
    loop {
        let page = service
            .store
            .jobs(&filter, cursor.as_deref(), LONGEST_PAGE)
            .await?;
        let page = page.map_err(bad_cursor)?;
        records.extend(page.entries);
        if records.len() > MOST_JOBS {
            let detail = format!(
                "tag: more than {MOST_JOBS} jobs have the tag '{tag}'; give a smaller campaign a tag of its own"
            );
            return Err(Problem::new(Code::InvalidQuery, detail));
        }
        cursor = page.next_cursor;
        if cursor.is_none() {
            break;
        }
    }
    // in the order in which they were submitted
    records.sort_by_key(|record| record.id);
    let mut flown = Vec::new();
    for record in records {
        let Some(text) = service.store.result_part(record.id, Part::Estimate).await? else {
            continue;
        };
        let Some(spec) = service.store.job_spec(record.id).await? else {
            continue;
        };
        let read = || {
            let spec: JobSpec = serde_json::from_str(&spec)?;
            Ok::<_, serde_json::Error>((spec, serde_json::from_str(&text)?))
        };
        let (spec, estimate) = match read() {
            Ok(read) => read,
            // one of many: the others are shown
            Err(error) => {
                tracing::error!(%error, job = %record.id, "its estimate cannot be read");
                continue;
            }
        };
        flown.push(Flown {
            job: record.id.to_string(),
            name: record.title(),
            conditions: conditions_of(&record.tags),
            recordings: UsedRecording::of(&spec.maneuvers),
            estimate,
        });
    }
    Ok(flown)
}
