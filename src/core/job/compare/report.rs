//! What a comparison of jobs answers.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::estimate::{FitSummary, Mode};

/// Parameters of some jobs side by side.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Comparison {
    /// In the order in which they were asked for.
    pub jobs: Vec<ComparedJob>,
    /// Those that maneuvers share, in the order in which jobs have them.
    pub parameters: Vec<ComparedParameter>,
}

impl Comparison {
    /// Jobs that were fitted to samples of the same recording, by their numbers from 1, the lower one first.
    pub fn dependent_pairs(&self) -> Vec<(usize, usize)> {
        let number = |id: &String| self.jobs.iter().position(|job| job.job == *id);
        let pairs = self.jobs.iter().enumerate().flat_map(|(at, job)| {
            let others = job.shares_data_with.iter().filter_map(number);
            let later = others.filter(move |other| *other > at);
            later.map(move |other| (at + 1, other + 1))
        });
        pairs.collect()
    }
}

/// A job of a comparison.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ComparedJob {
    /// Its id.
    pub job: String,
    /// For people.
    pub name: String,
    /// Why the solver stopped.
    pub reason: String,
    /// How well the output is reproduced that is reproduced worst.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fit: Option<FitSummary>,
    /// Modes of the motion, fastest first.
    pub modes: Vec<Mode>,
    /// Jobs among these that were fitted to samples of the same recording: their estimates are not independent of its own.
    pub shares_data_with: Vec<String>,
}

/// A parameter as the jobs have it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ComparedParameter {
    /// The parameter's name.
    #[schema(example = "Ma")]
    pub parameter: String,
    /// Its own unit. Parameters of one name and two units are two.
    #[schema(example = "1/s^2")]
    pub unit: String,
    /// One of each job, in their order; `null` of a job without it.
    pub values: Vec<Option<ComparedValue>>,
}

/// What one job says of a parameter, beside the first job that has it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ComparedValue {
    /// As it was estimated.
    #[schema(example = -4.92)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub estimate: f64,
    /// As it was estimated.
    #[schema(example = 0.027)]
    pub standard_error: Option<f64>,
    /// What to know of it: `fixed`, `at its lower bound`; mostly nothing.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub remark: String,
    /// From the estimate of the first job that has the parameter; absent of that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub difference: Option<f64>,
    /// The difference in standard errors of the difference of independent estimates, √(σ² + σ₁²). Absent where one has none or
    /// is not converged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = -1.8)]
    pub deviation: Option<f64>,
    /// Whether the two jobs have no samples in common. Where they have, the errors of both are correlated, and `deviation` is
    /// too small or too large.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub is_independent: Option<bool>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pair_of_dependent_jobs_is_named_once() {
        let job = |id: &str, shares: &[&str]| ComparedJob {
            job: id.into(),
            name: String::new(),
            reason: String::new(),
            fit: None,
            modes: Vec::new(),
            shares_data_with: shares.iter().map(ToString::to_string).collect(),
        };
        let comparison = Comparison {
            jobs: vec![
                job("a", &["c"]),
                job("b", &[]),
                job("c", &["a", "d"]),
                job("d", &["c"]),
            ],
            parameters: Vec::new(),
        };
        assert_eq!(comparison.dependent_pairs(), [(1, 3), (3, 4)]);
    }
}
