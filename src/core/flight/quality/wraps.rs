//! Angles that jump by half a turn or a turn: a heading that passes north.

use std::f64::consts::PI;

use crate::flight::{Finding, FindingCode};

/// No aircraft turns by this between two samples of a useful rate (500 deg/s at 25 Hz).
const LARGE_STEP: f64 = 20.0 * PI / 180.0;
/// Interpolation by the recorder spreads a jump over a few samples.
const LONGEST: usize = 4;
const WITHIN: f64 = 0.05;

/// Of an angle, rad.
pub(super) fn wraps(name: &str, values: &[f64]) -> Option<Finding> {
    let mut rows = Vec::new();
    let mut size = 0.0;
    let mut row = 1;
    while row < values.len() {
        let (jump, steps) = jump_at(values, row);
        if let Some(turn) = is_wrap(jump, steps) {
            rows.push(row);
            size = turn;
        }
        row += steps.max(1);
    }
    if rows.is_empty() {
        return None;
    }
    let degrees = size.to_degrees().round();
    let message = format!(
        "the angle wraps {} time(s), jumping by {degrees} deg within a few samples",
        rows.len()
    );
    let remedy = format!(
        "say \"channels\": {{\"{name}\": \"unwrap({name})\"}} in the job (-c \"{name}=unwrap({name})\"), or do not use it; samples inside a jump are false"
    );
    let wrap = Finding::new(FindingCode::Wrap, message, remedy);
    Some(wrap.of_channel(name).at_rows(&rows))
}

/// The sum and number of large steps of one direction that begin with the step to `row`.
fn jump_at(values: &[f64], row: usize) -> (f64, usize) {
    let step = |row: usize| values[row] - values[row - 1];
    let direction = step(row).signum();
    let steps = (row..values.len())
        .take_while(|&row| step(row) * direction > LARGE_STEP)
        .count();
    if steps == 0 {
        return (0.0, 0);
    }
    (values[row + steps - 1] - values[row - 1], steps)
}

fn is_wrap(jump: f64, steps: usize) -> Option<f64> {
    if steps > LONGEST {
        return None;
    }
    [PI, 2.0 * PI]
        .into_iter()
        .find(|turn| (jump.abs() - turn).abs() < WITHIN * turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(degrees: &[f64]) -> Vec<usize> {
        let radians: Vec<f64> = degrees.iter().map(|angle| angle.to_radians()).collect();
        wraps("psi", &radians).map_or(Vec::new(), |finding| finding.rows)
    }

    #[test]
    fn sees_sharp_and_interpolated_wraps() {
        assert_eq!(rows(&[358.0, 359.0, 0.5, 1.0, 359.5]), [3, 5]);
        assert_eq!(rows(&[0.2, 0.1, 60.0, 120.0, 179.9, 179.8]), [3]);
    }

    #[test]
    fn a_roll_and_a_step_of_ninety_degrees_are_none() {
        let roll: Vec<f64> = (0..100).map(|k| f64::from(k) * 15.0 - 700.0).collect();
        assert_eq!(rows(&roll), [0usize; 0]);
        assert_eq!(rows(&[0.0, 90.0, 90.0, f64::NAN, 0.0]), [0usize; 0]);
    }
}
