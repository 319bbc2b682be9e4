//! Units of a recording, and the channel that values in them become.

use crate::flight::{Channel, Dimension, Unit};

use super::{code, text::short_message};

/// The unit that stands for a pure number.
pub(super) const PURE_NUMBER: &str = "-";

/// A unit as the file writes it, and what it means.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct RecordedUnit {
    text: String,
    unit: Unit,
}

impl RecordedUnit {
    /// # Errors
    /// A code and a message.
    pub(super) fn parse(text: &str) -> Result<Self, (&'static str, String)> {
        let unit = Unit::parse(text)
            .map_err(|fault| (code::UNKNOWN_UNIT, short_message(&fault.to_string())))?;
        // A scale beyond the range of a double would turn every value into 0 or nothing.
        if !unit.scale.is_normal() {
            let message = format!("unit '{text}' is too far from SI to be converted");
            return Err((code::UNKNOWN_UNIT, message));
        }
        // `name`, `name[]`, `name[1]` and `name[-]` are the same content and must have one digest.
        let text = match text.trim() {
            "" | "1" => PURE_NUMBER,
            other => other,
        };
        Ok(Self {
            text: text.to_string(),
            unit,
        })
    }

    /// # Errors
    /// A code and a message: the unit is unknown, or is not one of time.
    pub(super) fn parse_time(text: &str) -> Result<Self, (&'static str, String)> {
        let recorded = Self::parse(text)?;
        if recorded.is_of_time() {
            return Ok(recorded);
        }
        let message = if recorded.text == PURE_NUMBER {
            "time has no unit; say which, as in t[s] or t[ms]".to_string()
        } else {
            format!(
                "'{}' is not a unit of time; those are s, ms, us, min and h",
                recorded.text
            )
        };
        Err((code::TIME_UNIT, message))
    }

    /// The unit of a column of time stamps, of which the file may say `UTC`, `hh:mm:ss` or `s`: seconds.
    ///
    /// # Errors
    /// A code and a message: it is the unit of something else.
    pub(super) fn of_stamps(text: &str) -> Result<Self, (&'static str, String)> {
        let is_other =
            Self::parse(text).is_ok_and(|unit| unit.text != PURE_NUMBER && !unit.is_of_time());
        if is_other {
            let message =
                format!("this column has time stamps and the unit '{text}'; leave the unit out");
            return Err((code::TIME_UNIT, message));
        }
        Self::parse("s")
    }

    pub(super) fn unit(&self) -> Unit {
        self.unit
    }

    pub(super) fn is_of_time(&self) -> bool {
        self.unit.dimension == Dimension::SECOND
    }

    /// The channel of values in this unit.
    pub(super) fn channel(&self, mut values: Vec<f64>) -> Channel {
        // A channel's values are finite or NaN; 1e308 km would be infinite in SI.
        for value in &mut values {
            if !self.unit.to_si(*value).is_finite() {
                *value = f64::NAN;
            }
        }
        Channel::from_recorded(&self.text, self.unit, values)
    }
}

/// Whether a channel is an angle (and not some other pure number).
pub(super) fn is_angle(channel: &Channel) -> bool {
    Unit::si_name(&channel.recorded_unit) == "rad"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_unit_of_time_is_one() {
        assert_eq!(RecordedUnit::parse_time("ms").unwrap().unit().scale, 1e-3);
        let refused = |text| RecordedUnit::parse_time(text).unwrap_err();
        assert_eq!(refused("m").0, code::TIME_UNIT);
        assert!(refused("").1.contains("t[s]"));
        assert_eq!(refused("parsec").0, code::UNKNOWN_UNIT);
    }

    #[test]
    fn values_are_finite_or_missing() {
        let channel = RecordedUnit::parse("km").unwrap().channel(vec![1e308, 1.0]);
        assert!(channel.values[0].is_nan());
        assert_eq!(channel.values[1], 1000.0);
        assert!(RecordedUnit::parse("us^9*".repeat(8).trim_end_matches('*')).is_err());
    }

    #[test]
    fn an_angle_is_told_from_a_pure_number() {
        let angle = |text| is_angle(&RecordedUnit::parse(text).unwrap().channel(vec![]));
        assert!(angle("deg") && angle("rad") && !angle("-") && !angle("%") && !angle("deg/s"));
    }
}
