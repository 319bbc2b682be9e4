//! One cell of a table of text.

use std::borrow::Cow;

/// What stands between a number's whole and its fraction.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Decimal {
    Point,
    Comma,
}

/// How numbers are written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Marks {
    pub(super) decimal: Decimal,
    /// The other of point and comma stands between thousands.
    pub(super) has_thousands: bool,
}

impl Marks {
    pub(super) const POINT: Self = Self {
        decimal: Decimal::Point,
        has_thousands: false,
    };

    fn between_thousands(self) -> Option<char> {
        self.has_thousands.then_some(match self.decimal {
            Decimal::Point => ',',
            Decimal::Comma => '.',
        })
    }
}

/// The text of a cell without blanks and quotes around it.
pub(super) fn unquote(cell: &str) -> &str {
    let trimmed = cell.trim();
    let quoted = |quote: char| trimmed.strip_prefix(quote)?.strip_suffix(quote);
    quoted('"')
        .or_else(|| quoted('\''))
        .map_or(trimmed, str::trim)
}

/// A cell's number, NaN where it is missing, `None` where it is neither.
pub(super) fn number(cell: &str, marks: Marks) -> Option<f64> {
    let text = unquote(cell);
    let may_have_thousands = marks
        .between_thousands()
        .is_some_and(|mark| text.contains(mark));
    if !may_have_thousands && let Ok(value) = text.parse::<f64>() {
        return finite_or_missing(value, text);
    }
    if is_missing(text) {
        return Some(f64::NAN);
    }
    let plain = plain(text, marks)?;
    finite_or_missing(plain.parse().ok()?, &plain)
}

fn finite_or_missing(value: f64, text: &str) -> Option<f64> {
    if value.is_finite() {
        Some(value)
    } else if text.bytes().any(|byte| byte.is_ascii_digit()) {
        // "inf" and "nan" are missing values, 1e999 is a mistake
        None
    } else {
        Some(f64::NAN)
    }
}

