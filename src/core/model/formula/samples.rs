//! What is done sample by sample: missing samples filled, repeated ones left out, angles unwrapped, channels delayed.

use std::f64::consts::PI;

use crate::flight::GAP_FACTOR;

/// The values that are there.
pub(super) fn present(values: &[f64]) -> impl Iterator<Item = f64> + Clone + '_ {
    values.iter().copied().filter(|value| !value.is_nan())
}

/// The largest rate of change, up or down, from one value that is there to the next.
pub(super) fn largest_rate(time: &[f64], values: &[f64]) -> f64 {
    let known = time.iter().zip(values).filter(|(_, value)| !value.is_nan());
    let known: Vec<(&f64, &f64)> = known.collect();
    let rate = |pair: &[(&f64, &f64)]| ((pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0)).abs();
    known.windows(2).map(rate).fold(f64::NAN, f64::max)
}

/// Missing values on straight lines in time between their neighbours; before the first and behind the last
/// value nothing is known, and nothing is filled in.
pub(super) fn interpolated(time: &[f64], mut values: Vec<f64>) -> Vec<f64> {
    let mut known: Option<usize> = None;
    for k in 0..values.len() {
        if values[k].is_nan() {
            continue;
        }
        if let Some(before) = known {
            for between in before + 1..k {
                let share = (time[between] - time[before]) / (time[k] - time[before]);
                values[between] = (1.0 - share) * values[before] + share * values[k];
            }
        }
        known = Some(k);
    }
    values
}

/// A missing value is the one before.
pub(super) fn held(mut values: Vec<f64>) -> Vec<f64> {
    let mut last = f64::NAN;
    for value in &mut values {
        if value.is_nan() {
            *value = last;
        }
        last = *value;
    }
    values
}

/// Only values that differ from the one before.
pub(super) fn fresh(mut values: Vec<f64>) -> Vec<f64> {
    let mut last = f64::NAN;
    for value in &mut values {
        if value.is_nan() {
            continue;
        }
        if *value == last {
            *value = f64::NAN;
        } else {
            last = *value;
        }
    }
    values
}

/// An angle in radians without jumps of more than half a turn.
pub(super) fn unwrapped(mut values: Vec<f64>) -> Vec<f64> {
    let mut last = f64::NAN;
    let mut turns = 0.0;
    for value in &mut values {
        if !value.is_finite() {
            continue;
        }
        let jump = *value - last;
        if jump.abs() > PI {
            turns -= (jump / (2.0 * PI)).round();
        }
        last = *value;
        *value += 2.0 * PI * turns;
    }
    values
}

/// The parts of a channel between its gaps, as rows in which it has values. A gap is more than [`GAP_FACTOR`] times as long as
/// the usual step from value to value, which is the second.
pub(super) fn parts(time: &[f64], values: &[f64]) -> (Vec<Vec<usize>>, f64) {
    let rows: Vec<usize> = (0..values.len())
        .filter(|&k| values[k].is_finite())
        .collect();
    let mut steps: Vec<f64> = rows
        .windows(2)
        .map(|pair| time[pair[1]] - time[pair[0]])
        .collect();
    if steps.is_empty() {
        return (Vec::new(), f64::NAN);
    }
    let middle = steps.len() / 2;
    let usual = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let is_near = |a: &usize, b: &usize| time[*b] - time[*a] <= GAP_FACTOR * usual;
    let parts = rows.chunk_by(is_near).map(<[usize]>::to_vec).collect();
    (parts, usual)
}

