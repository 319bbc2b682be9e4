//! Channels of a lower rate that were held up to the rate of the others.
//!
//! A channel that is new in every n-th row only, and repeated in between, changes at rows of a grid, and brings a new value
//! at nearly every one of them. A quantised signal changes at any row, a command rests for long and has few values.

use std::ops::Range;

use crate::flight::{Finding, FindingCode, is_control};

use super::record::Series;

/// Grids of more rows than this are slow channels of another kind: fuel, a counter.
const WIDEST: usize = 100;
/// So many changes tell a grid from chance.
const LEAST_CHANGES: usize = 12;
/// So many values tell a measured channel from a command of a few levels.
const LEAST_VALUES: usize = 8;
/// The share of changes that must be one grid step apart, or a row more or less where rates do not divide.
const ALONG_GRID: f64 = 0.9;

/// The rows between new values; `None` where the channel is not held.
pub(super) fn grid(values: &[f64], segments: &[Range<usize>]) -> Option<f64> {
    let mut runs: Vec<usize> = Vec::new();
    let (mut rises, mut falls) = (false, false);
    let mut levels = std::collections::HashSet::new();
    for segment in segments {
        let mut change: Option<usize> = None;
        for k in segment.start + 1..segment.end {
            if values[k] == values[k - 1] || values[k].is_nan() || values[k - 1].is_nan() {
                continue;
            }
            if let Some(before) = change {
                runs.push(k - before);
            }
            levels.insert(values[k].to_bits());
            rises |= values[k] > values[k - 1];
            falls |= values[k] < values[k - 1];
            change = Some(k);
        }
    }
    // what only rises or only falls is a counter, or fuel: nothing that a fit would count twice
    let counts = !(rises && falls);
    if counts || runs.len() < LEAST_CHANGES || levels.len() < LEAST_VALUES {
        return None;
    }
    let mut sorted = runs.clone();
    sorted.sort_unstable();
    // the grid's step is what most runs are long; a value that happens to stay the same makes one of twice the length
    let step = sorted[sorted.len() / 4];
    if !(2..=WIDEST).contains(&step) {
        return None;
    }
    // where the rates do not divide, runs are a row longer now and then; one in two rows leaves no room for that
    let slack = usize::from(step > 2);
    let is_step = |run: &usize| run.abs_diff(step) <= slack;
    let single: Vec<&usize> = runs.iter().filter(|run| is_step(run)).collect();
    let on_grid = runs.iter().filter(|run| {
        let steps = (**run + step / 2) / step;
        steps >= 1 && run.abs_diff(steps * step) <= slack * steps
    });
    let all = runs.len() as f64;
    if (single.len() as f64) < 0.6 * all || (on_grid.count() as f64) < ALONG_GRID * all {
        return None;
    }
    Some(single.iter().copied().sum::<usize>() as f64 / single.len() as f64)
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
        true => format!("every {}", ordinal(grid.round() as usize)),
        false => format!("one of {grid:.2}"),
    };
    let message = format!(
        "it is new in {every} row only ({:.4} Hz in a recording of {:.4} Hz) and repeated in between: late by {:.3} s on average, and counted {:.1} times",
        1.0 / (grid * step),
        1.0 / step,
        (grid - 1.0) / 2.0 * step,
        grid
    );
    let remedy = match is_control(name) {
        true => format!(
            "where a recorder held a slower channel, say \"channels\": {{\"{name}\": \"interpolated(fresh({name}))\"}} (-c \"{name}=interpolated(fresh({name}))\"); where a computer moves it in such steps, say \"input_interpolation\": \"hold\""
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
