//! Several time axes become one: every time that any of them has, and no value where a channel has none.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::flight::Fault;

use super::Limits;

/// What a channel has where it has no sample of its own.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Between {
    /// No value.
    #[default]
    Missing,
    /// The value before, as an input that a computer holds.
    Held,
    /// A straight line from the value before to the one behind.
    Straight,
}

impl Between {
    pub(super) fn is_missing(&self) -> bool {
        *self == Self::Missing
    }
}

/// Times of different axes that differ by less than this share of the shortest usual step are one.
const SAME_WITHIN: f64 = 1e-3;

/// A common time axis.
pub(super) struct Union {
    /// Seconds, strictly increasing.
    pub(super) time: Vec<f64>,
    /// Of every axis: where each of its times is in the common one.
    pub(super) places: Vec<Vec<u32>>,
}

impl Union {
    /// Of axes in seconds, each strictly increasing. Where times of several are one, that of the first of them holds.
    ///
    /// # Errors
    /// There are more times in all than the limit of samples.
    pub(super) fn of(axes: &[Vec<f64>], limits: &Limits) -> Result<Self, Fault> {
        let same = SAME_WITHIN * shortest_step(axes);
        let mut all: Vec<(f64, u32)> = Vec::with_capacity(axes.iter().map(Vec::len).sum());
        for (axis, times) in (0u32..).zip(axes) {
            all.extend(times.iter().map(|&time| (time, axis)));
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut places: Vec<Vec<u32>> = axes
            .iter()
            .map(|axis| Vec::with_capacity(axis.len()))
            .collect();
        let mut time: Vec<f64> = Vec::new();
        // of the time that is being put together: where it begins, and the first axis in it
        let mut begin = f64::NEG_INFINITY;
        let mut first = u32::MAX;
        for (at, axis) in all {
            let last = time.len().wrapping_sub(1) as u32;
            let is_new = at - begin > same || places[axis as usize].last() == Some(&last);
            if is_new {
                if let Some(fault) = limits.samples(time.len() + 1) {
                    return Err(fault);
                }
                time.push(at);
                (begin, first) = (at, axis);
            } else if axis < first {
                first = axis;
                if let Some(last) = time.last_mut() {
                    *last = at;
                }
            }
            places[axis as usize].push((time.len() - 1) as u32);
        }
        Ok(Self { time, places })
    }

    /// The values of a channel on an axis, at their places in the common one; NaN at the others.
    pub(super) fn spread(&self, axis: usize, values: &[f64]) -> Vec<f64> {
        let mut spread = vec![f64::NAN; self.time.len()];
        for (&place, &value) in self.places[axis].iter().zip(values) {
            spread[place as usize] = value;
        }
        spread
    }
}

/// The shortest of the usual (median) steps.
fn shortest_step(axes: &[Vec<f64>]) -> f64 {
    let median = |times: &Vec<f64>| {
        let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let middle = steps.len() / 2;
        (middle < steps.len()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
    };
    let shortest = axes.iter().filter_map(median).fold(f64::INFINITY, f64::min);
    if shortest.is_finite() { shortest } else { 0.0 }
}

/// Fills values in between those that there are, as a mapping says; before the first one, and for straight lines behind the
/// last one, nothing is known, and nothing is filled in.
pub(super) fn fill(between: Between, time: &[f64], values: &mut [f64]) {
    let mut before: Option<usize> = None;
    for k in 0..values.len() {
        if values[k].is_nan() {
            if let (Between::Held, Some(before)) = (between, before) {
                values[k] = values[before];
            }
            continue;
        }
        if let (Between::Straight, Some(before)) = (between, before) {
            for at in before + 1..k {
                let share = (time[at] - time[before]) / (time[k] - time[before]);
                values[at] = (1.0 - share) * values[before] + share * values[k];
            }
        }
        before = Some(k);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAN: f64 = f64::NAN;

    fn union(axes: &[Vec<f64>]) -> Union {
        Union::of(axes, &Limits::default()).unwrap()
    }

    #[test]
    fn every_channel_keeps_its_own_samples() {
        let fast: Vec<f64> = (0..6).map(|k| f64::from(k) * 0.02).collect();
        let slow = vec![0.0, 0.04 + 1e-6, 0.07];
        let union = union(&[fast.clone(), slow]);
        let expected = [0.0, 0.02, 0.04, 0.06, 0.07, 0.08, 0.1];
        assert_eq!(union.time.len(), expected.len());
        for (found, expected) in union.time.iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-12,
                "that of the first axis holds"
            );
        }
        let spread = union.spread(1, &[1.0, 2.0, 3.0]);
        let there: Vec<usize> = (0..7).filter(|&k| !spread[k].is_nan()).collect();
        assert_eq!(there, [0, 2, 4]);
        assert_eq!(union.spread(0, &fast)[5], fast[4]);
    }

    #[test]
    fn times_of_one_axis_are_never_one() {
        // two samples in a burst, closer together than times of different axes may be
        let bursts = vec![0.0, 1.0, 1.000_1, 2.0];
        let other = vec![0.0, 1.0, 2.0, 3.0];
        let union = union(&[bursts, other]);
        assert_eq!(union.time, [0.0, 1.0, 1.000_1, 2.0, 3.0]);
        assert!(union.time.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn the_limit_of_samples_holds_for_all_together() {
        let axes: Vec<Vec<f64>> = (0..3)
            .map(|axis| {
                (0..4)
                    .map(|k| f64::from(k) + f64::from(axis) * 0.3)
                    .collect()
            })
            .collect();
        let limits = Limits {
            max_samples: 11,
            ..Limits::default()
        };
        assert!(Union::of(&axes, &limits).is_err());
        assert_eq!(union(&axes).time.len(), 12);
        assert_eq!(union(&[Vec::new(), vec![1.0]]).time, [1.0]);
    }

    #[test]
    fn values_in_between_are_held_or_straight_as_said() {
        let time = [0.0, 1.0, 2.0, 4.0, 5.0];
        let sparse = [NAN, 1.0, NAN, 4.0, NAN];
        let filled = |between| {
            let mut values = sparse;
            fill(between, &time, &mut values);
            values.map(|value| if value.is_nan() { -1.0 } else { value })
        };
        assert_eq!(filled(Between::Missing), [-1.0, 1.0, -1.0, 4.0, -1.0]);
        assert_eq!(filled(Between::Held), [-1.0, 1.0, 1.0, 4.0, 4.0]);
        assert_eq!(filled(Between::Straight), [-1.0, 1.0, 2.0, 4.0, -1.0]);
    }
}
