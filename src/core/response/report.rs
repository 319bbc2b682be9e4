//! What is answered about frequency responses.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The responses of some outputs to some inputs.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct RecordedResponses {
    /// Hz.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub frequency_hz: Vec<f64>,
    /// Lengths of the windows that were put together, s.
    #[schema(example = json!([20.0, 10.0, 5.0]))]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub windows: Vec<f64>,
    /// Lengths of windows, s, that were not: of which fewer than two more than there are inputs fit in without overlap, or of fewer
    /// than 8 samples.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(example = json!([60.0]))]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub left_out_windows: Vec<f64>,
    /// By output, then input.
    pub responses: Vec<RecordedResponse>,
}

/// One response, SI; `null` where no window is long enough.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct RecordedResponse {
    /// The input, X.
    #[schema(example = "de")]
    pub input: String,
    /// The output, Y.
    #[schema(example = "q")]
    pub output: String,
    /// |H|
    pub magnitude: Vec<Option<f64>>,
    /// 20 log₁₀ |H|
    pub magnitude_db: Vec<Option<f64>>,
    /// Of H, degrees, without jumps of a turn.
    pub phase_deg: Vec<Option<f64>>,
    /// γ²: of one input its coherence with the output, of several the partial one.
    pub coherence: Vec<Option<f64>>,
    /// Of all inputs together with the output.
    pub multiple_coherence: Vec<Option<f64>>,
    /// Standard deviation of |H|, relative to it, and of the phase in radians.
    pub random_error: Vec<Option<f64>>,
    /// As the handling qualities of an attitude response are told; absent where the band does not show it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bandwidth: Option<RecordedBandwidth>,
    /// As it was asked for; absent where the response has too few values for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transfer_function: Option<FittedTransferFunction>,
}

/// Bandwidth and phase delay, of a response whose phase passes -180° (ADS-33). Phases are counted from that of a positive gain at
/// the lowest frequency, between 45° and -135°.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct RecordedBandwidth {
    /// Whether the gain is negative: phases here are those of the response times -1.
    pub negative_gain: bool,
    /// ω_180, where the phase is -180°, rad/s.
    #[schema(example = 6.1)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub crossing: f64,
    /// Where the phase has a margin of 45° to that, rad/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = 3.9)]
    pub phase: Option<f64>,
    /// Where the magnitude is 6 dB above that at the crossing, rad/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = 4.4)]
    pub gain: Option<f64>,
    /// τ_p = -(Φ(2 ω_180) + 180°)/(57.3 · 2 ω_180), s.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = 0.08)]
    pub phase_delay: Option<f64>,
}

/// A transfer function that was fitted to a response.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct FittedTransferFunction {
    /// b_0, b_1, ..., b_m, SI.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub numerator: Vec<f64>,
    /// a_0, a_1, ..., and 1 for s^n.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub denominator: Vec<f64>,
    /// τ, s; 0 where none was asked for.
    #[schema(example = 0.07)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub delay: f64,
    /// Of the b, the a without the 1, and the delay if there is one: by the random errors of the response, larger by √χ² where the fit
    /// is worse than these say. Absent where there are no more independent numbers than unknowns.
    pub standard_errors: Vec<Option<f64>>,
    /// J = 20/n Σ W_γ (W_g (ΔdB)² + W_p (Δ°)²); up to 100 is a usable fit (Tischler and Remple, ch. 11).
    #[schema(example = 34.2)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub cost: f64,
    /// W_g
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub magnitude_weight: f64,
    /// W_p: 1 dB weighs as much as 7.57°.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub phase_weight: f64,
    /// How many frequencies it was fitted to.
    pub points: usize,
    /// How many of them are independent: closer ones than 2/T for windows of T seconds tell no more.
    #[schema(example = 14.2)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub independent_points: f64,
    /// How many steps it took.
    pub iterations: usize,
}
