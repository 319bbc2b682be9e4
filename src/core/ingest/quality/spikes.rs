//! Single samples far out, and raw samples at the ends of a piece without gaps.
//!
//! Both are seen in second differences `d[k] = x[k-1] - 2 x[k] + x[k+1]`, which do not see offset and
//! trend, against their median absolute deviation, which does not see the spikes themselves.
//! A spike of height h is h·(1, -2, 1) there, a step is (1, -1), the corner of a ramp is (1): the
//! pattern tells a spike from a control input, however large that is.

use std::ops::Range;

use crate::flight::{Finding, Severity};

use super::finding::finding;

/// Heights beyond this many standard deviations of the second difference are spikes. Set on recorded
/// maneuvers: control inputs and turbulence in them stay below, what is known to be false is above.
const INSIDE: f64 = 8.0;
/// At the ends there is one neighbour only and no pattern to look for.
const AT_ENDS: f64 = 12.0;
/// Filters and differentiators spoil up to this many samples at each end.
const END: usize = 3;
/// Samples on each side that the local noise is taken from.
const NEIGHBOURS: usize = 25;
/// Shorter pieces do not tell what is usual.
const SHORTEST: usize = 20;
/// From median absolute deviation to standard deviation, normally distributed.
const MAD_TO_SIGMA: f64 = 1.4826;

pub(super) fn spikes(name: &str, values: &[f64], segments: &[Range<usize>]) -> Option<Finding> {
    let mut rows = Vec::new();
    for segment in segments {
        let Some(piece) = values.get(segment.clone()).and_then(Piece::of) else {
            continue;
        };
        let mut found: Vec<usize> = piece.inside().chain(piece.at_ends()).collect();
        found.sort_unstable();
        found.dedup();
        rows.extend(found.into_iter().map(|k| k + segment.start));
    }
    if rows.is_empty() {
        return None;
    }
    let message = format!(
        "{} sample(s) lie far from their neighbours, measured by the channel's own noise",
        rows.len()
    );
    Some(finding(
        "spikes",
        Severity::Warning,
        Some(name),
        &rows,
        message,
        "cut these rows at the ends of the recording; inside it, make the cells empty or interpolate",
    ))
}

/// One piece between gaps, with what is usual in it.
struct Piece<'a> {
    values: &'a [f64],
    /// Second differences; NaN at both ends.
    second: Vec<f64>,
    /// Their usual size over the whole piece: 0 for a signal that mostly stands still.
    usual: f64,
    /// The smallest size that means anything: usual noise, quantisation, rounding.
    floor: f64,
}

impl<'a> Piece<'a> {
    /// `None` where nothing can be said: too short, or never changing.
    fn of(values: &'a [f64]) -> Option<Self> {
        if values.len() < SHORTEST {
            return None;
        }
        let mut second = vec![f64::NAN; values.len()];
        for (k, triple) in values.windows(3).enumerate() {
            second[k + 1] = triple[0] - 2.0 * triple[1] + triple[2];
        }
        let usual = MAD_TO_SIGMA * median_size(second.iter().copied()).unwrap_or(0.0);
        let largest = values
            .iter()
            .fold(0.0, |largest: f64, v| largest.max(v.abs()));
        let floor = usual.max(quantum(values)?).max(1e-9 * largest);
        Some(Self {
            values,
            second,
            usual,
            floor,
        })
    }

    /// The noise around sample `k`, without what the sample itself does.
    fn noise(&self, k: usize) -> f64 {
        let around = k.saturating_sub(NEIGHBOURS)..(k + NEIGHBOURS + 1).min(self.second.len());
        let others = around
            .filter(|&other| other.abs_diff(k) > 2)
            .map(|other| self.second[other]);
        let local = MAD_TO_SIGMA * median_size(others).unwrap_or(0.0);
        local.max(self.floor)
    }

    fn inside(&self) -> impl Iterator<Item = usize> {
        (2..self.values.len() - 2).filter(|&k| {
            let height = self.height(k);
            height > INSIDE * self.floor && self.is_single(k) && height > INSIDE * self.noise(k)
        })
    }

    /// How far sample `k` stands out above (or below) both neighbours; 0 if it lies between them.
    fn height(&self, k: usize) -> f64 {
        let before = self.values[k] - self.values[k - 1];
        let behind = self.values[k] - self.values[k + 1];
        if before * behind > 0.0 {
            before.abs().min(behind.abs())
        } else {
            0.0
        }
    }

