//! What a trim is asked for.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A number in the unit that the model gives the quantity, or a text with a unit: `"20[deg]"`.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub enum TrimValue {
    /// In the document's unit of the quantity.
    Number(f64),
    /// A number with its unit in square brackets, or arithmetic of such; a number alone is in the document's unit.
    Text(String),
}

/// Conditions of a steady flight.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct TrimSpec {
    /// States, inputs, definitions or outputs, and the values that they have in steady flight.
    #[serde(
        default,
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(example = json!({"V": "60[m/s]", "beta": 0}))]
    pub hold: IndexMap<String, TrimValue>,
    /// By state: its rate in steady flight, per second; all others are zero. A steady turn has a rate of the heading, a climb
    /// one of the altitude.
    #[serde(
        default,
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(example = json!({"psi": "3[deg/s]"}))]
    pub rates: IndexMap<String, TrimValue>,
    /// States whose rates may be anything.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(example = json!(["h"]))]
    pub free_rates: Vec<String>,
    /// States and inputs: where the search begins. Absent: the initial state of the model, inputs at zero.
    #[serde(
        default,
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(example = json!({"u": 60}))]
    pub start: IndexMap<String, TrimValue>,
    /// States and inputs: the smallest and the largest value that they may take. A value that is held must be within them.
    #[serde(
        default,
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(value_type = std::collections::HashMap<String, Vec<TrimValue>>, example = json!({"de": ["-25[deg]", "15[deg]"]}))]
    pub limits: IndexMap<String, [TrimValue; 2]>,
}
