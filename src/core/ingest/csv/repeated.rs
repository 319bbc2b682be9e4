//! Rows with one time: the same row twice, several values at one time, or a clock that is coarser than the rate.

use std::ops::Range;

use crate::flight::{Fault, Finding, FindingCode, ManeuverError};

use super::super::{
    axis::code_of,
    code,
    fault::{CELLS_LISTED, pointer},
    mapping::Repeated,
    note::note_of_rows,
};
use super::samples::Samples;

/// Makes time increase where that is clear or said.
///
/// # Errors
/// Time runs back; or several rows have one time, and it is not said what is made of them.
pub(super) fn resolve(
    samples: &mut Samples,
    said: Option<Repeated>,
    name: &str,
) -> Result<(), Vec<(usize, Fault)>> {
    if samples.time.windows(2).all(|pair| pair[0] < pair[1]) {
        return Ok(());
    }
    let back: Vec<(usize, Fault)> = runs_back(samples, name).take(CELLS_LISTED).collect();
    if !back.is_empty() {
        return Err(back);
    }
    if said != Some(Repeated::Spread) {
        keep_same_rows_once(samples);
    }
    let groups = groups(&samples.time);
    if groups.len() == samples.time.len() {
        return Ok(());
    }
    match said {
        None => return Err(vec![stands_still(samples, &groups, name)]),
        Some(Repeated::Spread) => spread(&mut samples.time, &groups),
        Some(Repeated::First) => keep(samples, &groups, |values, group| values[group.start]),
        Some(Repeated::Mean) => keep(samples, &groups, |values, group| {
            mean(&values[group.clone()])
        }),
    }
    Ok(())
}

fn runs_back(samples: &Samples, name: &str) -> impl Iterator<Item = (usize, Fault)> {
    let pairs = samples.time.windows(2).enumerate();
    pairs
        .filter(|(_, pair)| pair[1] < pair[0])
        .map(move |(at, pair)| {
            let row = samples.rows[at + 1] as usize;
            let error = ManeuverError::TimeNotIncreasing {
                row,
                before: pair[0],
                time: pair[1],
            };
            let message = format!("line {}: {error}", samples.lines[at + 1]);
            let place = pointer(["rows", &row.to_string(), name]);
            (row, Fault::new(place, code_of(&error), message))
        })
}

/// The stretches of one time.
fn groups(time: &[f64]) -> Vec<Range<usize>> {
    let mut groups = Vec::new();
    let mut start = 0;
    for at in 1..=time.len() {
        if at == time.len() || time[at] != time[start] {
            groups.push(start..at);
            start = at;
        }
    }
    groups
}

fn keep_same_rows_once(samples: &mut Samples) {
    let same = |values: &Vec<f64>, at: usize| {
        let (one, other) = (values[at - 1], values[at]);
        one == other || (one.is_nan() && other.is_nan())
    };
    let is_again = |at: usize| {
        at > 0
            && samples.time[at - 1] == samples.time[at]
            && samples.values.iter().all(|values| same(values, at))
    };
    let again: Vec<bool> = (0..samples.time.len()).map(is_again).collect();
    let rows: Vec<usize> = (0..again.len())
        .filter(|&at| again[at])
        .map(|at| samples.rows[at] as usize)
        .collect();
    if rows.is_empty() {
        return;
    }
    let message = format!(
        "{} row(s) are the row before once more, time included: they are kept once",
        rows.len()
    );
    samples.findings.push(repeated(&rows, message));
    let mut is_kept = again.iter().map(|again| !again).cycle();
    let mut next = |_: &f64| is_kept.next().unwrap_or(true);
    samples.time.retain(&mut next);
    for values in &mut samples.values {
        values.retain(&mut next);
    }
    let mut is_kept = again.iter().map(|again| !again).cycle();
    let mut next = |_: &u32| is_kept.next().unwrap_or(true);
    samples.lines.retain(&mut next);
    samples.rows.retain(&mut next);
}

fn repeated(rows: &[usize], message: String) -> Finding {
    note_of_rows(
        FindingCode::RepeatedTime,
        rows,
        message,
        "nothing needs to be done",
    )
}

fn keep(
    samples: &mut Samples,
    groups: &[Range<usize>],
    value: impl Fn(&[f64], &Range<usize>) -> f64,
) {
    let rows = groups
        .iter()
        .filter(|group| group.len() > 1)
        .map(|group| samples.rows[group.start] as usize);
    let rows: Vec<usize> = rows.collect();
    let message = format!(
        "{} time(s) stand in several rows: one sample was made of each",
        rows.len()
    );
    samples.findings.push(repeated(&rows, message));
    for values in &mut samples.values {
        *values = groups.iter().map(|group| value(values, group)).collect();
    }
    samples.time = groups
        .iter()
        .map(|group| samples.time[group.start])
        .collect();
    samples.lines = groups
        .iter()
        .map(|group| samples.lines[group.start])
        .collect();
    samples.rows = groups
        .iter()
        .map(|group| samples.rows[group.start])
        .collect();
}

/// Of the values that there are.
fn mean(values: &[f64]) -> f64 {
    let present = values.iter().filter(|value| !value.is_nan());
    present.clone().sum::<f64>() / present.count() as f64
}

