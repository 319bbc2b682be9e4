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
    #[serde(default)]
    pub description: String,
    pub seed: u64,
    /// Between samples, s.
    pub step: f64,
    /// Of the recording, s.
    pub duration: f64,
    /// Parameters, in their own units; those left out have the document's start value.
    pub truth: IndexMap<String, f64>,
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

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScenarioInput {
    pub unit: String,
    /// The deflection of the steady flight.
    #[serde(default)]
    pub trim: f64,
    pub design: InputDesign,
}

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScenarioOutput {
    pub unit: String,
    /// Standard deviation of the measurement noise.
    pub noise: f64,
    /// White, where it does not say otherwise.
    #[serde(default)]
    pub colour: NoiseColour,
}

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScenarioChannel {
    pub unit: String,
    pub value: f64,
    pub noise: f64,
}

#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum ScenarioError {
    #[error("{what}: {message}")]
    Unfit { what: String, message: String },
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
