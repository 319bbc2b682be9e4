//! Measured and modelled time histories.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

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
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
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
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
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
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub measured: Vec<f64>,
    /// y at the estimate; of a filter-error estimate, predicted from the sample before.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub model: Vec<f64>,
    /// Of a diagnosis: the declared model, without the effects that were found; empty otherwise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub declared: Vec<f64>,
    /// measured - model; null where nothing was measured.
    #[schema(value_type = Vec<Option<f64>>)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub residual: Vec<f64>,
}
#[cfg(test)]
mod tests {
    use crate::estimate::report::fit::{OutputFit, TheilShares};
    use crate::estimate::report::history::OutputSeries;

    #[test]
    fn a_number_out_of_range_is_read_back() {
        let fit = OutputFit {
            name: "a".into(),
            unit: "-".into(),
            rms: 0.0,
            bias: 0.0,
            r_squared: f64::NAN,
            theil: 0.5,
            theil_shares: TheilShares::default(),
            autocorrelation: 0.0,
            effective_samples: 1.0,
            samples: 3,
        };
        let read: OutputFit = serde_json::from_str(&serde_json::to_string(&fit).unwrap()).unwrap();
        assert!(read.r_squared.is_nan() && read.theil == 0.5);
        let series = OutputSeries {
            name: "a".into(),
            unit: "-".into(),
            measured: vec![1.0, f64::NAN],
            model: vec![0.5, 0.5],
            declared: Vec::new(),
            residual: vec![0.5, f64::NAN],
        };
        let text = serde_json::to_string(&series).unwrap();
        assert!(text.contains("[1.0,null]"), "{text}");
        let read: OutputSeries = serde_json::from_str(&text).unwrap();
        assert!(read.measured[0] == 1.0 && read.measured[1].is_nan());
    }
}
