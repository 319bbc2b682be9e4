//! What the frequency-domain estimators answer beside the parameters.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// What was compared in the frequency domain.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct FrequencyEstimate {
    /// By segment.
    pub segments: Vec<SegmentBand>,
    /// How well the transform of each output is reproduced: of an equation, that of the derivative.
    pub outputs: Vec<FrequencyFit>,
    /// Quantities of ends and trends that were estimated for all segments, beside the parameters.
    #[schema(example = 4)]
    pub ends_and_trends: usize,
    /// Whether the model is linear. Of another one, small motions about the start of each segment are compared.
    pub linear: bool,
}

/// The frequencies of one segment.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct SegmentBand {
    /// The segment's label.
    pub segment: String,
    /// The lowest frequency, Hz.
    #[schema(example = 0.12)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub first_hz: f64,
    /// From one frequency to the next, Hz.
    #[schema(example = 0.04)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub step_hz: f64,
    /// How many there are.
    #[schema(example = 35)]
    pub frequencies: usize,
    /// How many of them are independent: each tells two numbers of an output.
    #[schema(example = 35)]
    pub independent: usize,
}

/// How well one transform is reproduced over the band, in all segments.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct FrequencyFit {
    /// The output's name.
    #[schema(example = "q")]
    pub name: String,
    /// 1 - Σ|e|²/Σ|z|².
    #[schema(example = 0.998)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub r_squared: f64,
    /// Standard deviation of white noise that would leave residuals of this size, in the output's SI unit.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub noise: f64,
}
