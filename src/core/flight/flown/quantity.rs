//! A number with its unit.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::super::{Dimension, Unit};

/// A number with its unit.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Quantity {
    /// In `unit`.
    #[schema(example = 17600.0)]
    pub value: f64,
    /// `-` for a pure number.
    #[schema(example = "kg")]
    pub unit: String,
}

const LONGEST_UNIT: usize = 64;

impl Quantity {
    /// A number with its unit behind it: `17600 kg`, `17600[kg]`.
    ///
    /// # Errors
    /// It is none.
    pub fn parse(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let end = text.find(['[', ' ']).unwrap_or(text.len());
        let (number, unit) = text.split_at(end);
        let unit = unit.trim();
        let unit = match unit.strip_prefix('[') {
            Some(unit) => unit.strip_suffix(']').unwrap_or(""),
            None => unit,
        };
        let value = number.parse::<f64>().ok().filter(|value| value.is_finite());
        match value {
            Some(value) if Unit::parse(unit).is_ok() && !unit.is_empty() => Ok(Self {
                value,
                unit: unit.to_string(),
            }),
            _ => Err(format!(
                "'{}' is no number with a unit, such as 17600[kg]",
                short(text)
            )),
        }
    }

    /// In SI, and what it measures; `None` where the unit is none.
    pub fn in_si(&self) -> Option<(f64, Dimension)> {
        let unit = Unit::parse(&self.unit).ok()?;
        Some((unit.to_si(self.value), unit.dimension))
    }

    /// # Errors
    /// Its unit is none, or not one of what its name says; or its size is none.
    pub(super) fn check(&self, name: &str) -> Result<(), String> {
        if self.unit.chars().count() > LONGEST_UNIT {
            return Err(format!("a unit has at most {LONGEST_UNIT} characters"));
        }
        let unit = Unit::parse(&self.unit).map_err(|error| error.to_string())?;
        let of_inertia = Dimension::KILOGRAM
            .times(Dimension::METRE)
            .times(Dimension::METRE);
        let (expected, is_right) = match name.split_once('.').map_or(name, |(group, _)| group) {
            "mass" => ("kg", unit.dimension == Dimension::KILOGRAM),
            "inertia" => ("kg*m^2", unit.dimension == of_inertia),
            "centre_of_gravity" => (
                "m, or % of the chord",
                unit.dimension == Dimension::METRE || unit.dimension.is_none(),
            ),
            _ => ("", true),
        };
        if !is_right {
            return Err(format!(
                "this is in {expected}, or another unit of the kind, and not in '{}'",
                short(&self.unit)
            ));
        }
        let is_above_zero =
            name == "mass" || (name.starts_with("inertia.") && name != "inertia.Ixz");
        match self.value.is_finite() && (self.value > 0.0 || !is_above_zero) {
            true => Ok(()),
            false => Err(format!("{} is not above 0", self.value)),
        }
    }
}

/// The beginning of a stranger's text.
pub(super) fn short(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(40).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_are_written_as_in_formulas() {
        let quantity = |text| Quantity::parse(text).map(|quantity| (quantity.value, quantity.unit));
        assert_eq!(quantity("17600[kg]"), Ok((17600.0, "kg".to_string())));
        assert_eq!(
            quantity(" -1.5e3 kg*m^2 "),
            Ok((-1500.0, "kg*m^2".to_string()))
        );
        for text in ["17600", "[kg]", "1[", "1 warp", "inf kg", ""] {
            assert!(quantity(text).is_err(), "{text}");
        }
    }
}