    /// Whether the neighbours bend the other way, as (1, -2, 1) does; the tip of a ramp does not.
    fn is_single(&self, k: usize) -> bool {
        let bend = self.second[k];
        let opposite = |other: f64| other * bend < 0.0 && other.abs() >= 0.25 * bend.abs();
        opposite(self.second[k - 1]) && opposite(self.second[k + 1])
    }

    /// Samples at the ends that do not continue the interior.
    fn at_ends(&self) -> impl Iterator<Item = usize> {
        let last = self.values.len() - 1;
        // Going outwards, the first sample that breaks away spoils those behind it.
        let outwards = (0..END).rev();
        let first_bad = outwards.clone().find(|&k| self.breaks_away(k + 1, k + 3));
        let last_bad = outwards
            .clone()
            .find(|&k| self.breaks_away(last - k - 1, last - k - 3));
        let front = first_bad.map_or(0..0, |k| 0..k + 1);
        let back = last_bad.map_or(0..0, |k| last - k..last + 1);
        front.chain(back)
    }

    fn breaks_away(&self, bend: usize, noise_around: usize) -> bool {
        // A signal that stands still and then moves has no noise to be measured by.
        self.usual > 0.0 && self.second[bend].abs() > AT_ENDS * self.noise(noise_around)
    }
}

/// A change as small as the smaller ones of the channel: its quantisation if it has one.
fn quantum(values: &[f64]) -> Option<f64> {
    let mut changes: Vec<f64> = values
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .filter(|change| *change > 0.0)
        .collect();
    if changes.is_empty() {
        return None;
    }
    let tenth = changes.len() / 10;
    Some(*changes.select_nth_unstable_by(tenth, f64::total_cmp).1)
}

fn median_size(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sizes: Vec<f64> = values
        .map(f64::abs)
        .filter(|size| size.is_finite())
        .collect();
    if sizes.is_empty() {
        return None;
    }
    let middle = sizes.len() / 2;
    Some(*sizes.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::super::tests::noise;
    use super::*;

    fn rows(values: &[f64]) -> Vec<usize> {
        let whole = std::slice::from_ref(&(0..values.len())).to_vec();
        spikes("q", values, &whole).map_or(Vec::new(), |finding| finding.rows)
    }

    fn noisy(signal: impl Fn(usize) -> f64) -> Vec<f64> {
        (0..400).map(|k| signal(k) + 0.01 * noise(k)).collect()
    }

    #[test]
    fn single_samples_far_out_are_seen() {
        let mut values = noisy(|k| (k as f64 * 0.05).sin());
        values[100] += 0.3;
        values[222] -= 0.3;
        assert_eq!(rows(&values), [101, 223]);
        values[300] = f64::NAN;
        assert_eq!(rows(&values), [101, 223]);
    }

    #[test]
    fn raw_samples_at_the_ends_are_seen() {
        let mut values = noisy(|k| (k as f64 * 0.05).sin());
        values[0] += 0.5;
        let last = values.len() - 1;
        values[last - 1] += 0.5;
        assert_eq!(rows(&values), [1, last, last + 1]);
    }

    #[test]
    fn a_spike_in_a_signal_at_rest_is_seen() {
        let mut values = vec![0.0; 100];
        for k in [20, 40, 60] {
            values[k..k + 10].fill(1.0);
        }
        assert_eq!(rows(&values), [0usize; 0], "pulses are no spikes");
        values[85] = 50.0;
        assert_eq!(rows(&values), [86]);
    }

    #[test]
    fn steps_ramps_and_doublets_are_none() {
        let nothing = [0usize; 0];
        assert_eq!(rows(&noisy(|k| if k < 200 { 0.0 } else { 5.0 })), nothing);
        let doublet = |k: usize| match k {
            100..125 => 5.0,
            125..150 => -5.0,
            _ => 0.0,
        };
        assert_eq!(rows(&noisy(doublet)), nothing);
        let triangle = |k: usize| 5.0 - (k as f64 - 200.0).abs().min(5.0);
        assert_eq!(rows(&noisy(triangle)), nothing);
        let quantised = |k: usize| (10.0 * (k as f64 * 0.05).sin()).round();
        let quantised: Vec<f64> = (0..400).map(quantised).collect();
        assert_eq!(rows(&quantised), nothing);
    }
}
