//! The time axis: gaps, uneven sampling, clocks in ticks, and units of time that slipped.

use crate::flight::{Finding, FindingCode, Sampling, five_digits};

/// As in `flight::Sampling`: smaller differences are rounding of the time column.
const EVEN_WITHIN: f64 = 0.02;

/// Each gap is a finding of its own: there are few, and each has its length.
pub(super) fn gaps(sampling: &Sampling) -> Vec<Finding> {
    let report = |gap: &crate::flight::Gap| {
        let message = format!(
            "{} s between rows {} and {}, where samples are {} s apart",
            rounded(gap.duration),
            gap.before,
            gap.before + 1,
            rounded(sampling.step)
        );
        let remedy = "a job integrates through it where it is short against the motion, and else simulates each part from an initial state of its own; say \"gaps\": \"through\", \"split\" or \"join\" beside the maneuver's \"id\" to choose";
        Finding::new(FindingCode::Gap, message, remedy).at_rows(&[gap.before])
    };
    let listed = sampling.gaps.iter().take(Finding::ROWS_LISTED);
    let mut findings: Vec<Finding> = listed.map(report).collect();
    let more = sampling.gaps.len() - findings.len();
    if let Some(last) = findings.last_mut().filter(|_| more > 0) {
        last.message = format!("{}; {more} more gaps follow", last.message);
        last.count += more;
    }
    findings
}

pub(super) fn uneven(time: &[f64], sampling: &Sampling) -> Option<Finding> {
    if sampling.even {
        return None;
    }
    let behind_gap: std::collections::HashSet<usize> =
        sampling.gaps.iter().map(|gap| gap.before).collect();
    let step = |row: usize| time[row] - time[row - 1];
    let rows: Vec<usize> = (1..time.len())
        .filter(|row| !behind_gap.contains(row))
        .filter(|&row| (step(row) - sampling.step).abs() > EVEN_WITHIN * sampling.step)
        .collect();
    let steps = rows.iter().map(|&row| step(row));
    let shortest = steps.clone().reduce(f64::min)?;
    let longest = steps.reduce(f64::max)?;
    let message = format!(
        "{} of {} steps are not the usual {} s: they are between {} and {} s",
        rows.len(),
        time.len() - 1,
        rounded(sampling.step),
        rounded(shortest),
        rounded(longest)
    );
    let remedy = "look for lost samples and for a time column with too few digits; resample to an even step where a method needs one";
    Some(Finding::new(FindingCode::UnevenSampling, message, remedy).at_rows(&rows))
}

/// Time that is told in ticks coarser than the sampling, which is even all the same.
pub(super) fn coarse(sampling: &Sampling) -> Option<Finding> {
    let tick = sampling.tick?;
    let message = format!(
        "time is told in ticks of {} s; the sampling is even to within one of them: {} s, or {:.6} Hz",
        rounded(tick),
        rounded(sampling.step),
        1.0 / sampling.step
    );
    let remedy = "nothing: jobs run at the even step";
    Some(Finding::new(FindingCode::CoarseClock, message, remedy))
}

/// Samples further apart than this tell nothing of the motion of an aircraft, s.
const SLOWEST: f64 = 3.0;
/// No recorder is faster over less than [`SHORTEST`], s.
const FASTEST: f64 = 5e-4;
/// No maneuver is shorter, s.
const SHORTEST: f64 = 0.5;

/// A step that no recorder of flights has: the unit of time has slipped.
pub(super) fn implausible(time: &[f64], sampling: &Sampling) -> Option<Finding> {
    let step = sampling.step;
    let duration = time[time.len() - 1] - time[0];
    let (seen, slip) = if step >= SLOWEST {
        let slip = if step >= 1000.0 * SLOWEST {
            "microseconds"
        } else {
            "milliseconds"
        };
        ("too slow for the motion of an aircraft", slip)
    } else if step <= FASTEST && duration < SHORTEST {
        (
            "faster than any recorder writes over so short a time",
            "seconds",
        )
    } else {
        return None;
    };
    let message = format!(
        "samples are {} s apart over {} s: {seen}; is the time in {slip}?",
        five_digits(step),
        five_digits(duration)
    );
    let remedy = "correct the unit of time in the recording's header, or in a mapping";
    Some(Finding::new(FindingCode::ImplausibleRate, message, remedy))
}

