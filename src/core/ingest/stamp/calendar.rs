//! Days of the Gregorian calendar, counted from 1970-01-01.

/// The day of a date; `None` where there is none.
pub(super) fn day(year: i64, month: i64, day: i64) -> Option<i64> {
    let is_date = (1..=9999).contains(&year) && (1..=12).contains(&month) && day >= 1;
    if !is_date || day > length(year, month) {
        return None;
    }
    // years begin in March, so that the leap day is the last
    let years = if month <= 2 { year - 1 } else { year };
    let era = years.div_euclid(400);
    let of_era = years - era * 400;
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    Some(era * 146_097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719_468)
}

/// The day of a year's nth day.
pub(super) fn nth_day(year: i64, nth: i64) -> Option<i64> {
    let days = if is_leap(year) { 366 } else { 365 };
    let first = day(year, 1, 1)?;
    (1..=days).contains(&nth).then(|| first + nth - 1)
}

fn is_leap(year: i64) -> bool {
    year % 4 == 0 && (year % 100 != 0 || year % 400 == 0)
}

fn length(year: i64, month: i64) -> i64 {
    match month {
        2 if is_leap(year) => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_counted_as_the_calendar_has_them() {
        assert_eq!(day(1970, 1, 1), Some(0));
        assert_eq!(day(2000, 3, 1), Some(11_017));
        assert_eq!(day(2024, 2, 29), day(2024, 3, 1).map(|day| day - 1));
        assert_eq!(nth_day(2026, 325), day(2026, 11, 21));
        for (year, month, of) in [(2026, 2, 29), (2026, 13, 1), (2026, 0, 1), (2026, 4, 31)] {
            assert_eq!(day(year, month, of), None);
        }
        assert_eq!(nth_day(2026, 366), None);
    }
}
