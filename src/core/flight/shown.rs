//! How quantities are shown to people: angles in degrees, numbers with five digits, or with those that an error leaves.

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

/// A number with its error: as many digits as the error leaves, of which it has two itself.
pub fn with_error(value: f64, error: f64) -> String {
    if !(error.is_finite() && error > 0.0 && value.is_finite()) {
        return format!("{} ± {}", five_digits(value), five_digits(error));
    }
    // the place of the second digit of the error
    let place = error.log10().floor() as i32 - 1;
    if (-6..=0).contains(&place) {
        let digits = place.unsigned_abs() as usize;
        return format!("{value:.digits$} ± {error:.digits$}");
    }
    let first = (value.abs().max(error)).log10().floor() as i32;
    let digits = (first - place).max(1) as usize;
    format!("{value:.digits$e} ± {error:.1e}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_has_the_digits_that_its_error_leaves() {
        for (value, error, written) in [
            (0.298_17, 0.003_140_8, "0.2982 ± 0.0031"),
            (-12.345, 1.7, "-12.3 ± 1.7"),
            (1234.5, 67.0, "1234 ± 67"),
            (12345.0, 670.0, "1.234e4 ± 6.7e2"),
            (2.5545e-7, 3.3e-9, "2.554e-7 ± 3.3e-9"),
            (1.0, 0.0, "1.0000 ± 0"),
        ] {
            assert_eq!(with_error(value, error), written);
        }
    }

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