/// To the nanosecond: 110.16 - 80.08 is 30.08 and not 30.080000000000005.
fn rounded(seconds: f64) -> f64 {
    let nanoseconds = (seconds * 1e9).round() / 1e9;
    if nanoseconds == 0.0 || !nanoseconds.is_finite() {
        seconds
    } else {
        nanoseconds
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampling(time: &[f64]) -> Sampling {
        let maneuver = crate::flight::Maneuver::new(time.to_vec(), indexmap::IndexMap::new());
        maneuver.unwrap().sampling().clone()
    }

    fn uneven_at(time: Vec<f64>) -> Option<Finding> {
        uneven(&time, &sampling(&time))
    }

    fn implausible_at(step: f64, count: u32) -> Option<String> {
        let time: Vec<f64> = (0..count).map(|k| f64::from(k) * step).collect();
        implausible(&time, &sampling(&time)).map(|finding| finding.message)
    }

    #[test]
    fn a_slipped_unit_of_time_is_seen() {
        assert!(
            implausible_at(20.0, 700)
                .unwrap()
                .contains("in milliseconds?")
        );
        assert!(
            implausible_at(20_000.0, 700)
                .unwrap()
                .contains("in microseconds?")
        );
        assert!(implausible_at(2e-5, 700).unwrap().contains("in seconds?"));
        for (step, count) in [(1.0, 4000), (0.02, 700), (1e-4, 100_000)] {
            assert_eq!(implausible_at(step, count), None, "{step}");
        }
    }

    #[test]
    fn ticks_are_no_jitter() {
        let time: Vec<f64> = (0..700)
            .map(|k| (f64::from(k) * 0.02 * 512.0).floor() / 512.0)
            .collect();
        let sampling = sampling(&time);
        assert_eq!((sampling.step, sampling.even), (0.02, true));
        assert!(coarse(&sampling).unwrap().message.contains("50.000000 Hz"));
        assert_eq!(uneven(&time, &sampling), None);
    }

    #[test]
    fn a_gap_names_its_length_and_rows() {
        let time = (0..20).map(|k| f64::from(k) * 0.04 + if k < 10 { 0.0 } else { 30.0 });
        let found = gaps(&sampling(&time.collect::<Vec<f64>>()));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].rows, [11]);
        let expected = "30.04 s between rows 10 and 11, where samples are 0.04 s apart";
        assert_eq!(found[0].message, expected);
        assert!(found[0].remedy.contains("\"gaps\": \"through\""));
    }

    #[test]
    fn many_gaps_are_counted_not_listed() {
        let time = (0..1000).map(|k| f64::from(k) * 0.1 + f64::from(k / 10) * 60.0);
        let found = gaps(&sampling(&time.collect::<Vec<f64>>()));
        assert_eq!(found.len(), Finding::ROWS_LISTED);
        assert!(found[19].message.ends_with("79 more gaps follow"));
    }

    #[test]
    fn uneven_steps_are_listed() {
        let time = (0..50).map(|k| f64::from(k) * 0.1 + if k == 20 { 0.03 } else { 0.0 });
        let found = uneven_at(time.collect()).unwrap();
        assert_eq!((found.rows.as_slice(), found.count), (&[21, 22][..], 2));
        assert!(
            found.message.contains("between 0.07 and 0.13 s"),
            "{}",
            found.message
        );
        assert_eq!(
            uneven_at((0..50).map(|k| f64::from(k) * 0.1).collect()),
            None
        );
    }
}
