//! One cell of a table of text.

use std::borrow::Cow;

/// What stands between a number's whole and its fraction.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Decimal {
    Point,
    Comma,
}

/// The text of a cell without blanks and quotes around it.
pub(super) fn unquote(cell: &str) -> &str {
    let trimmed = cell.trim();
    trimmed
        .strip_prefix('"')
        .and_then(|open| open.strip_suffix('"'))
        .map_or(trimmed, str::trim)
}

/// A cell's number, NaN where it is missing, `None` where it is neither.
pub(super) fn number(cell: &str, decimal: Decimal) -> Option<f64> {
    let text = unquote(cell);
    let pointed = match decimal {
        Decimal::Comma if text.contains(',') => Cow::Owned(text.replacen(',', ".", 1)),
        _ => Cow::Borrowed(text),
    };
    match pointed.parse::<f64>() {
        Ok(value) if value.is_finite() => Some(value),
        // "inf" and "nan" are missing values, 1e999 is a mistake
        Ok(_) if text.bytes().any(|byte| byte.is_ascii_digit()) => None,
        Ok(_) => Some(f64::NAN),
        Err(_) => is_missing(text).then_some(f64::NAN),
    }
}

/// What spreadsheets, R, databases and C runtimes write where there is no value.
const MISSING: [&str; 9] = [
    "", "na", "n/a", "#n/a", "null", "1.#inf", "-1.#inf", "-1.#ind", "1.#qnan",
];

/// Whether a cell holds a sign for "no value".
pub(super) fn is_missing(text: &str) -> bool {
    MISSING.iter().any(|word| text.eq_ignore_ascii_case(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_missing_values_and_everything_else() {
        for (text, expected) in [
            ("1.5", 1.5),
            (" -1.5e-3 ", -1.5e-3),
            ("\"+7\"", 7.0),
            (".5", 0.5),
        ] {
            assert_eq!(number(text, Decimal::Point), Some(expected), "{text}");
        }
        for text in [
            "",
            "  ",
            "\"\"",
            "nan",
            "NaN",
            "NA",
            "n/a",
            "#N/A",
            "null",
            "Inf",
            "-inf",
            "+Infinity",
            "-1.#IND",
            "1.#QNAN",
        ] {
            assert!(
                number(text, Decimal::Point).is_some_and(f64::is_nan),
                "{text}"
            );
        }
        for text in [
            "x", "1,5", "1 2", "0x10", "1e999", "--1", "nano", "\"1", "-",
        ] {
            assert_eq!(number(text, Decimal::Point), None, "{text}");
        }
    }

    #[test]
    fn a_decimal_comma_is_one_where_it_is_asked_for() {
        let comma = |text| number(text, Decimal::Comma);
        assert_eq!(comma("\"-1,5e-3\""), Some(-1.5e-3));
        assert_eq!(comma("7"), Some(7.0));
        for text in ["1,234,5", "1.234,5", "1,5 2", ","] {
            assert_eq!(comma(text), None, "{text}");
        }
        assert_eq!(number("1,5", Decimal::Point), None);
    }
}
