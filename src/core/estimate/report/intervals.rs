//! Confidence intervals of an estimate by several methods, side by side.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::estimate::options::error_bounds::ErrorBoundsKind;

/// 95 % confidence intervals of each free parameter, by each method that was asked for and by the error bounds.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ConfidenceIntervals {
    /// Free parameters, in the order of the iterations' `parameters`.
    pub parameters: Vec<ParameterIntervals>,
    /// What the bootstrap was made of.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bootstrap: Option<Bootstrap>,
    /// What the simulated recordings were made of.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub monte_carlo: Option<MonteCarloFits>,
    /// What a reader of the intervals should know.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub remarks: Vec<String>,
}

/// A moving-block bootstrap of the residuals.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Bootstrap {
    /// Replicates that were fitted.
    #[schema(example = 1000)]
    pub replicates: usize,
    /// Of these, those whose fit found no minimum; they do not count.
    pub failed: usize,
    /// Length of a block, samples; in short segments a quarter of their samples where that is less.
    #[schema(example = 25)]
    pub block: usize,
}

/// Recordings that were simulated with the estimate and fitted.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
pub struct MonteCarloFits {
    /// Recordings that were fitted.
    #[schema(example = 1000)]
    pub recordings: usize,
    /// Of these, those whose fit found no minimum; they do not count.
    pub failed: usize,
    /// Their noise: white with `conventional`, with the colour of the residuals with `corrected`.
    pub noise: ErrorBoundsKind,
}

/// The intervals of one parameter.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ParameterIntervals {
    /// Of the parameter.
    #[schema(example = "Ma")]
    pub name: String,
    /// The segment whose own it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub segment: Option<String>,
    /// Of all numbers here.
    #[schema(example = "1/s^2")]
    pub unit: String,
    /// The estimate.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub estimate: f64,
    /// One of each method that gives one.
    pub intervals: Vec<ConfidenceInterval>,
}

/// One interval.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ConfidenceInterval {
    /// How it was found.
    pub method: IntervalMethod,
    /// The lower end; absent where none was found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = -3.52)]
    pub lower: Option<f64>,
    /// What the lower end is.
    pub lower_end: IntervalEnd,
    /// The upper end; absent where none was found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = -3.31)]
    pub upper: Option<f64>,
    /// What the upper end is.
    pub upper_end: IntervalEnd,
    /// The standard error, or the standard deviation of the refitted estimates; a profile has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_deviation: Option<f64>,
    /// From the estimate to the upper end, over that from the lower end to the estimate; 1 is symmetric.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = 1.04)]
    pub asymmetry: Option<f64>,
}

/// How a confidence interval was found.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum IntervalMethod {
    /// 1.96 conventional standard errors to each side, √diag F⁻¹: noise that is white.
    Conventional,
    /// 1.96 corrected standard errors to each side: noise with the colour of the residuals.
    Corrected,
    /// The 2.5 and the 97.5 percentile of estimates from residuals that were resampled in blocks.
    Bootstrap,
    /// Where 2 (ln L_max − ln L_profile) is 3.84: noise that is white.
    Profile,
    /// Where 2 (ln L_max − ln L_profile) is 3.84 times the squared ratio of corrected to conventional standard error.
    ProfileCorrected,
    /// The 2.5 and the 97.5 percentile of estimates from simulated recordings.
    MonteCarlo,
}

impl IntervalMethod {
    /// As it is written in an answer.
    pub fn name(self) -> &'static str {
        match self {
            Self::Conventional => "conventional",
            Self::Corrected => "corrected",
            Self::Bootstrap => "bootstrap",
            Self::Profile => "profile",
            Self::ProfileCorrected => "profile_corrected",
            Self::MonteCarlo => "monte_carlo",
        }
    }

    /// For people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Conventional => "conventional bound",
            Self::Corrected => "corrected bound",
            Self::Bootstrap => "block bootstrap",
            Self::Profile => "profile likelihood",
            Self::ProfileCorrected => "profile, corrected",
            Self::MonteCarlo => "Monte Carlo",
        }
    }
}

/// What an end of an interval is.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum IntervalEnd {
    /// It was found.
    Found,
    /// The parameter's own bound: the data would allow more.
    Bound,
    /// None was found: the data say nothing on this side, or refits fail there.
    Open,
}

impl ConfidenceInterval {
    /// What a reader should know about its ends, in words; mostly nothing.
    pub fn remark(&self) -> &'static str {
        use IntervalEnd::{Bound, Found, Open};
        match (self.lower_end, self.upper_end) {
            (Found, Found) => "",
            (Bound, Found) => "ends at the lower bound",
            (Found, Bound) => "ends at the upper bound",
            (Bound, Bound) => "ends at both bounds",
            (Open, Found | Bound) => "no lower end found",
            (Found | Bound, Open) => "no upper end found",
            (Open, Open) => "no ends found",
        }
    }
}

impl ParameterIntervals {
    /// The parameter, and whose it is if not the whole job's.
    pub fn label(&self) -> String {
        match &self.segment {
            Some(segment) => format!("{} [{segment}]", self.name),
            None => self.name.clone(),
        }
    }
}

impl ConfidenceIntervals {
    /// What the refits were, for people.
    pub fn made_of(&self) -> Option<String> {
        let bootstrap = self.bootstrap.map(|made| {
            let drawn = match made.block {
                1 => "single residuals".to_string(),
                block => format!("blocks of {block} samples"),
            };
            format!("bootstrap: {} replicates, {drawn}", made.replicates)
        });
        let monte_carlo = self.monte_carlo.map(|made| {
            format!(
                "Monte Carlo: {} recordings, noise as the {} bounds have it",
                made.recordings,
                made.noise.name()
            )
        });
        let all: Vec<String> = bootstrap.into_iter().chain(monte_carlo).collect();
        (!all.is_empty()).then(|| all.join("; "))
    }
}
