//! Modes of the motion, in the words of flight mechanics.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::flight::{five_digits, five_digits_beside, with_error};

/// A number with the standard error that it has from the estimate.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Measure {
    /// The number, in the unit of what is measured.
    #[schema(example = 2.3851)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub value: f64,
    /// Absent where the covariance of the estimate is not known, or a linear bound would not hold: see the remark.
    #[schema(example = 0.0127)]
    pub standard_error: Option<f64>,
}

impl std::fmt::Display for Measure {
    /// For a table, by its error: `2.385 ± 0.013`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.beside(0.0))
    }
}

impl Measure {
    /// For a table, beside a number of the given size: by its error; without one, what is nothing to rounding there is 0.
    pub fn beside(&self, size: f64) -> String {
        match self.standard_error {
            Some(error) if error > 0.0 => with_error(self.value, error),
            _ => five_digits_beside(self.value, size),
        }
    }
}

/// A root of a polynomial or matrix for a table: `-0.83000 ± 1.8200i`; a part that is nothing to rounding beside the other
/// is 0.
pub(crate) fn root(real: f64, imaginary: f64) -> String {
    let size = real.hypot(imaginary);
    let real = five_digits_beside(real, size);
    if imaginary == 0.0 {
        real
    } else {
        format!("{real} ± {}i", five_digits(imaginary))
    }
}

/// A mode of the motion as the field calls it.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum ModeName {
    /// Angle of attack and pitch rate, an oscillation.
    ShortPeriod,
    /// Speed and pitch angle, an oscillation.
    Phugoid,
    /// Sideslip and yaw rate, an oscillation.
    DutchRoll,
    /// Roll rate, aperiodic.
    Roll,
    /// Bank angle, aperiodic.
    Spiral,
    /// Roll and spiral mode as one oscillation.
    RollSpiral,
    /// An elastic mode.
    Structural,
}

impl ModeName {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::ShortPeriod => "short period",
            Self::Phugoid => "phugoid",
            Self::DutchRoll => "Dutch roll",
            Self::Roll => "roll",
            Self::Spiral => "spiral",
            Self::RollSpiral => "roll-spiral oscillation",
            Self::Structural => "structural",
        }
    }
}

/// One mode of the motion: an eigenvalue that is real, or a pair.
///
/// Linear models have one set of modes; of others, each segment has its own, about its start. States that
/// nothing feeds back from (heading, altitude) are left out, and reconstruction models have no modes: their
/// motion is recorded.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Mode {
    /// The segment at whose start the model was linearised; absent where the state matrix is the same everywhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub segment: Option<String>,
    /// What it is, by the quantities of the states that take part; absent where these leave it open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<ModeName>,
    /// States that take most part in it, by participation factor, the first most.
    #[schema(example = json!(["alpha", "q"]))]
    pub states: Vec<String>,
    /// Re λ, 1/s.
    pub real: Measure,
    /// Im λ, rad/s; zero for an aperiodic mode, else the positive one of the pair.
    pub imaginary: Measure,
    /// |λ|, rad/s; of an oscillation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub natural_frequency: Option<Measure>,
    /// -Re λ/|λ|; of an oscillation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping_ratio: Option<Measure>,
    /// 2π/Im λ, s; of an oscillation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub period: Option<Measure>,
    /// 1/|λ|, s; of an aperiodic mode.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_constant: Option<Measure>,
    /// ln 2/-Re λ, s; where the mode dies away.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_to_half: Option<Measure>,
    /// ln 2/Re λ, s; where the mode grows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_to_double: Option<Measure>,
    /// What the reader should know, mostly nothing.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub remark: String,
}

impl Mode {
    /// What to call it in a table: its name, and the states that take most part.
    pub fn label(&self) -> String {
        let states = self.states.join(", ");
        let name = match self.name {
            Some(name) => format!("{} ({states})", name.words()),
            None => states,
        };
        match &self.segment {
            Some(segment) => format!("{name} [{segment}]"),
            None => name,
        }
    }

    /// The damping ratio for a table; empty of an aperiodic mode.
    pub fn damping(&self) -> String {
        let ratio = self.damping_ratio;
        ratio.map_or_else(String::new, |ratio| ratio.beside(1.0))
    }

    /// λ for a table.
    pub fn eigenvalue(&self) -> String {
        root(self.real.value, self.imaginary.value)
    }
}