/// What the channel was `delay` seconds before each of its samples, on straight lines; missing where that is before its first
/// sample, or in a gap.
pub(super) fn delayed(time: &[f64], values: &[f64], delay: f64) -> Vec<f64> {
    let mut delayed = vec![f64::NAN; values.len()];
    let (parts, _) = parts(time, values);
    for part in parts {
        let last = part.len() - 1;
        // times are sums of steps: so little is nothing
        let nothing = 1e-9 * (time[part[last]] - time[part[0]]);
        for &row in &part {
            let at = time[row] - delay;
            let behind = part.partition_point(|&k| time[k] < at - nothing);
            let Some(&next) = part.get(behind) else {
                continue;
            };
            delayed[row] = if (time[next] - at).abs() <= nothing {
                values[next]
            } else if behind > 0 {
                let before = part[behind - 1];
                let share = (at - time[before]) / (time[next] - time[before]);
                (1.0 - share) * values[before] + share * values[next]
            } else {
                f64::NAN
            };
        }
    }
    delayed
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAN: f64 = f64::NAN;

    fn shown(values: &[f64]) -> Vec<Option<f64>> {
        values.iter().map(|&v| (!v.is_nan()).then_some(v)).collect()
    }

    #[test]
    fn missing_values_are_filled_in_as_said() {
        let sparse = vec![NAN, 1.0, NAN, NAN, 5.0, NAN];
        let time = [0.0, 1.0, 2.0, 4.0, 5.0, 6.0];
        let some = [None, Some(1.0), Some(2.0), Some(4.0), Some(5.0), None];
        assert_eq!(shown(&interpolated(&time, sparse.clone())), some);
        let some = [None, Some(1.0), Some(1.0), Some(1.0), Some(5.0), Some(5.0)];
        assert_eq!(shown(&held(sparse)), some);
    }

    #[test]
    fn only_values_that_change_are_fresh() {
        let held = vec![1.0, 1.0, NAN, 1.0, 2.0, 2.0, 1.0];
        let some = [Some(1.0), None, None, None, Some(2.0), None, Some(1.0)];
        assert_eq!(shown(&fresh(held)), some);
    }

    #[test]
    fn angles_are_unwrapped_over_several_turns_and_missing_samples() {
        let angles: Vec<f64> = (0..200).map(|k| f64::from(k) * -0.1 + 3.0).collect();
        let mut wrapped: Vec<f64> = angles.iter().map(|a| a.sin().atan2(a.cos())).collect();
        wrapped[40] = NAN;
        for (k, (unwrapped, angle)) in unwrapped(wrapped).iter().zip(&angles).enumerate() {
            assert!(k == 40 || (unwrapped - angle).abs() < 1e-12, "{k}");
        }
        // from 0 to 2 pi, by more than one turn between samples
        let turns = unwrapped(vec![0.0, 6.2, 0.1, 2.0 * PI * 3.0 + 0.2]);
        for (found, expected) in turns.iter().zip([0.0, 6.2 - 2.0 * PI, 0.1, 0.2]) {
            assert!((found - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn a_delay_shifts_by_its_time_on_straight_lines() {
        let time: Vec<f64> = (0..6).map(|k| f64::from(k) * 0.1).collect();
        let ramp: Vec<f64> = time.iter().map(|t| 10.0 * t).collect();
        let late = delayed(&time, &ramp, 0.15);
        assert_eq!(shown(&late)[..2], [None, None]);
        for k in 2..6 {
            assert!((late[k] - (ramp[k] - 1.5)).abs() < 1e-12);
        }
        let early = delayed(&time, &ramp, -0.2);
        assert!((early[3] - 5.0).abs() < 1e-12 && early[4].is_nan());
        let by_a_step = delayed(&time, &[7.0, 3.0, NAN, 2.0, 8.0, 1.0], 0.1);
        assert_eq!(by_a_step[1], 7.0);
        assert!(by_a_step[2].is_nan(), "it has no sample there");
        // not across a gap
        let gap = [0.0, 0.1, 0.2, 5.0, 5.1];
        let late = delayed(&gap, &[1.0, 2.0, 3.0, 4.0, 5.0], 0.1);
        assert_eq!(shown(&late).iter().flatten().count(), 3);
        assert!(late[3].is_nan());
    }
}
