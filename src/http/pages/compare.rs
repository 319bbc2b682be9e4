//! `/compare`: some jobs side by side.

use std::collections::HashSet;

use axum::Router;
use axum::response::Html;
use axum::routing::get;
use serde::Deserialize;

use crate::dashboard::{ChosenCondition, CompareView, Offered, compare_page};
use crate::flight::Unit;
use crate::http::handlers::compare::to_compare;
use crate::http::problem::Problem;
use crate::http::request::query::Parameters;
use crate::http::service::{Server, Service};
use crate::job::{CampaignQuestion, Flown, campaign, compare};

pub(super) fn router() -> Router<Server> {
    Router::new().route("/compare", get(get_compare_page))
}

/// As a form sends it: what is not chosen is empty.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Query {
    #[serde(default)]
    jobs: String,
    #[serde(default)]
    by: String,
    #[serde(default)]
    group: String,
}

async fn get_compare_page(
    service: Service,
    Parameters(query): Parameters<Query>,
) -> Result<Html<String>, Problem> {
    let chosen = |name: &String| -> Vec<String> {
        let name = Some(name.trim()).filter(|name| !name.is_empty());
        name.map(ToString::to_string).into_iter().collect()
    };
    let question = CampaignQuestion {
        by: chosen(&query.by),
        group: chosen(&query.group),
        ..CampaignQuestion::default()
    };
    let jobs = to_compare(&service, &query.jobs, &question.by).await?;
    let mut offered = tags(&jobs);
    offered.channels = channels(&service, &jobs).await?;
    let make = move || {
        compare_page(&CompareView {
            comparison: compare(&jobs),
            campaign: campaign(&jobs, &question),
            offered,
            chosen: ChosenCondition {
                by: query.by,
                group: query.group,
            },
        })
    };
    Ok(Html(service.compute.run(make).await?))
}

/// Conditions that the jobs' tags have: numbers, and words.
fn tags(jobs: &[Flown]) -> Offered {
    let mut offered = Offered::default();
    let names = jobs.iter().flat_map(|job| job.conditions.keys());
    let mut seen = HashSet::new();
    for name in names.filter(|name| seen.insert(*name) && !name.starts_with("mean(")) {
        let values: Vec<&String> = (jobs.iter())
            .filter_map(|job| job.conditions.get(name))
            .collect();
        let are_numbers = values.iter().all(|value| value.parse::<f64>().is_ok());
        if are_numbers {
            offered.numbers.push(name.clone());
        } else {
            offered.words.push(name.clone());
        }
    }
    offered
}

/// Channels, with their SI units, of the first recording that a job was fitted to and is still there.
async fn channels(service: &Service, jobs: &[Flown]) -> Result<Vec<(String, String)>, Problem> {
    for part in jobs.iter().flat_map(|job| &job.recordings) {
        if let Some(maneuver) = service.store.maneuver_data(&part.id).await? {
            let channels = maneuver.channels().iter();
            let of = channels
                .map(|(name, channel)| (name.clone(), Unit::si_name(&channel.recorded_unit)));
            return Ok(of.collect());
        }
    }
    Ok(Vec::new())
}
