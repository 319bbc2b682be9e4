//! Values of one channel that repeat exactly: constants and stuck sensors.

use std::ops::Range;

use crate::flight::convention::is_control;
use crate::flight::{Finding, FindingCode, Severity};

use super::rows::RepeatedRows;
use super::statistics::{percentile, sorted};

/// A stretch of equal values is long from here on.
const LONG: usize = 25;
/// A channel that otherwise stands still in fewer samples than this share has noise in every sample:
/// a long stretch of equal values in it is no chance.
const RARELY_EQUAL: f64 = 0.05;
/// In a quantised channel equal values are usual; a stretch must be this much longer than any other.
const LONGER_THAN_OTHERS: usize = 5;
/// Fewer stretches than this are a command (0, step, 0), not a quantised measurement.
const ENOUGH_STRETCHES: usize = 50;
/// A signal whose changes turn round less often than this is smooth: it may come to rest.
const NOISY: f64 = 0.25;
/// A smooth signal was held where it goes on by so many of its larger steps at once.
const JUMP: f64 = 5.0;
/// A quantised signal stands still for so long by chance once in so many recordings.
const CHANCE: f64 = 1e-3;

/// One value for the whole recording.
pub(super) fn constant(name: &str, values: &[f64]) -> Option<Finding> {
    let mut present = values.iter().copied().filter(|value| !value.is_nan());
    let first = present.next()?;
    if present.any(|value| value != first) {
        return None;
    }
    let size = first.abs();
    let shown = match size == 0.0 || (1e-9..1e15).contains(&size) {
        true => first.to_string(),
        false => format!("{first:e}"),
    };
    let message = format!("the value is {shown} (SI) throughout");
    let remedy = "leave the channel out of the outputs: a constant tells nothing, and may be a sensor out of range";
    let constant = Finding::new(FindingCode::Constant, message, remedy);
    Some(constant.of_channel(name).at_rows(&[0]))
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
        .filter(|stretch| is_no_rest(name, values, segments, stretch))
        .collect();
    let longest = stuck.iter().max_by_key(|stretch| stretch.len())?;
    let severity = severity_of(stuck.iter().map(|stretch| stretch.start));
    let message = format!(
        "{} value(s) in a row are exactly equal, in a channel that otherwise changes ({} such stretch(es))",
        longest.len(),
        stuck.len()
    );
    let rows: Vec<usize> = stuck.iter().map(|stretch| stretch.start).collect();
    let remedy = "look for a stuck sensor or a lost data link; make the cells empty there, or cut the stretch";
    let stuck = Finding::new(FindingCode::RepeatedValues, message, remedy);
    Some(
        stuck
            .with_severity(severity)
            .of_channel(name)
            .at_rows(&rows),
    )
}

/// Whether a channel that stands still is no signal that has come to rest: it has noise elsewhere, or goes on with a jump.
fn is_no_rest(
    name: &str,
    values: &[f64],
    segments: &[Range<usize>],
    stretch: &Range<usize>,
) -> bool {
    let changes: Vec<f64> = (segments.iter())
        .flat_map(|segment| values[segment.clone()].windows(2))
        .map(|pair| pair[1] - pair[0])
        .filter(|change| change.is_finite() && *change != 0.0)
        .collect();
    let turns = changes.windows(2).filter(|pair| pair[0] * pair[1] < 0.0);
    if turns.count() as f64 > NOISY * changes.len() as f64 {
        return true;
    }
    // a command may rest and step as it likes
    let within = segments
        .iter()
        .any(|segment| stretch.end < segment.end && segment.contains(&stretch.start));
    let sizes = sorted(changes.iter().map(|change| change.abs()));
    let usual = percentile(&sizes, 0.9).unwrap_or(f64::INFINITY);
    let jumps = within && (values[stretch.end] - values[stretch.end - 1]).abs() > JUMP * usual;
    jumps && !is_control(name)
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
    // Quantised: one stretch far longer than all others, and than the shares of equal neighbours make likely.
    let share = equal as f64 / samples as f64;
    let likely = |length: usize| samples as f64 * share.powf(length as f64) > CHANCE;
    let mut by_length: Vec<&Range<usize>> = stretches.iter().collect();
    by_length.sort_by_key(|stretch| std::cmp::Reverse(stretch.len()));
    match by_length.as_slice() {
        [longest, next, ..]
            if longest.len() >= LONG
                && longest.len() >= LONGER_THAN_OTHERS * next.len()
                && !likely(longest.len()) =>
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

#[cfg(test)]
mod tests {
    use super::super::tests::{maneuver, noise};
    use super::*;

    fn stuck_rows(values: Vec<f64>) -> Vec<(usize, Severity)> {
        let maneuver = maneuver(&[("q", values)]);
        let segments = maneuver.sampling().segments();
        let repeated = RepeatedRows::of(&super::super::Record::of(&maneuver), &segments);
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
    fn an_elevator_that_comes_to_rest_is_none_and_a_frozen_attitude_is_one() {
        let sweep = |k: usize| (0.0004 * (k * k) as f64).sin();
        let swept: Vec<f64> = (0..400)
            .map(|k| if k < 250 { sweep(k) } else { sweep(250) })
            .collect();
        let found = |name: &str, values: Vec<f64>| {
            let maneuver = maneuver(&[(name, values)]);
            let record = super::super::Record::of(&maneuver);
            let segments = record.segments();
            let repeated = RepeatedRows::of(&record, &segments);
            stuck(name, &record.series[0].values, &segments, &repeated).is_some()
        };
        assert!(!found("de", swept.clone()));
        assert!(!found("theta", swept));
        let frozen: Vec<f64> = (0..400)
            .map(|k| (0.05 * f64::from(if (180..240).contains(&k) { 180 } else { k })).sin())
            .collect();
        assert!(found("theta", frozen));
        // a quantised channel that drifts slowly
        let slow: Vec<f64> = (0..800)
            .map(|k| (0.03 * f64::from(k) + 0.4 * noise(k as usize)).round())
            .collect();
        assert!(!found("y_cg", slow));
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
}
