//! How well an output is reproduced.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// How well one output is reproduced, over all segments.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct OutputFit {
    /// The output's name.
    #[schema(example = "alpha")]
    pub name: String,
    /// SI unit of `rms` and `bias`.
    #[schema(example = "rad")]
    pub unit: String,
    /// Root mean square of the residual.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub rms: f64,
    /// Mean of the residual.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub bias: f64,
    /// Coefficient of determination R².
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub r_squared: f64,
    /// Theil's inequality coefficient: 0 perfect, 1 useless.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub theil: f64,
    /// What the mean squared residual is made of.
    #[serde(default)]
    pub theil_shares: TheilShares,
    /// Autocorrelation of the residual at lag 1: near 0 where it is white.
    #[serde(default)]
    #[schema(example = 0.31)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub autocorrelation: f64,
    /// How many independent values would tell as much of a mean as the residual's samples do.
    #[serde(default)]
    #[schema(example = 310.5)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub effective_samples: f64,
    /// Samples that have a measured value; the others do not count.
    #[serde(default)]
    #[schema(example = 626)]
    pub samples: usize,
}

/// A fit in a line: how well the output is reproduced that is reproduced worst.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct FitSummary {
    /// The output with the lowest R².
    #[schema(example = "alpha")]
    pub output: String,
    /// Its coefficient of determination; `null` where it does not vary.
    #[schema(example = 0.9931)]
    pub r_squared: Option<f64>,
    /// Its inequality coefficient by Theil.
    #[schema(example = 0.0412)]
    pub theil: Option<f64>,
    /// Samples that were fitted, over all segments.
    #[schema(example = 626)]
    pub samples: usize,
}

impl FitSummary {
    /// Of the outputs of a fit over so many samples; nothing without outputs.
    pub(super) fn of(outputs: &[OutputFit], samples: usize) -> Option<Self> {
        let varying = outputs.iter().filter(|output| output.r_squared.is_finite());
        let worst = varying.min_by(|a, b| a.r_squared.total_cmp(&b.r_squared));
        let worst = worst.or(outputs.first())?;
        let finite = |value: f64| value.is_finite().then_some(value);
        Some(Self {
            output: worst.name.clone(),
            r_squared: finite(worst.r_squared),
            theil: finite(worst.theil),
            samples,
        })
    }
}

/// Theil's decomposition of the mean squared residual, shares that add up to 1 (all 0 where there is no residual).
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
pub struct TheilShares {
    /// From different means.
    #[schema(example = 0.01)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub bias: f64,
    /// From different variances: motion that the model has too much or too little of.
    #[schema(example = 0.04)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub variance: f64,
    /// From imperfect correlation; near 1 where only noise is left.
    #[schema(example = 0.95)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub covariance: f64,
}
