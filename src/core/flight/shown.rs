//! How quantities are shown to people: angles in degrees, all else as it is.

/// What a value in SI is multiplied by, and the unit it then has.
#[derive(Clone, PartialEq, Debug)]
pub struct Shown {
    pub scale: f64,
    pub unit: String,
}

/// Degrees for radians, and for radians per something.
pub fn shown_in(unit: &str) -> Shown {
    if unit == "rad" || unit.starts_with("rad/") {
        Shown {
            scale: 1.0_f64.to_degrees(),
            unit: unit.replacen("rad", "deg", 1),
        }
    } else {
        Shown {
            scale: 1.0,
            unit: unit.to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_shown_in_degrees() {
        for (unit, shown) in [("rad", "deg"), ("rad/s", "deg/s"), ("rad/s^2", "deg/s^2")] {
            let Shown { scale, unit } = shown_in(unit);
            assert_eq!(
                (unit.as_str(), scale),
                (shown, 180.0 / std::f64::consts::PI)
            );
        }
        for unit in ["1/rad", "radio", "m", "-"] {
            assert_eq!(
                shown_in(unit),
                Shown {
                    scale: 1.0,
                    unit: unit.into()
                }
            );
        }
    }
}
