//! The time axis: gaps and uneven sampling.

use crate::flight::{Finding, Maneuver, Severity};

use super::finding::finding;

/// As in `flight::Sampling`: smaller differences are rounding of the time column.
const EVEN_WITHIN: f64 = 0.02;

/// Each gap is a finding of its own: there are few, and each has its length.
pub(super) fn gaps(maneuver: &Maneuver) -> Vec<Finding> {
    let sampling = maneuver.sampling();
    let report = |gap: &crate::flight::Gap| {
        let message = format!(
            "{} s between rows {} and {}, where samples are {} s apart",
            rounded(gap.duration),
            gap.before,
            gap.before + 1,
            rounded(sampling.step)
        );
        finding(
            "gap",
            Severity::Warning,
            None,
            &[gap.before],
            message,
            "a job simulates each part from its own initial state; say \"gaps\": \"join\" beside the maneuver's \"id\" in the job to run them as one time history",
        )
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

pub(super) fn uneven(maneuver: &Maneuver) -> Option<Finding> {
    let sampling = maneuver.sampling();
    if sampling.even {
        return None;
    }
    let behind_gap: std::collections::HashSet<usize> =
        sampling.gaps.iter().map(|gap| gap.before).collect();
    let time = maneuver.time();
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
    Some(finding(
        "uneven_sampling",
        Severity::Warning,
        None,
        &rows,
        message,
        "look for lost samples and for a time column with too few digits; resample to an even step where a method needs one",
    ))
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

    fn at(time: Vec<f64>) -> Maneuver {
        Maneuver::new(time, indexmap::IndexMap::new()).unwrap()
    }

    #[test]
    fn a_gap_names_its_length_and_rows() {
        let time = (0..20).map(|k| f64::from(k) * 0.04 + if k < 10 { 0.0 } else { 30.0 });
        let found = gaps(&at(time.collect()));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].rows, [11]);
        let expected = "30.04 s between rows 10 and 11, where samples are 0.04 s apart";
        assert_eq!(found[0].message, expected);
        assert!(found[0].remedy.contains("\"gaps\": \"join\""));
    }

    #[test]
    fn many_gaps_are_counted_not_listed() {
        let time = (0..1000).map(|k| f64::from(k) * 0.1 + f64::from(k / 10) * 60.0);
        let found = gaps(&at(time.collect()));
        assert_eq!(found.len(), Finding::ROWS_LISTED);
        assert!(found[19].message.ends_with("79 more gaps follow"));
    }

    #[test]
    fn uneven_steps_are_listed() {
        let time = (0..50).map(|k| f64::from(k) * 0.1 + if k == 20 { 0.03 } else { 0.0 });
        let found = uneven(&at(time.collect())).unwrap();
        assert_eq!((found.rows.as_slice(), found.count), (&[21, 22][..], 2));
        assert!(
            found.message.contains("between 0.07 and 0.13 s"),
            "{}",
            found.message
        );
        assert_eq!(
            uneven(&at((0..50).map(|k| f64::from(k) * 0.1).collect())),
            None
        );
    }
}