/// A number as this program writes it: no marks between thousands, a decimal point, an exponent behind `e`.
fn plain(text: &str, marks: Marks) -> Option<String> {
    if text.len() > 64 || !text.bytes().any(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let text = text.replace('\u{2212}', "-");
    let mut text = Cow::Borrowed(text.as_str());
    let marks_of_thousands = marks
        .between_thousands()
        .into_iter()
        .chain(['\'', ' ', '\u{a0}', '\u{202f}', '\u{2019}']);
    for mark in marks_of_thousands {
        if text.contains(mark) {
            text = Cow::Owned(without_thousands(&text, mark, marks.decimal)?);
        }
    }
    if marks.decimal == Decimal::Comma && text.contains(',') {
        text = Cow::Owned(text.replacen(',', ".", 1));
    }
    // Fortran: 1.5D+03, and 1.5+103 where the exponent has three digits
    if let Some(at) = text.find(['d', 'D']) {
        text.to_mut().replace_range(at..=at, "e");
    } else if let Some(at) = text.rfind(['+', '-'])
        && at > 0
        && text.as_bytes()[at - 1].is_ascii_digit()
        && text.len() - at == 4
        && !text.contains(['e', 'E'])
    {
        text.to_mut().insert(at, 'e');
    }
    let is_of_number = |byte: u8| byte.is_ascii_digit() || b"+-.eE".contains(&byte);
    text.bytes().all(is_of_number).then(|| text.into_owned())
}

/// The number without the marks between its thousands; `None` where these do not part it into thousands.
pub(super) fn without_thousands(number: &str, mark: char, decimal: Decimal) -> Option<String> {
    let point = match decimal {
        Decimal::Point => '.',
        Decimal::Comma => ',',
    };
    let whole = number.find(point).map_or(number, |at| &number[..at]);
    let mut groups = whole.trim_start_matches(['+', '-']).split(mark);
    let is_digits = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    let begins_well = groups
        .next()
        .is_some_and(|first| (1..=3).contains(&first.len()) && is_digits(first));
    let goes_on_well = groups.all(|group| group.len() == 3 && is_digits(group));
    let ends_well = !number[whole.len()..].contains(mark);
    (begins_well && goes_on_well && ends_well).then(|| number.replace(mark, ""))
}

/// What spreadsheets, R, databases, C runtimes and loggers write where there is no value.
const MISSING: [&str; 48] = [
    "",
    "na",
    "n/a",
    "#n/a",
    "null",
    "1.#inf",
    "-1.#inf",
    "-1.#ind",
    "1.#qnan",
    "1.#ind",
    "-nan",
    "+nan",
    "nan(ind)",
    "-nan(ind)",
    "<na>",
    "nat",
    "none",
    "nil",
    "-",
    "--",
    "---",
    "----",
    ".",
    "?",
    "n.a.",
    "no data",
    "nodata",
    "missing",
    "invalid",
    "#num!",
    "#value!",
    "#div/0!",
    "#ref!",
    "#name?",
    "#null!",
    "undefined",
    "unknown",
    "~",
    "n.d.",
    "no_data",
    "#n/d",
    "#n/v",
    "#nv",
    "#wert!",
    "#zahl!",
    "#valeur!",
    "bad",
    "err",
];

/// Whether a cell holds a sign for "no value".
pub(super) fn is_missing(text: &str) -> bool {
    let is_overflow = |text: &str| text.len() > 1 && text.bytes().all(|byte| byte == b'*');
    // --.--, as a display shows it
    let is_blank = |text: &str| {
        text.len() > 1 && text.contains('-') && text.bytes().all(|byte| b"-.:".contains(&byte))
    };
    MISSING.iter().any(|word| text.eq_ignore_ascii_case(word))
        || is_overflow(text)
        || is_blank(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COMMA: Marks = Marks {
        decimal: Decimal::Comma,
        has_thousands: false,
    };

    #[test]
    fn numbers_missing_values_and_everything_else() {
        for (text, expected) in [
            ("1.5", 1.5),
            (" -1.5e-3 ", -1.5e-3),
            ("\"+7\"", 7.0),
            ("'7'", 7.0),
            (".5", 0.5),
            ("1.5D+03", 1500.0),
            ("-0.15d-2", -1.5e-3),
            ("0.123-100", 0.123e-100),
            ("\u{2212}2", -2.0),
            ("12'345.5", 12345.5),
            ("12 345.5", 12345.5),
        ] {
            assert_eq!(number(text, Marks::POINT), Some(expected), "{text}");
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
            "-nan(ind)",
            "-",
            "---",
            "*****",
            "#DIV/0!",
        ] {
            assert!(
                number(text, Marks::POINT).is_some_and(f64::is_nan),
                "{text}"
            );
        }
        for text in [
            "x", "1,5", "1 2", "0x10", "1e999", "--1", "nano", "\"1", "12,345.5", "1-2", "d", "1'5",
        ] {
            assert_eq!(number(text, Marks::POINT), None, "{text}");
        }
    }

    #[test]
    fn a_decimal_comma_is_one_where_it_is_asked_for() {
        let comma = |text| number(text, COMMA);
        assert_eq!(comma("\"-1,5e-3\""), Some(-1.5e-3));
        assert_eq!(comma("7"), Some(7.0));
        for text in ["1,234,5", "1.234,5", "1,5 2", ","] {
            assert_eq!(comma(text), None, "{text}");
        }
        assert_eq!(number("1,5", Marks::POINT), None);
    }

    #[test]
    fn marks_between_thousands_are_passed_over_where_there_are_any() {
        let english = Marks {
            has_thousands: true,
            ..Marks::POINT
        };
        let german = Marks {
            has_thousands: true,
            ..COMMA
        };
        assert_eq!(number("12,345.5", english), Some(12345.5));
        assert_eq!(number("-1,234,567", english), Some(-1_234_567.0));
        assert_eq!(number("12.345,5", german), Some(12345.5));
        assert_eq!(number("1.234", german), Some(1234.0));
        for (text, marks) in [("12,34.5", english), ("1.5", german), ("1.2,345", english)] {
            assert_eq!(number(text, marks), None, "{text}");
        }
    }
}
