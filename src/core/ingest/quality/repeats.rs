//! Values that repeat exactly: constants, stuck sensors, rows written twice.

use std::ops::Range;

use crate::flight::{Finding, Maneuver, Severity};

use super::finding::finding;

/// A stretch of equal values is long from here on.
const LONG: usize = 25;
/// A channel that otherwise stands still in fewer samples than this share has noise in every sample:
/// a long stretch of equal values in it is no chance.
const RARELY_EQUAL: f64 = 0.05;
/// In a quantised channel equal values are usual; a stretch must be this much longer than any other.
const LONGER_THAN_OTHERS: usize = 5;
/// Fewer stretches than this are a command (0, step, 0), not a quantised measurement.
const ENOUGH_STRETCHES: usize = 50;
/// Rows of fewer changing channels are equal by chance.
const ENOUGH_CHANNELS: usize = 4;

/// One value for the whole recording.
pub(super) fn constant(name: &str, values: &[f64]) -> Option<Finding> {
    let mut present = values.iter().copied().filter(|value| !value.is_nan());
    let first = present.next()?;
    if present.any(|value| value != first) {
        return None;
    }
    let message = format!("the value is {first} (SI) throughout");
    Some(finding(
        "constant",
        Severity::Note,
        Some(name),
        &[0],
        message,
        "leave the channel out of the outputs: a constant tells nothing, and may be a sensor out of range",
    ))
}

/// Long stretches of one value in a channel that otherwise moves.
pub(super) fn stuck(
    name: &str,
    values: &[f64],
    segments: &[Range<usize>],
    repeated: &RepeatedRows,
) -> Option<Finding> {
    let stretches: Vec<Range<usize>> = segments
        .iter()
        .flat_map(|segment| equal_stretches(values, segment.clone()))
        .collect();
    let stuck: Vec<&Range<usize>> = stuck_among(&stretches)
        .into_iter()
        .filter(|stretch| !repeated.cover(stretch))
        .collect();
    let longest = stuck.iter().max_by_key(|stretch| stretch.len())?;
    let severity = severity_of(stuck.iter().map(|stretch| stretch.start));
    let message = format!(
        "{} value(s) in a row are exactly equal from row {}, in a channel that otherwise changes ({} such stretch(es))",
        longest.len(),
        longest.start + 1,
        stuck.len()
    );
    let rows: Vec<usize> = stuck.iter().map(|stretch| stretch.start).collect();
    Some(finding(
        "repeated_values",
        severity,
        Some(name),
        &rows,
        message,
        "look for a stuck sensor or a lost data link; make the cells empty there, or cut the stretch",
    ))
}

/// A stretch at the very start may be the steady state before a simulated maneuver.
fn severity_of(starts: impl Iterator<Item = usize>) -> Severity {
    let mut starts = starts;
    if starts.all(|start| start == 0) {
        Severity::Note
    } else {
        Severity::Warning
    }
}

fn stuck_among(stretches: &[Range<usize>]) -> Vec<&Range<usize>> {
    let (long, short): (Vec<_>, Vec<_>) =
        stretches.iter().partition(|stretch| stretch.len() >= LONG);
    if short.len() < ENOUGH_STRETCHES {
        return Vec::new();
    }
    let samples: usize = short.iter().map(|stretch| stretch.len()).sum();
    let equal = samples - short.len();
    if (equal as f64) < RARELY_EQUAL * samples as f64 {
        return long;
    }
    // Quantised: one stretch far longer than all others.
    let mut by_length: Vec<&Range<usize>> = stretches.iter().collect();
    by_length.sort_by_key(|stretch| std::cmp::Reverse(stretch.len()));
    match by_length.as_slice() {
        [longest, next, ..]
            if longest.len() >= LONG && longest.len() >= LONGER_THAN_OTHERS * next.len() =>
        {
            vec![*longest]
        }
        _ => Vec::new(),
    }
}

/// The stretches of exactly equal values in a segment; a missing value is equal to nothing.
fn equal_stretches(values: &[f64], segment: Range<usize>) -> Vec<Range<usize>> {
    let mut stretches = Vec::new();
    let mut start = segment.start;
    for k in segment.start + 1..segment.end {
        if values[k] != values[k - 1] {
            stretches.push(start..k);
            start = k;
        }
    }
    if start < segment.end {
        stretches.push(start..segment.end);
    }
    stretches
}

/// Rows that repeat the row before them in every channel that changes at all.
pub(super) struct RepeatedRows {
    is_repeated: Vec<bool>,
}

