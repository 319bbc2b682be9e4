//! A campaign: what many jobs say of the same parameters, over the conditions in which they were flown.
//!
//! Each parameter is a polynomial of the conditions, fitted with weights 1/σ² (of degree 0 the weighted mean), with
//!
//! ```text
//! χ² = Σ (θ_k − curve_k)²/σ_k²,   scatter = max(1, √(χ²/ν))
//! ```
//!
//! over the ν degrees of freedom: where χ² is improbable the flights differ by more than their bounds say, and bounds of the
//! curve are widened by the scatter (R. T. Birge, Phys. Rev. 40, 1932). A flight whose distance from the curve that the others
//! make is improbable is an outlier, is named, and does not count. The law of χ² is that of independent flights: of jobs that
//! were fitted to the same samples, reruns above all, the newest counts.
//!
//! A condition is a tag of the form `name=value`, or the mean of a channel over what a job was fitted to: `mean(alpha)`.

mod condition;
mod curve;
mod mean;
mod monomials;
mod recording;
mod report;
mod written;

use indexmap::IndexMap;
use statrs::distribution::{ChiSquared, ContinuousCDF};

pub use condition::conditions_of;
use curve::{Curve, Observation};
pub use mean::{channel_of, mean_over, part_in_use};
pub use recording::UsedRecording;
pub(super) use recording::share_data;
pub use report::{
    Campaign, CampaignCurve, CampaignPoint, CampaignQuestion, CampaignTerm, Flown, LeftOut,
};

/// Highest degree where nobody says otherwise.
const DEGREE: usize = 2;

/// A job with the conditions that are asked for.
struct Placed<'f> {
    flown: &'f Flown,
    conditions: Vec<f64>,
    group: IndexMap<String, String>,
}

/// Parameters of many jobs, oldest first, over their conditions. The question has no [fault](CampaignQuestion::fault).
pub fn campaign(all: &[Flown], question: &CampaignQuestion) -> Campaign {
    let (placed, left_out) = placed(all, question);
    let mut curves = Vec::new();
    for (parameter, unit) in parameters(&placed, question) {
        let mut groups: Vec<&IndexMap<String, String>> = placed.iter().map(|p| &p.group).collect();
        groups.sort_by_key(|group| format!("{group:?}"));
        groups.dedup();
        for group in groups {
            let of = placed.iter().filter(|placed| placed.group == *group);
            let told: Vec<(&Placed<'_>, Observation)> = of
                .filter_map(|placed| Some((placed, observed(placed, &parameter, &unit)?)))
                .collect();
            curves.extend(curve(&parameter, &unit, group, question, told));
        }
    }
    Campaign { curves, left_out }
}

/// Jobs that can be used, and the others with the reason, both in their order.
fn placed<'f>(all: &'f [Flown], question: &CampaignQuestion) -> (Vec<Placed<'f>>, Vec<LeftOut>) {
    let (mut placed, mut left_out): (Vec<Placed<'_>>, Vec<LeftOut>) = Default::default();
    for flown in all.iter().rev() {
        let newer = |placed: &&Placed<'_>| share_data(&placed.flown.recordings, &flown.recordings);
        let found = match (condition::place(flown, question), placed.iter().find(newer)) {
            (Ok(_), Some(newer)) => Err(format!(
                "job {} is newer and was fitted to the same samples: both are one observation",
                newer.flown.job
            )),
            (found, _) => found,
        };
        match found {
            Ok((conditions, group)) => placed.push(Placed {
                flown,
                conditions,
                group,
            }),
            Err(reason) => left_out.push(LeftOut {
                job: flown.job.clone(),
                name: flown.name.clone(),
                reason,
            }),
        }
    }
    placed.reverse();
    left_out.reverse();
    (placed, left_out)
}

/// Names and units, in the order in which jobs have them.
fn parameters(placed: &[Placed<'_>], question: &CampaignQuestion) -> Vec<(String, String)> {
    let mut names: IndexMap<String, String> = IndexMap::new();
    for row in placed
        .iter()
        .flat_map(|placed| &placed.flown.estimate.parameters)
    {
        let is_wanted = question.parameters.is_empty() || question.parameters.contains(&row.name);
        if is_wanted && row.segment.is_none() && row.standard_error.is_some() {
            names
                .entry(row.name.clone())
                .or_insert_with(|| row.unit.clone());
        }
    }
    names.into_iter().collect()
}

fn observed(placed: &Placed<'_>, parameter: &str, unit: &str) -> Option<Observation> {
    let mut rows = placed.flown.estimate.parameters.iter();
    let row =
        rows.find(|row| row.name == parameter && row.unit == unit && row.segment.is_none())?;
    let error = row
        .standard_error
        .filter(|error| *error > 0.0 && error.is_finite())?;
    Some(Observation {
        conditions: placed.conditions.clone(),
        value: row.estimate,
        error,
    })
}

fn curve(
    parameter: &str,
    unit: &str,
    group: &IndexMap<String, String>,
    question: &CampaignQuestion,
    told: Vec<(&Placed<'_>, Observation)>,
) -> Option<CampaignCurve> {
    let degree = question.degree.unwrap_or(DEGREE);
    let (placed, observations): (Vec<&Placed<'_>>, Vec<Observation>) = told.into_iter().unzip();
    let curve = Curve::fit(&observations, &question.by, degree)?;
    let freedom = curve.degrees_of_freedom;
    let law = ChiSquared::new(freedom as f64).ok();
    let point = |(index, placed): (usize, &&Placed<'_>)| {
        let (value, error) = curve.at(&observations[index].conditions);
        CampaignPoint {
            job: placed.flown.job.clone(),
            name: placed.flown.name.clone(),
            conditions: (question.by.iter().cloned())
                .zip(placed.conditions.iter().copied())
                .collect(),
            estimate: observations[index].value,
            standard_error: observations[index].error,
            curve: value,
            curve_standard_error: error,
            deviation: curve.deviations[index],
            is_outlier: curve.is_outlier[index],
        }
    };
    Some(CampaignCurve {
        parameter: parameter.to_string(),
        unit: unit.to_string(),
        group: group.clone(),
        terms: curve.terms(),
        terms_left_out: curve.left_out(degree),
        chi_squared: curve.chi_squared,
        degrees_of_freedom: freedom,
        probability: law.map(|law| law.sf(curve.chi_squared)),
        scatter: curve.scatter,
        points: placed.iter().enumerate().map(point).collect(),
    })
}
