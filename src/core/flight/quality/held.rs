//! Channels of a lower rate that were held up to the rate of the others.
//!
//! A channel that is new in every n-th row only, and repeated in between, changes at rows of a grid, and brings a new value
//! at nearly every one of them. A quantised signal changes at any row, a command rests for long and has few values.

use std::collections::HashSet;
use std::ops::Range;

use crate::flight::convention::is_control;
use crate::flight::{Finding, FindingCode};

use super::record::Series;

/// Grids of more rows than this are slow channels of another kind: fuel, a counter.
const WIDEST: usize = 100;
/// So many changes tell a grid from chance.
const LEAST_CHANGES: usize = 12;
/// So many values tell a measured channel from a command of a few levels.
const LEAST_VALUES: usize = 8;
/// The share of changes that must be one step of the grid apart, to a row.
const SINGLE: f64 = 0.6;
/// The share of changes that must lie on the grid, and to within how many rows: where rates do not divide, the nearest row.
const ALONG_GRID: f64 = 0.97;
const OFF_GRID: f64 = 0.75;

/// The rows between new values; `None` where the channel is not held.
pub(super) fn grid(values: &[f64], segments: &[Range<usize>]) -> Option<f64> {
    let changes: Vec<Vec<usize>> = (segments.iter())
        .map(|segment| changes(values, segment.clone()))
        .collect();
    let all = || changes.iter().flatten().copied();
    let levels: HashSet<u64> = all().map(|k| values[k].to_bits()).collect();
    // what only rises or only falls is a counter, or fuel: nothing that a fit would count twice
    let rises = all().filter(|&k| values[k] > values[k - 1]).count();
    if rises == 0 || rises == all().count() || levels.len() < LEAST_VALUES {
        return None;
    }
    let mut runs: Vec<usize> = (changes.iter())
        .flat_map(|rows| rows.windows(2))
        .map(|pair| pair[1] - pair[0])
        .collect();
    if runs.len() < LEAST_CHANGES {
        return None;
    }
    runs.sort_unstable();
    // the grid's step is what most runs are long; a value that happens to stay the same makes one of twice the length
    let usual = runs[runs.len() / 4];
    if !(2..=WIDEST).contains(&usual) {
        return None;
    }
    let single: Vec<usize> = runs
        .iter()
        .copied()
        .filter(|run| run.abs_diff(usual) <= 1)
        .collect();
    if (single.len() as f64) < SINGLE * runs.len() as f64 {
        return None;
    }
    let step = single.iter().sum::<usize>() as f64 / single.len() as f64;
    along(&changes, step)
}

/// The rows of a segment at which a series changes.
fn changes(values: &[f64], segment: Range<usize>) -> Vec<usize> {
    let is_new = |k: &usize| {
        let (before, now) = (values[k - 1], values[*k]);
        now != before && !now.is_nan() && !before.is_nan()
    };
    (segment.start + 1..segment.end).filter(is_new).collect()
}

/// The grid of least squares through the changes, where they lie on one to within a row.
fn along(changes: &[Vec<usize>], step: f64) -> Option<f64> {
    let counted = |rows: &Vec<usize>| -> Vec<(f64, f64)> {
        let mut number = 0.0;
        let mut before = rows.first().copied().unwrap_or(0);
        let place = |&row: &usize| {
            number += ((row - before) as f64 / step).round();
            before = row;
            (number, row as f64)
        };
        let places: Vec<(f64, f64)> = rows.iter().map(place).collect();
        let count = places.len() as f64;
        let sum = places
            .iter()
            .fold((0.0, 0.0), |sum, place| (sum.0 + place.0, sum.1 + place.1));
        let centred = places
            .iter()
            .map(|place| (place.0 - sum.0 / count, place.1 - sum.1 / count));
        centred.collect()
    };
    let places: Vec<Vec<(f64, f64)>> = changes.iter().map(counted).collect();
    let all = || places.iter().flatten();
    let grid = all().map(|(k, row)| k * row).sum::<f64>() / all().map(|(k, _)| k * k).sum::<f64>();
    let on_grid = all()
        .filter(|(k, row)| (row - grid * k).abs() <= OFF_GRID)
        .count();
    (on_grid as f64 >= ALONG_GRID * all().count() as f64).then_some(grid)
}