/// The rows of each time evenly between it and the next.
fn spread(time: &mut [f64], groups: &[Range<usize>]) {
    let (usual, tick) = usual(time, groups);
    let step = tick / usual as f64;
    let recorded: Vec<f64> = groups.iter().map(|group| time[group.start]).collect();
    for (at, group) in groups.iter().enumerate() {
        let until_next = recorded
            .get(at + 1)
            .map_or(tick, |next| next - recorded[at]);
        let is_whole = until_next < 1.5 * tick && at > 0 && at + 1 < groups.len();
        let (first, step) = if is_whole {
            (recorded[at], until_next / group.len() as f64)
        } else if at == 0 {
            // the recording began within this tick
            let step = step.min(tick / group.len() as f64);
            (recorded[at] + tick - step * group.len() as f64, step)
        } else {
            (recorded[at], step.min(tick / group.len() as f64))
        };
        for (nth, row) in group.clone().enumerate() {
            time[row] = first + nth as f64 * step;
        }
    }
}

/// The usual number of rows of one time, and the usual time to the next.
fn usual(time: &[f64], groups: &[Range<usize>]) -> (usize, f64) {
    let median = |mut list: Vec<f64>| {
        list.sort_by(f64::total_cmp);
        list.get(list.len() / 2).copied().unwrap_or(1.0)
    };
    let rows = median(groups.iter().map(|group| group.len() as f64).collect());
    let ticks = groups
        .windows(2)
        .map(|pair| time[pair[1].start] - time[pair[0].start]);
    (rows as usize, median(ticks.collect()))
}

/// What a mapping could say where time stands still, by the fault that tells it.
pub(super) fn proposal(faults: &[Fault]) -> Option<Repeated> {
    let of_time = |fault: &&Fault| fault.code == code::TIME_NOT_INCREASING;
    let told = faults.iter().find(of_time)?;
    if told.message.contains(SPREAD) {
        Some(Repeated::Spread)
    } else {
        told.message.contains(FIRST).then_some(Repeated::First)
    }
}

const SPREAD: &str = "repeated = \"spread\"";
const FIRST: &str = "repeated = \"first\"";

fn stands_still(samples: &Samples, groups: &[Range<usize>], name: &str) -> (usize, Fault) {
    let first = groups
        .iter()
        .find(|group| group.len() > 1)
        .map_or(0, |group| group.start + 1);
    let (row, line) = (samples.rows[first] as usize, samples.lines[first]);
    let count = samples.time.len() - groups.len();
    let (usual, tick) = usual(&samples.time, groups);
    let remedy = if usual > 1 {
        let step = (tick / usual as f64 * 1e9).round() / 1e9;
        format!(
            "its clock is coarser than the rate, {usual} rows in {tick} s: say in a mapping time = {{step = {step}, unit = \"s\"}} for even sampling, or time = {{{SPREAD}}}"
        )
    } else {
        "say in a mapping which to keep, time = {repeated = \"first\"} or {repeated = \"mean\"}"
            .to_string()
    };
    let message = format!(
        "line {line}: time stands still: {count} row(s) have the time of the row before and other values, the first is row {row} with {} s; {remedy}",
        samples.time[first]
    );
    (
        row,
        Fault::new(
            pointer(["rows", &row.to_string(), name]),
            code::TIME_NOT_INCREASING,
            message,
        ),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(time: &[f64], values: &[f64]) -> Samples {
        Samples {
            time: time.to_vec(),
            values: vec![values.to_vec()],
            lines: (2..).take(time.len()).collect(),
            rows: (1..).take(time.len()).collect(),
            unreadable: vec![None],
            findings: Vec::new(),
            origin: None,
            faults: Vec::new(),
        }
    }

    #[test]
    fn the_same_row_is_kept_once_and_others_as_is_said() {
        let mut twice = samples(&[0.0, 1.0, 1.0, 2.0], &[5.0, 6.0, 6.0, f64::NAN]);
        assert!(resolve(&mut twice, None, "t").is_ok());
        assert_eq!(
            (twice.time, twice.rows),
            (vec![0.0, 1.0, 2.0], vec![1, 2, 4])
        );
        assert_eq!(twice.findings[0].rows, [3]);

        let other = || samples(&[0.0, 1.0, 1.0, 2.0], &[5.0, 6.0, 8.0, 9.0]);
        for (said, expected) in [(Repeated::First, 6.0), (Repeated::Mean, 7.0)] {
            let mut samples = other();
            assert!(resolve(&mut samples, Some(said), "t").is_ok());
            assert_eq!(samples.values[0], [5.0, expected, 9.0]);
        }
        let (row, fault) = resolve(&mut other(), None, "t").unwrap_err().remove(0);
        assert_eq!((row, fault.pointer.as_str()), (3, "/rows/3/t"));
        assert_eq!(proposal(&[fault]), Some(Repeated::First));
    }

    #[test]
    fn a_coarse_clock_is_told_and_spread() {
        let time: Vec<f64> = (0..20).map(|row| f64::from((row + 2) / 4)).collect();
        let values: Vec<f64> = (0..20).map(f64::from).collect();
        let (_, fault) = resolve(&mut samples(&time, &values), None, "t")
            .unwrap_err()
            .remove(0);
        assert!(fault.message.contains("step = 0.25"), "{fault}");
        assert_eq!(proposal(&[fault]), Some(Repeated::Spread));
        let mut even = samples(&time, &values);
        assert!(resolve(&mut even, Some(Repeated::Spread), "t").is_ok());
        let expected: Vec<f64> = (0..20).map(|row| 0.5 + f64::from(row) * 0.25).collect();
        assert_eq!(even.time, expected);
    }

    #[test]
    fn time_that_runs_back_is_refused_with_its_lines() {
        let faults =
            resolve(&mut samples(&[0.0, 2.0, 1.0, 0.5], &[0.0; 4]), None, "t").unwrap_err();
        let rows: Vec<usize> = faults.iter().map(|(row, _)| *row).collect();
        assert_eq!(rows, [3, 4]);
        assert!(
            faults[0]
                .1
                .message
                .starts_with("line 4: time does not increase")
        );
    }
}
