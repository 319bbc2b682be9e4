//! Days as a workbook counts them become time stamps.

use jiff::Timestamp;

use super::styles::Shows;

/// Days from 1899-12-30, which is day 0, to 1970-01-01; and from 1904-01-01.
const TO_1970: f64 = 25_569.0;
const FROM_1904: f64 = 24_107.0;
const DAY: f64 = 86_400.0;

/// The time stamp of a number of days, to the microsecond; `None` where it is no date.
pub(super) fn stamp(days: f64, shows: Shows, has_dates_from_1904: bool) -> Option<String> {
    let since = if has_dates_from_1904 {
        FROM_1904
    } else {
        TO_1970
    };
    let is_time_of_day = shows == Shows::Time && (0.0..1.0).contains(&days);
    let since = if is_time_of_day { 0.0 } else { since };
    let microseconds = ((days - since) * DAY * 1e6).round();
    if microseconds.is_nan() || microseconds.abs() > 1e17 {
        return None;
    }
    let stamp = Timestamp::from_microsecond(microseconds as i64).ok()?;
    let text = format!("{stamp:.6}");
    let text = text.strip_suffix('Z').unwrap_or(&text);
    Some(match text.split_once('T') {
        Some((_, time)) if is_time_of_day => time.to_string(),
        _ => text.to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_become_stamps() {
        // 2026-11-21 is day 46347 of the calendar from 1900
        let noon = stamp(46_347.5 + 0.25 / DAY, Shows::Date, false);
        assert_eq!(noon.as_deref(), Some("2026-11-21T12:00:00.250000"));
        let same = stamp(46_347.5 - 1462.0, Shows::Date, true);
        assert_eq!(same.as_deref(), Some("2026-11-21T12:00:00.000000"));
        let time = stamp(0.5 + 1.5 / DAY, Shows::Time, false);
        assert_eq!(time.as_deref(), Some("12:00:01.500000"));
        assert_eq!(stamp(1e300, Shows::Date, false), None);
        assert_eq!(stamp(f64::NAN, Shows::Date, false), None);
    }
}
