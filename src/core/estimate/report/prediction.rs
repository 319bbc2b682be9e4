//! How well a model predicts a segment that it was not fitted to.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::fit::OutputFit;
use super::iteration::Outcome;
use super::parameter::ParameterEstimate;

/// How well the estimated model predicts one segment that it was not fitted to.
///
/// What all maneuvers share is held at the estimate. What belongs to a maneuver (`per = "maneuver"`: its initial
/// state, its biases) is no property of the aircraft, and is estimated on the segment itself unless it is fixed,
/// with the noise covariance held at its estimate.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Prediction {
    /// The segment's label.
    #[schema(example = "doublet")]
    pub segment: String,
    /// Of the estimation of the segment's own parameters; `converged` where it has none.
    pub outcome: Outcome,
    /// The outcome in a sentence.
    pub reason: String,
    /// The segment's own parameters.
    pub parameters: Vec<ParameterEstimate>,
    /// Empty where the simulation left the range of numbers.
    pub outputs: Vec<OutputFit>,
    /// Samples of the segment.
    pub samples: usize,
}
