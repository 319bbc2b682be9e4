//! How a recording was sampled: its step, whether that is even, and where it has gaps.

use std::ops::Range;

/// A step longer than this many usual steps is a gap: the recording stopped and started again.
pub const GAP_FACTOR: f64 = 5.0;

/// Steps that differ from the usual one by less than this share are rounding of the time column.
const EVEN_WITHIN: f64 = 0.02;

/// The time axis of a recording, described.
#[derive(Clone, PartialEq, Debug)]
pub struct Sampling {
    /// The usual (median) step, s; that of the tables of a recording, where these follow each other closely.
    pub step: f64,
    /// Whether all steps but the gaps equal the usual one, up to rounding of the time column.
    pub even: bool,
    /// Where the recording stopped and started again: steps above [`GAP_FACTOR`] usual ones.
    pub gaps: Vec<Gap>,
    samples: usize,
}

/// A place where the recording stopped and started again.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Gap {
    /// Index (from 0) of the first sample behind the gap.
    pub before: usize,
    /// Length of the gap, s.
    pub duration: f64,
}

impl Sampling {
    /// Looks at a strictly increasing time axis of at least two samples.
    ///
    /// Where channels of several tables were recorded together, each a moment after the other, most steps are short, and the
    /// long ones are no gaps: the usual step is then that of the channel with the highest rate.
    pub(super) fn of<'a>(time: &[f64], channels: impl Iterator<Item = &'a [f64]>) -> Self {
        let steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let mut sorted = steps.clone();
        sorted.sort_by(f64::total_cmp);
        let median = sorted[sorted.len() / 2];
        let long = sorted.len() - sorted.partition_point(|&step| step <= GAP_FACTOR * median);
        let median = if long >= MANY && long * MANY_IN >= sorted.len() {
            shortest_usual_step(time, channels).map_or(median, |step| step.max(median))
        } else {
            median
        };
        let is_gap = |step: f64| step > GAP_FACTOR * median;
        let gaps: Vec<Gap> = steps
            .iter()
            .enumerate()
            .filter(|&(_, &step)| is_gap(step))
            .map(|(i, &duration)| Gap {
                before: i + 1,
                duration,
            })
            .collect();
        let even = steps
            .iter()
            .all(|&step| is_gap(step) || (step - median).abs() <= EVEN_WITHIN * median);
        let step = if even {
            mean_step(&steps, &is_gap)
        } else {
            median
        };
        Self {
            step,
            even,
            gaps,
            samples: time.len(),
        }
    }

    /// The stretches between gaps, as ranges of sample indices.
    pub fn segments(&self) -> Vec<Range<usize>> {
        let starts = std::iter::once(0).chain(self.gaps.iter().map(|gap| gap.before));
        let ends = self
            .gaps
            .iter()
            .map(|gap| gap.before)
            .chain(std::iter::once(self.samples));
        starts.zip(ends).map(|(start, end)| start..end).collect()
    }
}

/// The shortest of the usual steps of channels without a value at some times; `None` where there are no such channels.
fn shortest_usual_step<'a>(time: &[f64], channels: impl Iterator<Item = &'a [f64]>) -> Option<f64> {
    let sparse = channels.filter(|values| values.iter().any(|value| value.is_nan()));
    let usual = sparse.filter_map(|values| {
        let rows: Vec<usize> = (0..values.len()).filter(|&k| !values[k].is_nan()).collect();
        let steps = rows.windows(2).map(|pair| time[pair[1]] - time[pair[0]]);
        let mut steps: Vec<f64> = steps.collect();
        let middle = steps.len() / 2;
        (middle < steps.len()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
    });
    usual.min_by(f64::total_cmp)
}

/// Gaps are usually fewer than this, or fewer than one in so many steps.
const MANY: usize = 10;
const MANY_IN: usize = 20;

/// The mean averages rounding of the time column away, but for that of its ends. Within what that leaves
/// open the roundest number is meant: 0.1 s, not 0.100000033 s.
fn mean_step(steps: &[f64], is_gap: &impl Fn(f64) -> bool) -> f64 {
    let kept: Vec<f64> = steps
        .iter()
        .copied()
        .filter(|&step| !is_gap(step))
        .collect();
    let mean = kept.iter().sum::<f64>() / kept.len() as f64;
    let roughest = kept
        .iter()
        .map(|step| (step - mean).abs())
        .fold(0.0, f64::max);
    let stretches = (steps.len() - kept.len() + 1) as f64;
    let open = 2.0 * roughest * stretches / kept.len() as f64 + 1e-12 * mean;
    let rounded = (0..12).map(|digits| {
        let unit = 10_f64.powi(digits);
        (mean * unit).round() / unit
    });
    rounded
        .into_iter()
        .find(|rounded| (rounded - mean).abs() <= open)
        .unwrap_or(mean)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_gap_and_the_segments() {
        let time: Vec<f64> = (0..10)
            .map(|k| f64::from(k) * 0.04 + if k >= 6 { 30.0 } else { 0.0 })
            .collect();
        let sampling = Sampling::of(&time, std::iter::empty());
        assert_eq!(sampling.step, 0.04);
        assert!(sampling.even);
        assert_eq!(sampling.segments(), vec![0..6, 6..10]);
        assert!((sampling.gaps[0].duration - 30.04).abs() < 1e-9);
    }

    #[test]
    fn tables_that_follow_each_other_closely_leave_no_gaps() {
        // five tables at 50 Hz, each 0.1 ms after the other; a pause of 3 s in the middle
        let time: Vec<f64> = (0..500)
            .map(|k| f64::from(k / 5) * 0.02 + f64::from(k % 5) * 1e-4)
            .map(|t| if t > 1.0 { t + 3.0 } else { t })
            .collect();
        let table = |n: usize| -> Vec<f64> {
            (0..500)
                .map(|k| if k % 5 == n { 1.0 } else { f64::NAN })
                .collect()
        };
        let (first, third, held) = (table(0), table(2), vec![1.0; 500]);
        let channels = [&first[..], &third, &held];
        let sampling = Sampling::of(&time, channels.into_iter());
        assert_eq!(sampling.gaps.len(), 1);
        assert!((sampling.step - 0.02).abs() < 1e-9, "{}", sampling.step);
        // a recording that was stopped every few samples has channels that are complete
        assert!(Sampling::of(&time, [&held[..]].into_iter()).gaps.len() > 90);
    }

    #[test]
    fn rounding_of_the_time_column_is_not_unevenness() {
        let rounded: Vec<f64> = (0..100)
            .map(|k| (f64::from(k) * 0.1 * 1e5).round() / 1e5 + f64::from(k % 2) * 1e-5)
            .collect();
        assert!(Sampling::of(&rounded, std::iter::empty()).even);
        assert_eq!(Sampling::of(&rounded, std::iter::empty()).step, 0.1);
        let uneven: Vec<f64> = (0..100)
            .map(|k| f64::from(k) * 0.1 + f64::from(k % 3) * 0.01)
            .collect();
        assert!(!Sampling::of(&uneven, std::iter::empty()).even);
    }
}