impl RepeatedRows {
    pub(super) fn of(maneuver: &Maneuver, segments: &[Range<usize>]) -> Self {
        let changes = |values: &&Vec<f64>| values.windows(2).any(|pair| pair[0] != pair[1]);
        let channels = maneuver.channels().values();
        let changing: Vec<&Vec<f64>> = channels
            .map(|channel| &channel.values)
            .filter(|values| changes(values))
            .collect();
        let mut is_repeated = vec![changing.len() >= ENOUGH_CHANNELS; maneuver.len()];
        for segment in segments {
            is_repeated[segment.start] = false;
        }
        for values in changing {
            for (k, pair) in values.windows(2).enumerate() {
                is_repeated[k + 1] &= pair[0] == pair[1];
            }
        }
        Self { is_repeated }
    }

    /// Whether a stretch of equal values is nothing but repeated rows.
    fn cover(&self, stretch: &Range<usize>) -> bool {
        self.is_repeated[stretch.start + 1..stretch.end]
            .iter()
            .all(|&repeated| repeated)
    }

    pub(super) fn finding(&self) -> Option<Finding> {
        let rows: Vec<usize> = (0..self.is_repeated.len())
            .filter(|&row| self.is_repeated[row])
            .collect();
        let moving = self.is_repeated.iter().skip(1).position(|&row| !row)?;
        let severity = if rows.iter().all(|&row| row <= moving) {
            Severity::Note
        } else {
            Severity::Warning
        };
        if rows.is_empty() {
            return None;
        }
        let message = format!(
            "{} row(s) repeat the row before them in every channel that changes",
            rows.len()
        );
        Some(finding(
            "repeated_rows",
            severity,
            None,
            &rows,
            message,
            "if the recorder wrote a sample more than once, keep the first of each; a lower rate may be the true one",
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{maneuver, noise};
    use super::*;

    fn stuck_rows(values: Vec<f64>) -> Vec<(usize, Severity)> {
        let maneuver = maneuver(&[("q", values)]);
        let segments = maneuver.sampling().segments();
        let repeated = RepeatedRows::of(&maneuver, &segments);
        let values = &maneuver.channels()["q"].values;
        let found = stuck("q", values, &segments, &repeated);
        found.map_or(Vec::new(), |finding| {
            let severity = finding.severity;
            finding.rows.iter().map(|&row| (row, severity)).collect()
        })
    }

    #[test]
    fn a_stuck_sensor_is_seen_and_a_steady_start_is_a_note() {
        let mut values: Vec<f64> = (0..400).map(noise).collect();
        assert_eq!(stuck_rows(values.clone()), []);
        values[200..230].fill(0.5);
        assert_eq!(stuck_rows(values.clone()), [(201, Severity::Warning)]);
        let mut steady: Vec<f64> = (0..400).map(noise).collect();
        steady[..50].fill(0.5);
        assert_eq!(stuck_rows(steady), [(1, Severity::Note)]);
        values[210] = f64::NAN;
        assert_eq!(stuck_rows(values), [], "two halves of a stretch are short");
    }

    #[test]
    fn quantised_signals_and_commands_do_not_alarm() {
        let quantised = |k: usize| (3.0 * (k as f64 * 0.02).sin() + 0.3 * noise(k)).round();
        assert_eq!(stuck_rows((0..1000).map(quantised).collect()), []);
        let command = |k: usize| f64::from(u8::from((200..250).contains(&k)));
        assert_eq!(stuck_rows((0..1000).map(command).collect()), []);
        let mut stuck: Vec<f64> = (0..1000).map(|k| (2.0 * noise(k)).round()).collect();
        stuck[500..700].fill(1.0);
        assert_eq!(stuck_rows(stuck).len(), 1);
    }

    #[test]
    fn constants_are_notes() {
        let found = constant("gear", &[f64::NAN, 0.0, 0.0]).unwrap();
        assert_eq!(
            (found.code.as_str(), found.severity),
            ("constant", Severity::Note)
        );
        assert_eq!(constant("q", &[0.0, 1.0]), None);
        assert_eq!(constant("q", &[f64::NAN; 3]), None);
    }

    #[test]
    fn rows_written_twice_are_seen() {
        let names = ["a", "b", "c", "d"];
        let channels: Vec<(&str, Vec<f64>)> = names
            .iter()
            .zip([1, 2, 3, 4])
            .map(|(name, seed)| {
                let values = (0..100).map(|k| noise(seed * 1000 + if k >= 50 { k - 1 } else { k }));
                (*name, values.collect())
            })
            .collect();
        let found = |channels: &[(&str, Vec<f64>)]| {
            let maneuver = maneuver(channels);
            RepeatedRows::of(&maneuver, &maneuver.sampling().segments()).finding()
        };
        let finding = found(&channels).unwrap();
        assert_eq!((finding.rows.as_slice(), finding.count), (&[51][..], 1));
        assert_eq!(finding.severity, Severity::Warning);
        assert_eq!(found(&channels[..3]), None, "too few channels to tell");
    }
}