/// That a channel is held, with its grid.
pub(super) fn held(series: &Series<'_>, segments: &[Range<usize>], step: f64) -> Option<Finding> {
    let grid = grid(&series.values, segments)?;
    Some(finding(series.name, &series.values, grid, step))
}

fn finding(name: &str, values: &[f64], grid: f64, step: f64) -> Finding {
    let rows: Vec<usize> = (1..values.len())
        .filter(|&k| values[k] == values[k - 1])
        .collect();
    let every = match (grid - grid.round()).abs() < 0.02 {
        true => format!("every {} row", ordinal(grid.round() as usize)),
        false => format!("one of {grid:.2} rows"),
    };
    let message = format!(
        "it is new in {every} only ({:.4} Hz in a recording of {:.4} Hz) and repeated in between: late by {:.3} s on average, and counted {:.1} times",
        1.0 / (grid * step),
        1.0 / step,
        (grid - 1.0) / 2.0 * step,
        grid
    );
    let remedy = match is_control(name) {
        true => format!(
            "where a recorder held a slower channel, say \"channels\": {{\"{name}\": \"held(interpolated(fresh({name})))\"}} (-c \"{name}=held(interpolated(fresh({name})))\"); where a computer moves it in such steps, say \"input_interpolation\": \"hold\""
        ),
        false => format!(
            "say \"channels\": {{\"{name}\": \"fresh({name})\"}} in the job (-c \"{name}=fresh({name})\"): each value counts once, when it was new"
        ),
    };
    Finding::new(FindingCode::HeldChannel, message, remedy)
        .of_channel(name)
        .at_rows(&rows)
}

/// `2nd`, `3rd`, `5th`.
fn ordinal(number: usize) -> String {
    let ending = match (number % 100, number % 10) {
        (11..=13, _) => "th",
        (_, 1) => "st",
        (_, 2) => "nd",
        (_, 3) => "rd",
        _ => "th",
    };
    format!("{number}{ending}")
}

#[cfg(test)]
mod tests {
    use super::super::tests::noise;
    use super::*;

    fn grid_of(values: &[f64]) -> Option<f64> {
        grid(values, std::slice::from_ref(&(0..values.len())))
    }

    fn measured(k: usize) -> f64 {
        (k as f64 * 0.05).sin() + 0.02 * noise(k)
    }

    #[test]
    fn a_channel_of_a_fifth_of_the_rate_is_seen() {
        for n in [2, 3, 5, 10, 40] {
            let values: Vec<f64> = (0..20 * n + 7).map(|k| measured(k / n * n)).collect();
            assert_eq!(grid_of(&values), Some(n as f64), "{n}");
        }
        // 50 Hz of 8 Hz: now six rows, now seven
        let values: Vec<f64> = (0..700)
            .map(|k| measured((k as f64 / 6.25) as usize * 6))
            .collect();
        assert!((grid_of(&values).unwrap() - 6.25).abs() < 0.05);
        // two decimals: some neighbours on the grid are equal
        let values: Vec<f64> = (0..700)
            .map(|k| (measured(k / 5 * 5) * 100.0).round() / 100.0)
            .collect();
        assert!((grid_of(&values).unwrap() - 5.0).abs() < 0.05);
    }

    #[test]
    fn measured_quantised_and_commanded_channels_are_none() {
        assert_eq!(grid_of(&(0..700).map(measured).collect::<Vec<_>>()), None);
        for steps in [2.0, 5.0, 20.0, 100.0] {
            let quantised: Vec<f64> = (0..700).map(|k| (measured(k) * steps).round()).collect();
            assert_eq!(grid_of(&quantised), None, "{steps}");
        }
        let command: Vec<f64> = (0..700)
            .map(|k| f64::from(u8::from(k / 25 % 2 == 0)))
            .collect();
        assert_eq!(grid_of(&command), None);
        let slow: Vec<f64> = (0..700).map(|k| (k as f64 * 0.013).floor()).collect();
        assert_eq!(grid_of(&slow), None, "a counter");
    }
}
