//! Dates as they are written: `2026-11-21`, `21.11.2026`, `11/21/2026`, `21-Nov-2026`, `2026-325`.

use super::calendar::{day, nth_day};

/// The day that a text is with the day before the month, and with the month before the day. Where both are possible and
/// differ, the text alone does not tell.
pub(super) type Readings = [Option<i64>; 2];

const MONTHS: [&str; 12] = [
    "jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec",
];

/// Reads a date; `None` if the text is none.
pub(super) fn date(text: &str) -> Option<Readings> {
    if !text.is_ascii() {
        return None;
    }
    let fields: Vec<&str> = text
        .split(['-', '/', '.', ' ', ','])
        .filter(|field| !field.is_empty())
        .collect();
    let only = |day: i64| Some([Some(day); 2]);
    match *fields.as_slice() {
        // 21NOV2026
        [packed] if packed.len() == 9 => {
            let (of, rest) = packed.split_at(2);
            let (name, year) = rest.split_at(3);
            only(day(number(year)?, month(name)?, number(of)?)?)
        }
        [compact] if compact.len() == 8 => {
            let (year, rest) = (number(&compact[..4])?, &compact[4..]);
            only(day(year, number(&rest[..2])?, number(&rest[2..])?)?)
        }
        [year, nth] if year.len() == 4 && nth.len() == 3 => {
            only(nth_day(number(year)?, number(nth)?)?)
        }
        [first, second, third] => {
            if let Some(month) = month(second) {
                let (year, of) = if first.len() == 4 {
                    (first, third)
                } else {
                    (third, first)
                };
                return only(day(year_of(year)?, month, number(of)?)?);
            }
            if let Some(month) = month(first) {
                return only(day(year_of(third)?, month, number(second)?)?);
            }
            if first.len() == 4 {
                return only(day(number(first)?, number(second)?, number(third)?)?);
            }
            let (year, first, second) = (year_of(third)?, number(first)?, number(second)?);
            let readings = [day(year, second, first), day(year, first, second)];
            // 21.11.2026 has the day first everywhere
            let readings = if text.contains('.') {
                [readings[0]; 2]
            } else {
                readings
            };
            readings.iter().any(Option::is_some).then_some(readings)
        }
        _ => None,
    }
}

fn month(text: &str) -> Option<i64> {
    let begin = text.get(..3)?.to_ascii_lowercase();
    let at = MONTHS.iter().position(|month| *month == begin)?;
    text.bytes()
        .all(|byte| byte.is_ascii_alphabetic())
        .then_some(at as i64 + 1)
}

fn year_of(text: &str) -> Option<i64> {
    match text.len() {
        4 => number(text),
        2 => number(text).map(|year| if year < 70 { 2000 + year } else { 1900 + year }),
        _ => None,
    }
}

/// A number of one to four digits.
pub(super) fn number(text: &str) -> Option<i64> {
    let is_number = (1..=4).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| text.parse().ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_day_in_every_way() {
        let expected = day(2026, 11, 21).map(|day| [Some(day); 2]);
        for text in [
            "2026-11-21",
            "2026/11/21",
            "2026.11.21",
            "20261121",
            "21.11.2026",
            "21.11.26",
            "21-Nov-2026",
            "21 November 2026",
            "Nov 21, 2026",
            "2026-Nov-21",
            "2026-325",
        ] {
            assert_eq!(date(text), expected, "{text}");
        }
        assert_eq!(date("21/11/2026"), Some([day(2026, 11, 21), None]));
        assert_eq!(date("11/21/2026"), Some([None, day(2026, 11, 21)]));
        assert_eq!(date("03/04/2026"), Some([day(2026, 4, 3), day(2026, 3, 4)]));
        for text in [
            "",
            "1.5",
            "2026",
            "32.1.2026",
            "1.2.3",
            "2026-13-01",
            "a-b-2026",
            "99999999",
            "abc€de",
            "€-abc",
        ] {
            assert_eq!(date(text), None, "{text}");
        }
    }
}
