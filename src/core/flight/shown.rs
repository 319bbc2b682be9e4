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
    with_digits(value, 5)
}

/// As [`five_digits`], with so many digits, of which there is at least one.
pub fn with_digits(value: f64, digits: u8) -> String {
    let size = value.abs();
    let behind_first = i32::from(digits) - 1;
    if value == 0.0 {
        "0".to_string()
    } else if (1e-3..1e5).contains(&size) {
        let decimals = (behind_first - size.log10().floor() as i32).max(0) as usize;
        format!("{value:.decimals$}")
    } else {
        let decimals = behind_first.max(0) as usize;
        format!("{value:.decimals$e}")
    }
}

/// What rounding leaves of nothing, beside a number of size 1: sums of many samples, eigenvalues of large matrices.
const ROUNDING: f64 = 1e-10;

/// As [`five_digits`], of a number beside one of the given size: what is nothing to rounding there is 0.
pub fn five_digits_beside(value: f64, size: f64) -> String {
    if value.abs() <= ROUNDING * size.abs() {
        five_digits(0.0)
    } else {
        five_digits(value)
    }
}

/// A number with its error: as many digits as the error leaves, of which it has two itself.
pub fn with_error(value: f64, error: f64) -> String {
    value_and_error(value, error).join(" ± ")
}

/// As [`with_error`], for columns of their own.
pub fn value_and_error(value: f64, error: f64) -> [String; 2] {
    if !(error.is_finite() && error > 0.0 && value.is_finite()) {
        return [five_digits(value), five_digits(error)];
    }
    let place = second_digit(error);
    if (-6..=0).contains(&place) {
        let digits = place.unsigned_abs() as usize;
        return [format!("{value:.digits$}"), format!("{error:.digits$}")].map(without_minus);
    }
    // of zero there is no first digit
    let digits = (value.abs().log10().floor() as i32).saturating_sub(place);
    let value = match usize::try_from(digits) {
        Ok(digits) => format!("{value:.digits$e}"),
        // less than the last digit
        Err(_) => five_digits(0.0),
    };
    [value, format!("{error:.1e}")]
}

/// The place of the second digit of an error, as a power of ten, after rounding: that of 0.00996 is the third decimal.
fn second_digit(error: f64) -> i32 {
    let place = error.log10().floor() as i32 - 1;
    if (error / 10.0_f64.powi(place)).round() < 100.0 {
        place
    } else {
        place + 1
    }
}

/// An estimate with as many digits as its standard error leaves, and that; five digits where it has none.
pub fn bounded(value: f64, error: Option<f64>) -> [String; 2] {
    match error {
        Some(error) => value_and_error(value, error),
        None => [five_digits(value), String::new()],
    }
}

/// An error by itself: two digits.
pub fn two_digits(error: f64) -> String {
    let [_, error] = value_and_error(0.0, error);
    error
}

/// Zero has no sign.
fn without_minus(number: String) -> String {
    match number.strip_prefix('-') {
        Some(size) if size.bytes().all(|byte| matches!(byte, b'0' | b'.')) => size.to_string(),
        _ => number,
    }
}

/// With so many decimals; zero has no sign.
pub fn decimals(value: f64, digits: usize) -> String {
    without_minus(format!("{value:.digits$}"))
}

/// The probability that chance alone does this, as tables have it: what is too small to matter is only said to be small.
pub fn p_value(probability: f64) -> String {
    if probability < 1e-4 {
        "p < 0.0001".to_string()
    } else if probability < 0.01 {
        format!("p = {probability:.4}")
    } else {
        format!("p = {probability:.2}")
    }
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
            (0.298_41, 0.003_12, "0.2984 ± 0.0031"),
            (0.298_41, 0.009_96, "0.298 ± 0.010"),
            // nothing to rounding is 0, and 0 has no sign
            (1e-14, 0.003_12, "0.0000 ± 0.0031"),
            (-1e-14, 0.003_12, "0.0000 ± 0.0031"),
            (1e-14, 3.3e-9, "0 ± 3.3e-9"),
            (0.0, 3.3e-9, "0 ± 3.3e-9"),
            (0.0, 3.3e100, "0 ± 3.3e100"),
            (-5.1e-10, 3.3e-9, "-5e-10 ± 3.3e-9"),
            (f64::NAN, 0.1, "NaN ± 0.10000"),
        ] {
            assert_eq!(with_error(value, error), written);
        }
        assert_eq!(two_digits(0.003_12), "0.0031");
        assert_eq!(two_digits(3.3e-9), "3.3e-9");
    }

    #[test]
    fn what_is_nothing_to_rounding_is_zero() {
        assert_eq!(five_digits_beside(1e-14, 0.01), "0");
        assert_eq!(five_digits_beside(-1e-14, 0.01), "0");
        // small by itself is not nothing
        assert_eq!(five_digits_beside(1e-14, 1e-13), "1.0000e-14");
        assert_eq!(five_digits_beside(0.0, 0.0), "0");
        assert_eq!(decimals(-0.001, 2), "0.00");
        assert_eq!(decimals(-0.01, 2), "-0.01");
    }

    #[test]
    fn p_values_are_written_as_tables_have_them() {
        for (probability, written) in [
            (0.32, "p = 0.32"),
            (1.0, "p = 1.00"),
            (0.0123, "p = 0.01"),
            (0.0032, "p = 0.0032"),
            (1.3e-17, "p < 0.0001"),
            (0.0, "p < 0.0001"),
        ] {
            assert_eq!(p_value(probability), written);
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
        assert_eq!(with_digits(-4.917_632, 7), "-4.917632");
        assert_eq!(with_digits(1.234_567e-9, 6), "1.23457e-9");
    }
}
