//! How quantities are shown to people: angles in degrees, numbers with five digits.

/// What a value in SI is multiplied by, and the unit it then has.
#[derive(Clone, PartialEq, Debug)]
pub struct Shown {
    /// The factor from SI to what is shown.
    pub scale: f64,
    /// The unit of what is shown.
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

/// A number for a table: five digits, as a decimal where that is readable.
pub fn five_digits(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_string()
    } else if (1e-3..1e5).contains(&size) {
        let digits = (4 - size.log10().floor() as i32).max(0) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.4e}")
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

    #[test]
    fn numbers_have_five_digits() {
        let cases = [
            (-4.917_632, "-4.9176"),
            (0.020_015_48, "0.020015"),
            (130.0, "130.00"),
            (1.5e-9, "1.5000e-9"),
        ];
        for (value, text) in cases {
            assert_eq!(five_digits(value), text);
        }
        assert_eq!(five_digits(0.0), "0");
    }
}
