//! What a campaign is asked, and what it answers.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::mean::channel_of;
use super::recording::UsedRecording;
use crate::estimate::Estimate;

/// A job of a campaign.
pub struct Flown {
    /// Its id, or file.
    pub job: String,
    /// For people.
    pub name: String,
    /// By name: what tags of the form `alpha=5` say, and means of channels, as `mean(alpha)`.
    pub conditions: IndexMap<String, String>,
    /// What it was fitted to, as far as that is known: jobs that have data in common do not count twice.
    pub recordings: Vec<UsedRecording>,
    /// What came of it.
    pub estimate: Estimate,
}

/// What is asked of a campaign.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct CampaignQuestion {
    /// Conditions with numbers, over which parameters are curves, at most 4; none: weighted means.
    pub by: Vec<String>,
    /// Conditions with words, each of whose values has curves of its own, at most 8.
    pub group: Vec<String>,
    /// Parameters by name; empty: all that are shared and have a standard error.
    pub parameters: Vec<String>,
    /// Highest degree of the polynomials, 0 to 3; 2 where absent.
    pub degree: Option<usize>,
}

/// Conditions of a curve, at most.
const MOST_BY: usize = 4;
/// Conditions of a group, at most.
const MOST_GROUP: usize = 8;
/// The highest degree that may be asked for.
const MOST_DEGREE: usize = 3;

impl CampaignQuestion {
    /// Which field cannot be, and what is allowed.
    pub fn fault(&self) -> Option<(&'static str, String)> {
        let all = [
            ("by", &self.by, MOST_BY),
            ("group", &self.group, MOST_GROUP),
        ];
        for (field, names, most) in all {
            if names.len() > most {
                let message = format!("{} conditions; give at most {most}", names.len());
                return Some((field, message));
            }
            let twice = names.iter().enumerate();
            let twice = twice
                .filter(|(place, name)| names[..*place].contains(name))
                .map(|(_, name)| name);
            if let Some(name) = { twice }.next() {
                return Some((field, format!("'{name}' is there twice; name it once")));
            }
        }
        if let Some(name) = self.group.iter().find(|name| channel_of(name).is_some()) {
            let message = format!("'{name}': a mean is a number: name it under \"by\"");
            return Some(("group", message));
        }
        let degree = self.degree.filter(|&degree| degree > MOST_DEGREE)?;
        Some((
            "degree",
            format!("{degree} is not between 0 and {MOST_DEGREE}"),
        ))
    }
}

/// Parameters over the conditions of many jobs.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Campaign {
    /// By parameter, then group.
    pub curves: Vec<CampaignCurve>,
    /// Jobs that could not be used, and why.
    pub left_out: Vec<LeftOut>,
}

/// One parameter in one group of jobs.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct CampaignCurve {
    /// The parameter's name.
    #[schema(example = "Ma")]
    pub parameter: String,
    /// Its own unit.
    #[schema(example = "1/s^2")]
    pub unit: String,
    /// The conditions that all of these have in common, of those that were asked for.
    #[schema(example = json!({"flaps": "14"}))]
    pub group: IndexMap<String, String>,
    /// The polynomial's terms with their coefficients, in the parameter's unit and those of the conditions.
    pub terms: Vec<CampaignTerm>,
    /// Terms up to the degree that was asked for, or 2, which the jobs do not tell: a condition with n values carries powers up
    /// to n − 1, and a curve has fewer terms than jobs.
    #[schema(example = json!(["alpha^2"]))]
    pub terms_left_out: Vec<String>,
    /// Of those that are no outliers.
    #[schema(example = 31.2)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub chi_squared: f64,
    /// How many these are, less the terms.
    #[schema(example = 34)]
    pub degrees_of_freedom: usize,
    /// How often chance alone makes a χ² as large: flights differ by more than their bounds say where it is small. Absent without
    /// degrees of freedom.
    #[schema(example = 0.6)]
    pub probability: Option<f64>,
    /// √(χ²/ν), not below 1: what bounds of the curve are widened by.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub scatter: f64,
    /// One of each job.
    pub points: Vec<CampaignPoint>,
}

/// A term of a polynomial.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct CampaignTerm {
    /// Powers of the conditions: `1`, `alpha`, `alpha*mach`, `alpha^2`.
    #[schema(example = "alpha^2")]
    pub term: String,
    /// Its coefficient.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub value: f64,
    /// Widened by the scatter.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub standard_error: f64,
}

/// What one job says of a parameter.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct CampaignPoint {
    /// Its id.
    pub job: String,
    /// For people.
    pub name: String,
    /// Conditions of the curve.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub conditions: IndexMap<String, f64>,
    /// As it was estimated.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub estimate: f64,
    /// As it was estimated.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub standard_error: f64,
    /// The curve there.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub curve: f64,
    /// Widened by the scatter.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub curve_standard_error: f64,
    /// From the curve that the others make, in standard errors of the difference.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub deviation: f64,
    /// Whether it is so improbable that it does not count.
    pub is_outlier: bool,
}

/// A job that could not be used.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct LeftOut {
    /// Its id.
    pub job: String,
    /// For people.
    pub name: String,
    /// Why.
    #[schema(example = "it has no tag mach=...")]
    pub reason: String,
}
