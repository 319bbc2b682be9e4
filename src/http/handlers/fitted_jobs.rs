//! Finished jobs as a campaign or a comparison takes them: what they were fitted to, under which conditions, and what came of it.

use std::sync::Arc;

use uuid::Uuid;

use super::jobs::{job, results};
use crate::flight::Maneuver;
use crate::http::code::Code;
use crate::http::problem::Problem;
use crate::http::request::query::{LONGEST_PAGE, bad_cursor, unknown_job};
use crate::http::service::Service;
use crate::job::{
    Flown, JobSpec, ManeuverUse, Status, UsedRecording, channel_of, conditions_of, mean_over,
    part_in_use,
};
use crate::store::{JobFilter, JobRecord, Part};

/// Jobs of one campaign, at most.
const MOST_JOBS: usize = 1000;

/// Ids with commas between, each once, in their order.
///
/// # Errors
/// One is no id, or there are more than `most`.
pub(crate) fn ids_of(text: &str, most: usize) -> Result<Vec<Uuid>, Problem> {
    let mut ids = Vec::new();
    for word in text
        .split(',')
        .map(str::trim)
        .filter(|word| !word.is_empty())
    {
        let id = Uuid::parse_str(word).map_err(|_| unknown_job(word))?;
        if !ids.contains(&id) {
            ids.push(id);
        }
    }
    if ids.len() > most {
        let detail = format!("jobs: {} jobs; name at most {most}", ids.len());
        return Err(Problem::new(Code::InvalidQuery, detail));
    }
    Ok(ids)
}

/// These jobs in their order. Conditions of the form `mean(alpha)` are looked up in what they were fitted to.
///
/// # Errors
/// One is unknown, not finished, or without a result.
pub(crate) async fn of_ids(
    service: &Service,
    ids: &[Uuid],
    conditions: &[String],
) -> Result<Vec<Flown>, Problem> {
    let mut flown = Vec::with_capacity(ids.len());
    let mut means = Means::default();
    for &id in ids {
        let record = job::find(service, id).await?;
        let estimate = results::part(service, id, Part::Estimate).await?;
        let spec = service.store.job_spec(id).await?;
        let spec = spec.ok_or_else(|| unknown_job(id))?;
        let mut one = read(&record, &spec, &estimate)?;
        means.add(service, &spec, conditions, &mut one).await?;
        flown.push(one);
    }
    Ok(flown)
}

/// The finished jobs of a tag, oldest first; otherwise as [`of_ids`].
///
/// # Errors
/// Too many have the tag.
pub(crate) async fn of_tag(
    service: &Service,
    tag: &str,
    conditions: &[String],
) -> Result<Vec<Flown>, Problem> {
    let mut flown = Vec::new();
    let mut means = Means::default();
    for record in tagged(service, tag).await? {
        let Some(estimate) = service.store.result_part(record.id, Part::Estimate).await? else {
            continue;
        };
        let Some(spec) = service.store.job_spec(record.id).await? else {
            continue;
        };
        match read(&record, &spec, &estimate) {
            Ok(mut one) => {
                means.add(service, &spec, conditions, &mut one).await?;
                flown.push(one);
            }
            // one of many: the others are shown
            Err(error) => {
                tracing::error!(%error, job = %record.id, "its estimate cannot be read");
            }
        }
    }
    Ok(flown)
}

/// In the order in which they were submitted.
async fn tagged(service: &Service, tag: &str) -> Result<Vec<JobRecord>, Problem> {
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
    records.sort_by_key(|record| record.id);
    Ok(records)
}

fn read(record: &JobRecord, spec: &str, estimate: &str) -> serde_json::Result<Flown> {
    let spec: JobSpec = serde_json::from_str(spec)?;
    Ok(Flown {
        job: record.id.to_string(),
        name: record.title(),
        conditions: conditions_of(&record.tags),
        recordings: UsedRecording::of(&spec.maneuvers),
        estimate: serde_json::from_str(estimate)?,
    })
}

/// Means of channels. Jobs of one campaign often use parts of one recording: the last is kept.
#[derive(Default)]
struct Means {
    last: Option<(String, Arc<Maneuver>)>,
}

impl Means {
    /// Adds the means that are asked for to a job's conditions; a channel that a recording lacks has none.
    async fn add(
        &mut self,
        service: &Service,
        spec: &str,
        conditions: &[String],
        flown: &mut Flown,
    ) -> Result<(), Problem> {
        let means: Vec<(&String, &str)> = (conditions.iter())
            .filter_map(|name| Some((name, channel_of(name)?)))
            .collect();
        if means.is_empty() {
            return Ok(());
        }
        let spec: JobSpec = serde_json::from_str(spec)?;
        let fitted = spec.maneuvers.iter().filter(|used| used.is_fitted());
        let mut parts: Vec<Vec<Option<Vec<f64>>>> = vec![Vec::new(); means.len()];
        for usage in fitted {
            let maneuver = self.recording(service, &usage.id).await?;
            for ((_, channel), parts) in means.iter().zip(&mut parts) {
                parts.push(
                    maneuver
                        .as_deref()
                        .and_then(|it| samples(usage, it, channel)),
                );
            }
        }
        for ((name, _), parts) in means.into_iter().zip(parts) {
            let all: Option<Vec<Vec<f64>>> = parts.into_iter().collect();
            let mean = all.and_then(|all| mean_over(all.iter().map(Vec::as_slice)));
            if let Some(mean) = mean {
                flown.conditions.insert(name.clone(), mean.to_string());
            }
        }
        Ok(())
    }

    async fn recording(
        &mut self,
        service: &Service,
        id: &str,
    ) -> Result<Option<Arc<Maneuver>>, Problem> {
        if let Some((last, maneuver)) = &self.last
            && last == id
        {
            return Ok(Some(maneuver.clone()));
        }
        let maneuver = service.store.maneuver_data(id).await?.map(Arc::new);
        self.last = maneuver.clone().map(|maneuver| (id.to_string(), maneuver));
        Ok(maneuver)
    }
}

fn samples(usage: &ManeuverUse, maneuver: &Maneuver, channel: &str) -> Option<Vec<f64>> {
    let rows = part_in_use(usage, maneuver)?;
    Some(maneuver.channels().get(channel)?.values[rows].to_vec())
}
