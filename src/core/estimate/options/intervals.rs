//! Which confidence intervals are wanted beside those of the error bounds.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// 95 % confidence intervals that do not rest on the information matrix alone: each method that is named here refits the
/// model many times. For the estimator `output_error`.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct IntervalOptions {
    /// Replicates of the moving-block bootstrap of the residuals: from 100 to 10000; 0 for none.
    #[schema(example = 1000, maximum = 10000)]
    pub bootstrap: usize,
    /// Length of the blocks, samples; absent: from the correlation of the residuals.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = 25, minimum = 1)]
    pub block: Option<usize>,
    /// Whether the likelihood is profiled.
    #[schema(example = true)]
    pub profile: bool,
    /// Names of the parameters whose likelihood is profiled; none: all that are free.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schema(example = json!(["Ma", "Mq"]))]
    pub parameters: Vec<String>,
    /// Recordings that are simulated with the estimate and fitted: from 100 to 10000; 0 for none.
    #[schema(example = 1000, maximum = 10000)]
    pub monte_carlo: usize,
    /// The same seed gives the same numbers.
    #[schema(example = 1)]
    pub seed: u64,
}

impl Default for IntervalOptions {
    fn default() -> Self {
        Self {
            bootstrap: 1000,
            block: None,
            profile: true,
            parameters: Vec::new(),
            monte_carlo: 1000,
            seed: 0,
        }
    }
}

/// Fewer tell no 2.5 percentile, more are of no use.
const COUNTS: std::ops::RangeInclusive<usize> = 100..=10_000;

impl IntervalOptions {
    /// What cannot be, if anything: the field and why.
    pub(crate) fn fault(&self) -> Option<(&'static str, String)> {
        let count = |count: usize| count == 0 || COUNTS.contains(&count);
        let of_count = || "must be from 100 to 10000, or 0 for none".to_string();
        if !count(self.bootstrap) {
            return Some(("bootstrap", of_count()));
        }
        if !count(self.monte_carlo) {
            return Some(("monte_carlo", of_count()));
        }
        if self.block == Some(0) {
            return Some(("block", "must be at least 1 sample".to_string()));
        }
        if !self.profile && !self.parameters.is_empty() {
            let message = "these are parameters whose likelihood is profiled; say \"profile\": true, or leave them out";
            return Some(("parameters", message.to_string()));
        }
        if self.bootstrap == 0 && self.block.is_some() {
            let message = "only the bootstrap has blocks; ask for one, or leave this out";
            return Some(("block", message.to_string()));
        }
        if self.bootstrap == 0 && self.monte_carlo == 0 && !self.profile {
            let message =
                "no method is asked for; choose one, or leave \"confidence_intervals\" out";
            return Some(("profile", message.to_string()));
        }
        None
    }
}
