//! Choices about the process noise of a state.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The intensity f of the white noise that drives one state: dx = ... dt + f dw, in the state's unit per √s.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ProcessNoise {
    /// Start value; absent: from the scatter of the measurements.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = 0.02, minimum = 0.0)]
    pub start: Option<f64>,
    /// Held at its start value; with 0 the state is not disturbed.
    pub fixed: bool,
}
