//! What the filter-error estimator answers beside the parameters.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::parameter::Bound;

/// The process noise, and the Kalman filter that goes with it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct FilterEstimate {
    /// By state of the model. The free ones follow the free parameters in the iterations' `parameters` and in
    /// `correlation`.
    pub process_noise: Vec<ProcessNoiseEstimate>,
    /// R in the gain, rows by outputs, SI units squared: at the optimum that of the innovations.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub gain_covariance: Vec<Vec<f64>>,
    /// By segment.
    pub gains: Vec<SegmentGain>,
}

/// The intensity f of the white noise that drives one state: dx = ... dt + f dw.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ProcessNoiseEstimate {
    /// The state that it drives.
    #[schema(example = "alpha")]
    pub state: String,
    /// The state's unit per √s.
    #[schema(example = "rad/s^0.5")]
    pub unit: String,
    /// The value that the estimation started from.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub start: f64,
    /// The value at the end.
    #[schema(example = 0.0024)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub estimate: f64,
    /// Cramér-Rao bound; absent where the intensity is fixed, at a bound, or not seen by the data.
    pub standard_error: Option<f64>,
    /// Whether it was held at its start value.
    pub fixed: bool,
    /// `upper`: a sample takes away all of the state's prediction error, so that more noise cannot be told from this;
    /// `lower`: too little to be told from none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_bound: Option<Bound>,
}

/// The Kalman filter of one segment.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct SegmentGain {
    /// The segment's label.
    pub segment: String,
    /// K, rows by states, columns by outputs, SI.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub gain: Vec<Vec<f64>>,
    /// Of the prediction error, from sample to sample: eigenvalues of Φ (I - K C). Empty where they were not found.
    pub poles: Vec<Pole>,
}

/// One eigenvalue; errors fade where `magnitude` is below 1.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Pole {
    /// Real part.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub real: f64,
    /// Imaginary part.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub imaginary: f64,
    /// The absolute value.
    #[schema(example = 0.42)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub magnitude: f64,
}

impl ProcessNoiseEstimate {
    /// What a reader of the table should know about this row, in words; mostly nothing.
    pub fn remark(&self) -> &'static str {
        match (self.fixed, self.at_bound, self.standard_error) {
            (true, ..) => "fixed",
            (_, Some(Bound::Upper), _) => "at the limit of the gain",
            (_, Some(Bound::Lower), _) => "not told from none",
            (_, _, None) => "not determined by the data",
            _ => "",
        }
    }
}
