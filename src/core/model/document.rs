//! The model document: the one representation of a model, in TOML or JSON.
//!
//! A document is what an engineer writes and reads. Nothing here knows how equations are evaluated;
//! [`super::Model`] is what a document compiles to.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::flight::{PhysicalQuantity, Unit};

/// States, inputs, outputs and parameters with their units, and equations as text:
/// dx/dt = f(x, u, θ), x(0) = x0(θ), y = g(x, u, θ).
///
/// Constants, inputs, states, definitions and parameters share one namespace; an output may be
/// called like a state. `t` is the time since the start of the segment in seconds, `pi` is π.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ModelDocument {
    /// Short name, letters, digits and `-`.
    #[schema(example = "short-period")]
    pub name: String,
    /// One line for lists.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// Where the equations come from: paper and equation number.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// What the reader should know before using it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Known numbers: mass, wing area, gravity.
    #[serde(
        default,
        deserialize_with = "super::unique::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    pub constants: IndexMap<String, Constant>,
    /// Recorded quantities that drive the model, u.
    #[serde(
        default,
        deserialize_with = "super::unique::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    pub inputs: IndexMap<String, Input>,
    /// Unknowns θ, free or fixed.
    #[serde(
        default,
        deserialize_with = "super::unique::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    pub parameters: IndexMap<String, Parameter>,
    /// Named intermediate quantities (`qbar`, `CL`), each defined by those before or after it.
    #[serde(
        default,
        deserialize_with = "super::unique::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    pub definitions: IndexMap<String, Definition>,
    /// The states x with their differential equations. A model without states is allowed.
    #[serde(
        default,
        deserialize_with = "super::unique::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    pub states: IndexMap<String, State>,
    /// The outputs y, compared with recorded channels.
    #[serde(
        default,
        deserialize_with = "super::unique::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    pub outputs: IndexMap<String, Output>,
}

/// A known number and its unit.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Constant {
    /// In `unit`.
    #[schema(example = 9.80665)]
    pub value: f64,
    /// As `kg/m^3`; absent or `-`: a pure number.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schema(example = "m/s^2")]
    pub unit: String,
    /// Which quantity it is, where its name does not say so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "wind_x")]
    pub quantity: Option<PhysicalQuantity>,
    /// What it is, in words.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
}

/// A recorded quantity that drives the model, and the path on which it comes to the equations: play, rate limit, lag,
/// delay, in this order.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// A unit of the dimension that its channel must have; absent or `-`: a pure number. Equations see SI.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schema(example = "rad")]
    pub unit: String,
    /// Half the width of the dead band behind it, in the unit of the input (SI): an expression in parameters and
    /// constants, 0 for none. What the equations see stays where it is until the recording pushes it. It starts in
    /// the middle of the band.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "de_play")]
    pub play: Option<String>,
    /// The largest rate at which the equations see it change, in the unit of the input (SI) per second: an expression
    /// in parameters and constants, 0 or more. Above the largest rate of the recording it changes nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "de_rate_limit")]
    pub rate_limit: Option<String>,
    /// Time constant of the first-order lag with which the model follows it, s: an expression in parameters and
    /// constants, 0 for none. Exact for an input that is a straight line between samples (or held, where the job
    /// says so). Negative: it leads by as much as it would lag.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "de_lag")]
    pub lag: Option<String>,
    /// By how much the model sees it later than it was recorded, s: an expression in parameters and constants.
    /// Negative: earlier. Between samples the recording is a monotone cubic, beyond its ends the value is held.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "tau_de")]
    pub delay: Option<String>,
    /// Which quantity it is, where its name does not say so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "elevator")]
    pub quantity: Option<PhysicalQuantity>,
    /// What it is, in words.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
}

/// A state x and its differential equation.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// A unit of its dimension; its equation must give this dimension per second.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schema(example = "rad")]
    pub unit: String,
    /// Value at the start of each segment: an expression in parameters and constants.
    #[schema(example = "alpha_0")]
    pub initial: String,
    /// dx/dt.
    #[schema(example = "Za*(alpha - alpha_eq) + Zq*q + Zde*(de - de_eq)")]
    pub derivative: String,
    /// Which quantity it is, where its name does not say so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "angle_of_attack")]
    pub quantity: Option<PhysicalQuantity>,
    /// What it is, in words.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
}

