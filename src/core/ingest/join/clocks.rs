//! How the clocks of files are put together.

use super::super::stamp::ClockKind;
use super::super::text::quoted;
use super::super::{IngestError, Origin, code, note};
use super::part::Part;
use crate::flight::{Fault, Finding, FindingCode, escape};

/// The times of each file on the time of the first.
pub(super) fn axes(parts: &[Part]) -> Result<Vec<Vec<f64>>, IngestError> {
    let shifts = shifts(parts)?;
    let shifted = parts.iter().zip(&shifts).map(|(part, shift)| {
        let times = part.reading.maneuver.time().iter();
        times.map(|time| time + shift).collect()
    });
    let axes: Vec<Vec<f64>> = shifted.collect();
    let is_blurred = |axis: &[f64]| !axis.is_sorted_by(|a, b| a < b);
    let blurred = parts.iter().zip(&axes).filter(|(_, axis)| is_blurred(axis));
    let faults = blurred.map(|(part, _)| {
        let message = "so far from zero its times are no longer told apart; say a smaller offset";
        fault(part, message.to_string())
    });
    IngestError::refuse(faults.collect())?;
    Ok(axes)
}

/// What is added to the times of each file.
fn shifts(parts: &[Part]) -> Result<Vec<f64>, IngestError> {
    let first = parts.first().and_then(|part| part.reading.origin);
    let mut faults = Vec::new();
    let mut shifts = Vec::new();
    for part in parts {
        let origin = part.reading.origin;
        let since = origin
            .zip(first)
            .and_then(|(origin, first)| origin.since(first));
        let offset = part.offset.unwrap_or(0.0);
        if !offset.is_finite() {
            faults.push(fault(part, "its offset is a number of seconds".to_string()));
        }
        match since {
            Some(since) => shifts.push(since + offset),
            None if part.offset.is_some() => shifts.push(offset),
            None => {
                let name = |origin: Option<Origin>| {
                    origin.map_or("dates whose day and month are not clear", Origin::name)
                };
                let message = format!(
                    "its times are {} and those of {} {}: say what is added to its times, as {{{}: 0.12}} under offsets, 0 where both begin together",
                    name(origin),
                    quoted(&parts[0].name),
                    name(first),
                    serde_json::Value::from(part.name.as_str())
                );
                faults.push(fault(part, message));
            }
        }
    }
    IngestError::refuse(faults)?;
    Ok(shifts)
}

/// Files that have no time in common with the first and those that meet it, one by one.
pub(super) fn apart(parts: &[Part], axes: &[Vec<f64>]) -> Vec<Fault> {
    let ends: Vec<[f64; 2]> = (axes.iter())
        .map(|axis| [axis.first(), axis.last()].map(|end| end.copied().unwrap_or(f64::NAN)))
        .collect();
    let Some(&[mut from, mut to]) = ends.first() else {
        return Vec::new();
    };
    let mut away: Vec<usize> = (1..parts.len()).collect();
    loop {
        let before = away.len();
        away.retain(|&at| {
            let [begin, end] = ends[at];
            let meets = begin <= to && from <= end;
            if meets {
                (from, to) = (from.min(begin), to.max(end));
            }
            !meets
        });
        if away.len() == before {
            break;
        }
    }
    let told = away.into_iter().map(|at| {
        let [begin, end] = ends[at];
        let message = format!(
            "it goes from {begin} s to {end} s of the first file's time and has none in common with the others, which go from {from} s to {to} s: say what is added to its times under offsets, or send it as a recording of its own"
        );
        fault(&parts[at], message)
    });
    told.collect()
}

fn fault(part: &Part, message: String) -> Fault {
    let place = format!("/files/{}", escape(&part.name));
    Fault::new(
        place,
        code::OTHER_CLOCK,
        format!("{}: {message}", quoted(&part.name)),
    )
}

/// That the files' own seconds are taken for those of one clock.
pub(super) fn one_clock(parts: &[Part]) -> Option<Finding> {
    let is_silent = |part: &&Part| {
        part.offset.is_none()
            && part
                .reading
                .origin
                .is_some_and(|of| of.is_of(ClockKind::Own))
    };
    let silent: Vec<String> = parts
        .iter()
        .filter(is_silent)
        .map(|part| quoted(&part.name))
        .collect();
    let message = format!(
        "the times of {} are seconds without a date: they are taken for those of one clock",
        note::listed(silent.iter().cloned())
    );
    let remedy = "say an offset where the clocks differ; it can be estimated as a delay of the channels, too";
    (silent.len() > 1).then(|| note::note(FindingCode::Recognised, message, remedy))
}

/// That times whose zone the file does not say are taken for UTC beside others that are.
pub(super) fn one_zone(parts: &[Part]) -> Option<Finding> {
    let of = |clock: ClockKind| {
        let is_of = move |part: &&Part| {
            part.offset.is_none() && part.reading.origin.is_some_and(|of| of.is_of(clock))
        };
        parts.iter().filter(is_of)
    };
    let names: Vec<String> = of(ClockKind::Instant)
        .map(|part| quoted(&part.name))
        .collect();
    let is_mixed = !names.is_empty() && of(ClockKind::Utc).next().is_some();
    let message = format!(
        "the times of {} are taken for UTC, as those of the others are",
        note::listed(names.into_iter())
    );
    let remedy = "say an offset where they are of another zone";
    is_mixed.then(|| note::note(FindingCode::Recognised, message, remedy))
}
