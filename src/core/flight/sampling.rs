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
    /// The tick of a clock that tells time more coarsely than that, s; absent where it does not.
    pub tick: Option<f64>,
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
    pub fn of<'a>(time: &[f64], channels: impl Iterator<Item = &'a [f64]>) -> Self {
        let steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let channels: Vec<&[f64]> = channels.collect();
        let median = usual_step(time, &steps, &channels);
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
        let has_bursts = steps.iter().any(|&step| step * GAP_FACTOR < median);
        let coarse = match even || has_bursts || is_of_tables(time, &channels) {
            true => None,
            false => coarse_clock(time, &gaps),
        };
        let step = match coarse {
            Some((step, _)) => step,
            None if even => mean_step(&steps, &is_gap),
            None => median,
        };
        Self {
            step,
            even: even || coarse.is_some(),
            tick: coarse.map(|(_, tick)| tick),
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

/// The median step; where it leaves many gaps, that of the channels that are not recorded at all times.
fn usual_step(time: &[f64], steps: &[f64], channels: &[&[f64]]) -> f64 {
    let mut sorted = steps.to_vec();
    sorted.sort_by(f64::total_cmp);
    let median = sorted[sorted.len() / 2];
    let long = sorted.len() - sorted.partition_point(|&step| step <= GAP_FACTOR * median);
    if long < MANY || long * MANY_IN < sorted.len() {
        return median;
    }
    let usual = channels.iter().filter_map(|values| {
        let rows = sparse(values)?;
        let steps = rows.windows(2).map(|pair| time[pair[1]] - time[pair[0]]);
        let mut steps: Vec<f64> = steps.collect();
        let middle = steps.len() / 2;
        (middle < steps.len()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
    });
    usual
        .reduce(f64::min)
        .map_or(median, |step| step.max(median))
}

/// The samples that a channel has, where it does not have all.
fn sparse(values: &[f64]) -> Option<Vec<usize>> {
    let rows: Vec<usize> = (0..values.len()).filter(|&k| !values[k].is_nan()).collect();
    (rows.len() < values.len()).then_some(rows)
}

/// Whether times are those of several tables: a channel has samples that are even in time, and not in rows.
fn is_of_tables(time: &[f64], channels: &[&[f64]]) -> bool {
    let is_of_one = |values: &&[f64]| {
        let rows = sparse(values).unwrap_or_default();
        let Some(pair) = rows.first_chunk::<2>() else {
            return false;
        };
        let (count, step) = (pair[1] - pair[0], time[pair[1]] - time[pair[0]]);
        let mut pairs = rows.windows(2);
        let is_even = pairs.all(|pair| {
            let found = time[pair[1]] - time[pair[0]];
            (found - step).abs() <= EVEN_WITHIN * step || found > GAP_FACTOR * step
        });
        is_even && rows.windows(2).any(|pair| pair[1] - pair[0] != count)
    };
    channels.iter().any(is_of_one)
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
    roundest(mean, open)
}

/// More steps of different length than this are no ticks of a clock.
const MOST_LENGTHS: usize = 8;

/// Step and tick of even sampling whose times are whole ticks of a clock: the slope of time over rows, where no time is
/// further from that line than a tick.
fn coarse_clock(time: &[f64], gaps: &[Gap]) -> Option<(f64, f64)> {
    let starts = std::iter::once(0).chain(gaps.iter().map(|gap| gap.before));
    let ends = gaps.iter().map(|gap| gap.before).chain([time.len()]);
    let stretches: Vec<&[f64]> = starts
        .zip(ends)
        .map(|(start, end)| &time[start..end])
        .collect();
    let steps = || {
        stretches
            .iter()
            .flat_map(|stretch| stretch.windows(2))
            .map(|pair| pair[1] - pair[0])
    };
    let longest = steps().fold(0.0, f64::max);
    let mut lengths: Vec<f64> = Vec::new();
    for step in steps() {
        // times of a day lose digits: what differs by less than a thousandth is one length
        let is_same = |length: &f64| (length - step).abs() < 1e-3 * longest;
        if !lengths.iter().any(is_same) {
            lengths.push(step);
        }
        if lengths.len() > MOST_LENGTHS {
            return None;
        }
    }
    lengths.sort_by(f64::total_cmp);
    let tick = lengths
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .reduce(f64::min)?;
    let is_whole = |length: &f64| (length / tick - (length / tick).round()).abs() < 0.15;
    if !lengths.iter().all(is_whole) {
        return None;
    }
    let slope = slope(&stretches)?;
    let within = |stretch: &&[f64]| {
        let off = |(row, t): (usize, &f64)| t - stretch[0] - slope * row as f64;
        let (least, most) = stretch.iter().enumerate().map(off).fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            |(least, most): (f64, f64), off| (least.min(off), most.max(off)),
        );
        most - least <= 1.05 * tick
    };
    let rows = stretches.iter().map(|stretch| stretch.len()).max()?;
    let even = tick < 1.05 * longest && stretches.iter().all(within);
    even.then(|| (roundest(slope, tick / (rows - 1) as f64), tick))
}

/// The slope of time over rows, of least squares, each stretch with a beginning of its own.
fn slope(stretches: &[&[f64]]) -> Option<f64> {
    let (mut along, mut spread) = (0.0, 0.0);
    for stretch in stretches {
        let middle = (stretch.len() - 1) as f64 / 2.0;
        let mean = stretch.iter().map(|t| t - stretch[0]).sum::<f64>() / stretch.len() as f64;
        for (row, t) in stretch.iter().enumerate() {
            along += (row as f64 - middle) * (t - stretch[0] - mean);
            spread += (row as f64 - middle).powi(2);
        }
    }
    (spread > 0.0).then(|| along / spread)
}

/// The roundest number that is no further from `value` than `open`.
fn roundest(value: f64, open: f64) -> f64 {
    let mut rounded = (0..12).map(|digits| {
        let unit = 10_f64.powi(digits);
        (value * unit).round() / unit
    });
    rounded
        .find(|rounded| (rounded - value).abs() <= open)
        .unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(time: &[f64]) -> Sampling {
        Sampling::of(time, std::iter::empty())
    }

    #[test]
    fn finds_the_gap_and_the_segments() {
        let time: Vec<f64> = (0..10)
            .map(|k| f64::from(k) * 0.04 + if k >= 6 { 30.0 } else { 0.0 })
            .collect();
        let sampling = of(&time);
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
        assert!(of(&rounded).even);
        assert_eq!(of(&rounded).step, 0.1);
        let uneven: Vec<f64> = (0..100)
            .map(|k| f64::from(k) * 0.1 + f64::from(k % 3) * 0.01)
            .collect();
        assert!(!of(&uneven).even);
    }

    #[test]
    fn times_of_two_tables_are_no_ticks_of_a_clock() {
        // 50 Hz and 20 Hz: steps of 10 ms and 20 ms
        let mut time: Vec<f64> = (0..200).map(|k| f64::from(k) * 0.02).collect();
        time.extend(
            (0..80)
                .map(|k| f64::from(k) * 0.05)
                .filter(|t| (t / 0.02).fract() > 0.4),
        );
        time.sort_by(f64::total_cmp);
        let of_rate = |step: f64| -> Vec<f64> {
            let is_one = |t: &f64| ((t / step).round() - t / step).abs() < 1e-6;
            time.iter()
                .map(|t| if is_one(t) { 1.0 } else { f64::NAN })
                .collect()
        };
        let (fast, slow) = (of_rate(0.02), of_rate(0.05));
        let held = vec![1.0; time.len()];
        let sampling = Sampling::of(&time, [&fast[..], &slow, &held].into_iter());
        assert!(!sampling.even && sampling.tick.is_none());
    }

    #[test]
    fn ticks_of_a_clock_are_even_sampling() {
        // step of the sampling, tick of the clock, s
        for (step, tick) in [
            (0.02, 1.0 / 512.0),
            (1.0 / 30.0, 0.001),
            (0.016, 0.01),
            (1.0 / 60.0, 1.0 / 128.0),
            (1.3, 1.0),
        ] {
            let time = |k: u32| 3723.0 + ((f64::from(k) * step + 0.3 * tick) / tick).floor() * tick;
            let sampling = of(&(0..700).map(time).collect::<Vec<_>>());
            assert!(sampling.even, "{step} {tick}");
            assert!(
                (sampling.step - step).abs() < 2.0 * tick / 700.0,
                "{step}: {}",
                sampling.step
            );
            assert!((sampling.tick.unwrap() - tick).abs() < 1e-6 * tick);
        }
        // jitter in whole ticks, and a lost sample, are uneven
        let jitter = [0.0, 1.0, 2.0, 0.0, 3.0, 1.0, 0.0, 2.0];
        let time = |k: usize| k as f64 * 0.02 + jitter[k * 5 % 7] * 0.002;
        assert!(!of(&(0..700).map(time).collect::<Vec<_>>()).even);
        let time = |k: u32| (f64::from(k + u32::from(k > 300)) * 0.02 * 512.0).floor() / 512.0;
        assert!(!of(&(0..700).map(time).collect::<Vec<_>>()).even);
    }
}
