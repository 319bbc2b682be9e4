//! What a job says of a constant.

use std::fmt;

use serde::de::{self, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use utoipa::ToSchema;

/// A number in the constant's own unit; or where it stands in what is said of a recording: `recording.mass`,
/// `recording.centre_of_gravity.x`, `recording.inertia.Iy`, `recording.quantities.fuel`.
#[derive(Clone, PartialEq, Debug, Serialize, ToSchema)]
#[serde(untagged)]
pub enum ConstantValue {
    /// In the constant's own unit.
    Number(f64),
    /// The name of a quantity behind `recording.`.
    Recording(String),
}

impl<'de> Deserialize<'de> for ConstantValue {
    /// By hand: serde's own way with untagged enums would not say what was expected.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberOrName;

        impl Visitor<'_> for NumberOrName {
            type Value = ConstantValue;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(
                    f,
                    "a number, or a quantity of the recording such as \"recording.mass\""
                )
            }

            fn visit_f64<E: de::Error>(self, number: f64) -> Result<ConstantValue, E> {
                Ok(ConstantValue::Number(number))
            }

            fn visit_i64<E: de::Error>(self, number: i64) -> Result<ConstantValue, E> {
                Ok(ConstantValue::Number(number as f64))
            }

            fn visit_u64<E: de::Error>(self, number: u64) -> Result<ConstantValue, E> {
                Ok(ConstantValue::Number(number as f64))
            }

            fn visit_str<E: de::Error>(self, name: &str) -> Result<ConstantValue, E> {
                Ok(ConstantValue::Recording(name.to_string()))
            }
        }

        deserializer.deserialize_any(NumberOrName)
    }
}

const PREFIX: &str = "recording.";

impl ConstantValue {
    /// `None`: it stands elsewhere.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Recording(_) => None,
        }
    }

    /// Which quantity of a recording it is: `mass`.
    ///
    /// # Errors
    /// It is none of a recording: the text.
    pub fn of_recording(&self) -> Option<Result<&str, &str>> {
        match self {
            Self::Number(_) => None,
            Self::Recording(text) => Some(text.strip_prefix(PREFIX).ok_or(text)),
        }
    }
}

impl From<f64> for ConstantValue {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl fmt::Display for ConstantValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(f),
            Self::Recording(text) => text.fmt(f),
        }
    }
}
