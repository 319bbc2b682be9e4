//! Measured and modelled time histories.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::number::nulls_as_nan;
use crate::estimate::options::role::Role;

/// Measured and modelled time histories of one segment, SI.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct TimeHistory {
    /// The segment's label.
    pub segment: String,
    /// Whether the model was fitted to it.
    #[serde(default)]
    pub role: Role,
    /// Seconds of the recording.
    pub time: Vec<f64>,
    /// The inputs u, delays not applied.
    pub inputs: Vec<Series>,
    /// The outputs: measured, modelled, and what is left.
    pub outputs: Vec<OutputSeries>,
}

/// One quantity, sample by sample.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Series {
    /// Of the input, or of the output whose residual it is.
    pub name: String,
    /// The SI unit of the values.
    pub unit: String,
    /// null where there is no value.
    #[schema(value_type = Vec<Option<f64>>)]
    #[serde(deserialize_with = "nulls_as_nan")]
    pub values: Vec<f64>,
}

/// One output, sample by sample.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct OutputSeries {
    /// The output's name.
    pub name: String,
    /// The SI unit of the values.
    pub unit: String,
    /// null where the output has no value.
    #[schema(value_type = Vec<Option<f64>>)]
    #[serde(deserialize_with = "nulls_as_nan")]
    pub measured: Vec<f64>,
    /// y at the estimate; of a filter-error estimate, predicted from the sample before.
    pub model: Vec<f64>,
    /// Of a diagnosis: the declared model, without the effects that were found; empty otherwise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub declared: Vec<f64>,
    /// measured - model; null where nothing was measured.
    #[schema(value_type = Vec<Option<f64>>)]
    #[serde(deserialize_with = "nulls_as_nan")]
    pub residual: Vec<f64>,
}
