//! Where on the axis of frequencies a model is compared with the data.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// What the frequency-domain estimators look at: a band of frequencies, and what is done about the ends and drifts of a
/// record.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct FrequencyOptions {
    /// The lowest and the highest frequency, Hz. Zero is not in it: what is constant is left out, and with it biases, trim
    /// values and initial states.
    #[schema(example = json!([0.1, 1.5]))]
    pub band_hz: [f64; 2],
    /// From one frequency to the next, Hz, counted from the lower edge of the band. Absent: the multiples of 1/T of each
    /// segment of T seconds. Finer steps tell no more: each frequency then counts by its share of 1/T.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = 0.04, exclusive_minimum = 0.0)]
    pub step_hz: Option<f64>,
    /// What the states are at both ends of a segment.
    #[serde(default)]
    pub ends: Ends,
    /// What is left out of each output besides its mean.
    #[serde(default)]
    pub trend: Trend,
}

/// What the states of a segment are at its ends: a transform over a finite time depends on their difference.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Ends {
    /// Unknown: estimated for each segment along with the parameters, whose error bounds take account of it.
    #[default]
    Estimated,
    /// The maneuver ends in the steady state in which it begins, so that nothing is to be estimated of them.
    AtRest,
}

/// What a recorded output may have that the model does not: its mean always, and a straight line over each segment.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Trend {
    /// A straight line, estimated for each segment and output along with the parameters: a drift of a sensor, or what an
    /// offset sums up to.
    #[default]
    Linear,
    /// The mean alone.
    Constant,
}

impl FrequencyOptions {
    /// A band from one frequency to another, Hz, with all else at its default.
    pub fn of_band(band_hz: [f64; 2]) -> Self {
        Self {
            band_hz,
            step_hz: None,
            ends: Ends::default(),
            trend: Trend::default(),
        }
    }

    /// Which field is out of range, and what is allowed.
    pub fn fault(&self) -> Option<(&'static str, String)> {
        let [from, to] = self.band_hz;
        let is_band = from > 0.0 && to > from && to.is_finite();
        if !is_band {
            let message =
                "band_hz must be a lowest frequency above 0 and a highest above that, in Hz";
            return Some(("band_hz", message.to_string()));
        }
        let step = self.step_hz?;
        if step > 0.0 && step <= to - from {
            return None;
        }
        let message = "step_hz must be above 0 and at most the width of the band, in Hz";
        Some(("step_hz", message.to_string()))
    }
}
