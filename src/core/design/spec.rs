//! What is to be designed.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::simulate::Scenario;

/// Maneuvers to be designed for one model at one flight condition, and compared. Priors of the model are left out: the bounds
/// are those of the maneuvers alone.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct DesignSpec {
    /// The flight: model, step, duration, a priori values of the parameters (`truth`), inputs with their trim, outputs with
    /// the noise that is expected. An input that a maneuver does not move does what stands here. Effects and process noise have
    /// no place in it.
    #[schema(value_type = Object, example = json!({"model": "short-period", "seed": 1, "step": 0.04, "duration": 15.0,
        "truth": {"Za": -0.85, "Zq": 0.97, "Zde": -0.08, "Ma": -3.4, "Mq": -1.6, "Mde": -4.8, "alpha_eq": 0.06, "de_eq": -0.02, "q_bias": 0.0, "alpha_0": 0.06},
        "inputs": {"de": {"unit": "deg", "trim": -1.1459, "design": {"shape": "constant"}}},
        "outputs": {"alpha": {"unit": "deg", "noise": 0.05}, "q": {"unit": "deg/s", "noise": 0.08}}}))]
    pub scenario: Scenario,
    /// One or more.
    #[schema(min_items = 1)]
    pub maneuvers: Vec<ManeuverDesign>,
    /// By input: the largest rate of its deflection, in its unit per second. Steps become ramps, at the
    /// first sample from trim.
    #[serde(
        default,
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(example = json!({"de": 60.0}))]
    pub rate_limits: IndexMap<String, f64>,
    /// By output: the largest departure from its first value that is allowed, in its unit. Multisteps and multisines are made
    /// smaller until they keep within; what would leave it is no candidate of an optimal design.
    #[serde(
        default,
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(example = json!({"alpha": 5.0}))]
    pub response_limits: IndexMap<String, f64>,
}

/// One maneuver.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ManeuverDesign {
    /// What it is called in the answer, and its files.
    #[schema(example = "3-2-1-1")]
    pub name: String,
    /// How its inputs are made.
    pub design: DesignKind,
}

/// How the inputs of a maneuver are made. Amplitudes are the largest deflections from trim, in the unit of the input.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum DesignKind {
    /// As the scenario has them.
    Scenario {},
    /// A doublet or a 3-2-1-1 whose unit of time is scaled to a mode.
    Multistep {
        /// The input that moves.
        input: String,
        /// Which of them.
        #[serde(default)]
        shape: MultistepShape,
        /// Negative begins the other way.
        amplitude: f64,
        /// When it begins, s.
        #[serde(default)]
        start: f64,
        /// Of the mode, rad/s; absent: the fastest oscillation of the model that the input moves.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        natural_frequency: Option<f64>,
    },
    /// Sums of sines, all inputs at the same time: harmonics of one period are dealt out among them, so that they are orthogonal,
    /// with phases of low relative peak factor.
    Multisine {
        /// How far each input moves.
        amplitudes: Amplitudes,
        /// Lowest and highest frequency, Hz.
        band: [f64; 2],
        /// When they begin, s.
        #[serde(default)]
        start: f64,
        /// How long they last, s: the period; absent: to the end of the scenario.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        period: Option<f64>,
    },
    /// Steps to plus or minus the amplitude, or trim, at whole multiples of a pulse: those of least determinant of the covariance
    /// of the parameters.
    Optimal {
        /// How far each input moves.
        amplitudes: Amplitudes,
        /// The length of the shortest pulse, s.
        pulse: f64,
        /// When it may begin, s.
        #[serde(default)]
        start: f64,
        /// When inputs are back at trim, s; absent: at the end of the scenario.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        end: Option<f64>,
        /// The parameters that matter; absent: all that are free in the model and are the same for all maneuvers. The others
        /// are estimated, too, and do not count.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        parameters: Vec<String>,
        /// The budget of simulations.
        #[serde(default = "simulations")]
        #[schema(maximum = 20_000)]
        simulations: usize,
    },
}

/// By input: its largest deflection from trim, in the unit of the input.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(transparent)]
pub struct Amplitudes(
    #[serde(deserialize_with = "crate::model::unique")] pub IndexMap<String, f64>,
);

fn simulations() -> usize {
    2_000
}

/// The shape of a multistep input.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
pub enum MultistepShape {
    /// Pulses of 3, 2, 1 and 1 units of time: 1.6 over the natural frequency.
    #[default]
    #[serde(rename = "3-2-1-1")]
    ThreeTwoOneOne,
    /// One pulse each way: 2.3 over the natural frequency.
    #[serde(rename = "doublet")]
    Doublet,
}
