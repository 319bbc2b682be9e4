//! Which estimator answers a job.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Estimator {
    /// The model is deterministic, all noise is in the measurements.
    #[default]
    OutputError,
    /// The states are disturbed too, as by turbulence: a Kalman filter of steady gain predicts the outputs, and the
    /// intensity of the process noise is estimated along with the parameters.
    FilterError,
}