/// A named intermediate quantity, a function of time, states, inputs and parameters.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Definition {
    /// A unit of the dimension that its equation must give.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schema(example = "-")]
    pub unit: String,
    /// An expression in everything that has a name.
    #[schema(example = "CL0 + CLalpha*alpha")]
    pub equation: String,
    /// Which quantity it is, where its name does not say so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "lift_coefficient")]
    pub quantity: Option<PhysicalQuantity>,
    /// What it is, in words.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
}

/// An output y, which is compared with the recorded channel of its name, and the path on which it comes to the recorder:
/// lag, then delay.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// A unit of the dimension that its equation must give and its channel must have.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schema(example = "rad/s")]
    pub unit: String,
    /// An expression in everything that has a name.
    #[schema(example = "q + q_bias")]
    pub equation: String,
    /// Time constant of the first-order lag with which its sensor follows it, s: an expression in parameters and
    /// constants, 0 for none. Exact for an output that is a straight line between samples. Negative: it leads by as
    /// much as it would lag.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "T_alpha")]
    pub lag: Option<String>,
    /// By how much it is recorded later than it happens, s: an expression in parameters and constants. Negative:
    /// earlier. Between samples the output is a cubic, before the segment its first value, behind it its last.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "tau_alpha")]
    pub delay: Option<String>,
    /// Which quantity it is, where its name does not say so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "pitch_rate")]
    pub quantity: Option<PhysicalQuantity>,
    /// What it is, in words.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
}

/// One unknown. Numbers are in the parameter's own unit.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// The unit of `start`, `lower`, `upper`, `prior` and of the estimate; absent or `-`: a pure number.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schema(example = "1/s")]
    pub unit: String,
    /// Where the estimation starts from; of a fixed parameter its value.
    pub start: Start,
    /// The smallest value it may take.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower: Option<f64>,
    /// The largest value it may take.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper: Option<f64>,
    /// A fixed parameter stays at its start value.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub fixed: bool,
    /// `job`: one value for all maneuvers; `maneuver`: each segment has its own (initial states, biases, wind).
    #[serde(default, skip_serializing_if = "Per::is_job")]
    pub per: Per,
    /// Of a parameter `per = "maneuver"`: the labels of the maneuvers, or of their parts, in which it is free. In others it
    /// is zero, or the bound next to zero. Empty: all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(example = json!(["flight 2"]))]
    pub only_in: Vec<String>,
    /// What is known of it before the data, from a wind tunnel or an earlier flight: it counts in the estimate
    /// and in its error bounds. Of a parameter `per = "maneuver"` it holds for each of its values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prior: Option<Prior>,
    /// Which quantity it is, where its name does not say so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "airspeed")]
    pub quantity: Option<PhysicalQuantity>,
    /// What it is, in words.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
}

/// A normal prior, in the parameter's unit.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Prior {
    /// The value that is expected.
    #[schema(example = -0.5)]
    pub mean: f64,
    /// Standard deviation, above 0.
    #[schema(example = 0.1, exclusive_minimum = 0.0)]
    pub sd: f64,
}

impl Prior {
    /// Of the same parameter in SI.
    pub fn in_si(self, unit: &Unit) -> Self {
        Self {
            mean: unit.to_si(self.mean),
            sd: self.sd * unit.scale,
        }
    }
}

/// Where a parameter starts: a number, or an expression in recorded channels such as
/// `first(alpha)` (first sample) or `mean(de, 5)` (mean over the first 5 seconds), in SI.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub enum Start {
    /// A number, in the parameter's unit.
    Value(f64),
    /// An expression in recorded channels; each segment has its own value.
    FromData(String),
}

/// Whether a parameter has one value or many.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Per {
    /// One for all maneuvers: a property of the aircraft.
    #[default]
    Job,
    /// One for each segment: its initial state, its biases, its wind.
    Maneuver,
}

impl Per {
    fn is_job(&self) -> bool {
        *self == Self::Job
    }
}
