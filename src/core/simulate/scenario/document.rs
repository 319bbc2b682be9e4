//! A scenario as it is written down.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::effect::ScenarioEffect;
use super::input_design::InputDesign;
use super::noise::NoiseColour;
use crate::flight::Unit;

/// Everything that makes a simulated maneuver; the same scenario gives the same numbers.
///
/// In TOML: `model`, `seed`, `step`, `duration`, the tables `[truth]`, `[inputs.<name>]`, `[outputs]`, `[channels]` and
/// `[process_noise]`, see data/elevator.toml, and any number of `[[effects]]`, see [`ScenarioEffect`].
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// A catalog name.
    pub model: String,
    /// One line for people.
    #[serde(default)]
    pub description: String,
    /// Of the noise; another seed makes another recording of the same maneuver.
    pub seed: u64,
    /// Between samples, s.
    pub step: f64,
    /// Of the recording, s.
    pub duration: f64,
    /// Parameters, in their own units; those left out have the document's start value.
    pub truth: IndexMap<String, f64>,
    /// Every input of the model, and how it moves.
    pub inputs: IndexMap<String, ScenarioInput>,
    /// By state: the intensity of white process noise, in the state's unit per √s, as of turbulence.
    #[serde(default)]
    pub process_noise: IndexMap<String, f64>,
    /// Outputs as they are recorded.
    pub outputs: IndexMap<String, ScenarioOutput>,
    /// Channels that the model does not make but a recording has, such as the airspeed.
    #[serde(default)]
    pub channels: IndexMap<String, ScenarioChannel>,
    /// What acts and is not in the model, in this order. A channel that an effect makes an input of (the airspeed of a
    /// lever arm, an unrecorded input) is designed under `inputs`, or held at its value under `channels`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub effects: Vec<ScenarioEffect>,
}

/// How one input moves, and the unit in which it is recorded.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScenarioInput {
    /// The unit of `trim`, of the design's amplitudes, and of the recorded channel.
    pub unit: String,
    /// The deflection of the steady flight.
    #[serde(default)]
    pub trim: f64,
    /// The deflection from trim over time.
    pub design: InputDesign,
}

/// How one output is recorded.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScenarioOutput {
    /// The unit of the recorded channel and of its noise.
    pub unit: String,
    /// Standard deviation of the measurement noise.
    pub noise: f64,
    /// White, where it does not say otherwise.
    #[serde(default)]
    pub colour: NoiseColour,
}

/// A channel that is recorded beside the model: a constant with white noise.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScenarioChannel {
    /// The unit of the recorded channel, of its value and of its noise.
    pub unit: String,
    /// The constant.
    pub value: f64,
    /// Standard deviation of its noise.
    pub noise: f64,
}

/// Why a scenario cannot be flown.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum ScenarioError {
    /// A part of it contradicts the model, or itself.
    #[error("{what}: {message}")]
    Unfit {
        /// Which part of the scenario.
        what: String,
        /// What is wrong with it, and what would put it right.
        message: String,
    },
}

/// A unit of a dimension that the model asks for.
pub(super) fn unit_like(text: &str, like: Unit, what: &str) -> Result<Unit, ScenarioError> {
    let unfit = |message: String| ScenarioError::Unfit {
        what: what.to_string(),
        message,
    };
    let unit = Unit::parse(text).map_err(|error| unfit(error.to_string()))?;
    if unit.dimension != like.dimension {
        return Err(unfit(format!(
            "{} where the model has {}",
            unit.dimension, like.dimension
        )));
    }
    Ok(unit)
}
