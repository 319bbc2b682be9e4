//! What a user may ask of frequency responses.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Which responses, over which band.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ResponseOptions {
    /// Channels that drive the motion; where there are several, each response is conditioned on the others.
    #[schema(example = json!(["de"]))]
    pub inputs: Vec<String>,
    /// Channels that answer.
    #[schema(example = json!(["q"]))]
    pub outputs: Vec<String>,
    /// The lowest and the highest frequency, Hz.
    #[schema(example = json!([0.1, 2.0]))]
    pub band_hz: [f64; 2],
    /// How many frequencies, evenly spaced.
    #[serde(default = "default_points")]
    #[schema(example = 100, minimum = 2, maximum = 5000)]
    pub points: usize,
    /// Lengths of windows, s. Empty: five, from a fifth of the longest stretch without a gap (less with
    /// several inputs) down to a fifth of that.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(example = json!([20.0, 10.0, 5.0]))]
    pub windows: Vec<f64>,
    /// A transfer function that is fitted to each response.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transfer_function: Option<TransferFunctionOrder>,
}

/// The form of a transfer function: (b_m s^m + ... + b_0)/(s^n + a_(n-1) s^(n-1) + ... + a_0) e^(-τs).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct TransferFunctionOrder {
    /// m, not above n.
    #[schema(example = 1)]
    pub numerator: usize,
    /// n.
    #[schema(example = 2)]
    pub denominator: usize,
    /// Whether there is a delay τ.
    #[serde(default)]
    pub delay: bool,
}

fn default_points() -> usize {
    100
}

const MOST_CHANNELS: usize = 16;
const MOST_POINTS: usize = 5_000;
const MOST_WINDOWS: usize = 10;
const MOST_ORDER: usize = 8;

impl ResponseOptions {
    /// Which field is out of range, and what is allowed.
    pub fn fault(&self) -> Option<(&'static str, String)> {
        for (field, names) in [("inputs", &self.inputs), ("outputs", &self.outputs)] {
            if !(1..=MOST_CHANNELS).contains(&names.len()) {
                return Some((field, format!("name from 1 to {MOST_CHANNELS} channels")));
            }
        }
        let [from, to] = self.band_hz;
        if !(from > 0.0 && to > from && to.is_finite()) {
            let message =
                "band_hz must be a lowest frequency above 0 and a highest above that, in Hz";
            return Some(("band_hz", message.to_string()));
        }
        if !(2..=MOST_POINTS).contains(&self.points) {
            return Some(("points", format!("points must be from 2 to {MOST_POINTS}")));
        }
        let are_lengths = self.windows.iter().all(|w| *w > 0.0 && w.is_finite());
        if self.windows.len() > MOST_WINDOWS || !are_lengths {
            let message =
                format!("give at most {MOST_WINDOWS} lengths of windows, in seconds, above 0");
            return Some(("windows", message));
        }
        let order = self.transfer_function?;
        let is_order = order.denominator >= 1
            && order.denominator <= MOST_ORDER
            && order.numerator <= order.denominator;
        (!is_order).then(|| {
            let message = format!("a transfer function has a denominator of order 1 to {MOST_ORDER}, and a numerator of no higher one");
            ("transfer_function", message)
        })
    }
}
