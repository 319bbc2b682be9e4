//! Signals between their samples, once continuously differentiable in time: piecewise cubics through the samples
//! (Hermite) with slopes from neighbouring samples. Before the first sample and behind the last the value is
//! held; the slope at both is 0, so that nothing jumps there either.

use super::segment::{Segment, Steps};

/// The time axis of a segment, by the lengths of its steps.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    steps: Steps,
    /// Where steps are uneven: time of each sample since the start, s.
    elapsed: Vec<f64>,
    last: usize,
}

/// Where an instant lies.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum At {
    /// Before the first sample, or on it.
    Before,
    /// `share` of the way from sample `sample` to the next, 0 ≤ share < 1.
    Between { sample: usize, share: f64 },
    /// On the last sample, or behind it.
    Behind,
}

impl Axis {
    pub(super) fn new(segment: &Segment) -> Self {
        let elapsed = match &segment.steps {
            Steps::Even(_) => Vec::new(),
            Steps::Uneven(steps) => std::iter::once(0.0)
                .chain(steps.iter().scan(0.0, |t, step| {
                    *t += step;
                    Some(*t)
                }))
                .collect(),
        };
        Self {
            steps: segment.steps.clone(),
            elapsed,
            last: segment.len().saturating_sub(1),
        }
    }

    /// The instant `delay` seconds before sample `k`.
    pub(super) fn before(&self, k: usize, delay: f64) -> At {
        let (sample, share) = match &self.steps {
            Steps::Even(step) => {
                let position = k as f64 - delay / step;
                if position <= 0.0 {
                    return At::Before;
                }
                let sample = position as usize;
                (sample, position - sample as f64)
            }
            Steps::Uneven(steps) => {
                let time = self.elapsed[k] - delay;
                if time <= 0.0 {
                    return At::Before;
                }
                let sample = self.elapsed.partition_point(|&t| t <= time) - 1;
                if sample >= self.last {
                    return At::Behind;
                }
                (sample, (time - self.elapsed[sample]) / steps[sample])
            }
        };
        if sample >= self.last {
            At::Behind
        } else {
            At::Between { sample, share }
        }
    }

    pub(super) fn last(&self) -> usize {
        self.last
    }

    /// Length of the step from sample `k` to the next, s.
    pub(super) fn length(&self, k: usize) -> f64 {
        self.steps.length(k)
    }

    /// The length that all steps have, where they are even, s.
    pub(super) fn even_step(&self) -> Option<f64> {
        match self.steps {
            Steps::Even(step) => Some(step),
            Steps::Uneven(_) => None,
        }
    }

    /// Mean length of a step, s.
    pub(super) fn mean_step(&self) -> f64 {
        match &self.steps {
            Steps::Even(step) => *step,
            Steps::Uneven(steps) => steps.iter().sum::<f64>() / steps.len().max(1) as f64,
        }
    }

    /// Value and rate at an instant as sums over four neighbouring samples, for signals that depend on θ: the
    /// slope at a sample is that of the parabola through it and its neighbours.
    pub(super) fn stencil(&self, at: At) -> Stencil {
        let (sample, share) = match at {
            At::Before => return Stencil::held(0),
            At::Behind => return Stencil::held(self.last),
            At::Between { sample, share } => (sample, share),
        };
        let h = self.steps.length(sample);
        let (value, rate) = hermite(share, h);
        let mut stencil = Stencil {
            samples: [-1, 0, 1, 2].map(|i| sample.saturating_add_signed(i).min(self.last)),
            weights: [0.0, value[0], value[1], 0.0],
            rates: [0.0, rate[0], rate[1], 0.0],
        };
        for (end, at) in [sample, sample + 1].into_iter().enumerate() {
            if at == 0 || at == self.last {
                continue;
            }
            let (a, b) = (self.steps.length(at - 1), self.steps.length(at));
            let slope = [-b / (a * (a + b)), (b - a) / (a * b), a / (b * (a + b))];
            for (i, slope) in slope.into_iter().enumerate() {
                stencil.weights[end + i] += value[2 + end] * slope;
                stencil.rates[end + i] += rate[2 + end] * slope;
            }
        }
        stencil
    }

    /// Value and rate of recorded samples at an instant. The slope at a sample is the harmonic mean of those to
    /// both sides, 0 at peaks: no overshoot at the edges of a step (Fritsch and Butland, SIAM J. Sci. Stat.
    /// Comput. 5, 1984).
    pub(super) fn recorded(&self, samples: &[f64], at: At) -> (f64, f64) {
        let (sample, share) = match at {
            At::Before => return (samples[0], 0.0),
            At::Behind => return (samples[self.last], 0.0),
            At::Between { sample, share } => (sample, share),
        };
        let slope = |k: usize| self.monotone(samples, k).map_or(0.0, |of| of.slope);
        let parts = [
            samples[sample],
            samples[sample + 1],
            slope(sample),
            slope(sample + 1),
        ];
        let (value, rate) = hermite(share, self.steps.length(sample));
        let sum = |weights: [f64; 4]| weights.iter().zip(parts).map(|(w, p)| w * p).sum();
        (sum(value), sum(rate))
    }

    /// The change of [`Self::recorded`]'s value with a change of the samples, per unit of it.
    pub(super) fn recorded_change(&self, samples: &[f64], changes: &[f64], at: At) -> f64 {
        let (sample, share) = match at {
            At::Before => return changes[0],
            At::Behind => return changes[self.last],
            At::Between { sample, share } => (sample, share),
        };
        let secant = |k: usize| (changes[k + 1] - changes[k]) / self.steps.length(k);
        let slope = |k: usize| {
            (self.monotone(samples, k)).map_or(0.0, |of| {
                of.by_before * secant(k - 1) + of.by_behind * secant(k)
            })
        };
        let parts = [
            changes[sample],
            changes[sample + 1],
            slope(sample),
            slope(sample + 1),
        ];
        let (value, _) = hermite(share, self.steps.length(sample));
        value.iter().zip(parts).map(|(w, p)| w * p).sum()
    }

    /// The slope at a sample of the monotone cubic through recorded ones; `None` where it is 0 whatever they are.
    fn monotone(&self, samples: &[f64], k: usize) -> Option<MonotoneSlope> {
        if k == 0 || k == self.last {
            return None;
        }
        let secant = |k: usize| (samples[k + 1] - samples[k]) / self.steps.length(k);
        let (before, behind) = (secant(k - 1), secant(k));
        if before * behind <= 0.0 {
            return None;
        }
        let (a, b) = (self.steps.length(k - 1), self.steps.length(k));
        let (p, q) = (2.0 * b + a, b + 2.0 * a);
        let slope = 3.0 * (a + b) / (p / before + q / behind);
        let by = |weight: f64, secant: f64| weight * (slope / secant).powi(2) / (3.0 * (a + b));
        Some(MonotoneSlope {
            slope,
            by_before: by(p, before),
            by_behind: by(q, behind),
        })
    }
}

/// The slope at a sample, and its derivatives by those of the straight lines to both sides.
struct MonotoneSlope {
    slope: f64,
    by_before: f64,
    by_behind: f64,
}

/// A value and its rate of change as sums over samples.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Stencil {
    pub samples: [usize; 4],
    pub weights: [f64; 4],
    pub rates: [f64; 4],
}

impl Stencil {
    fn held(sample: usize) -> Self {
        Self {
            samples: [sample; 4],
            weights: [1.0, 0.0, 0.0, 0.0],
            rates: [0.0; 4],
        }
    }
}

/// Weights of both values and both slopes of a step of length `h`: for the value, and for its rate.
fn hermite(s: f64, h: f64) -> ([f64; 4], [f64; 4]) {
    let r = 1.0 - s;
    let value = [
        (1.0 + 2.0 * s) * r * r,
        s * s * (3.0 - 2.0 * s),
        h * s * r * r,
        -h * s * s * r,
    ];
    let rate = [
        -6.0 * s * r / h,
        6.0 * s * r / h,
        (1.0 - 3.0 * s) * r,
        s * (3.0 * s - 2.0),
    ];
    (value, rate)
}

#[cfg(test)]
mod tests {
    use super::super::segment::Substeps;
    use super::*;

    fn axes() -> [Axis; 2] {
        let uneven: Vec<f64> = (0..19).map(|k| 0.1 + 0.03 * f64::from(k % 4)).collect();
        [Steps::Even(0.1), Steps::Uneven(uneven)].map(|steps| {
            Axis::new(&Segment {
                label: String::new(),
                time: vec![0.0; 20],
                steps,
                substeps: Substeps::default(),
                inputs: Vec::new(),
                measured: Vec::new(),
            })
        })
    }

    fn elapsed(axis: &Axis) -> Vec<f64> {
        (0..20)
            .map(|k| (0..k).map(|i| axis.steps.length(i)).sum())
            .collect()
    }

    fn sum(weights: [f64; 4], samples: [usize; 4], values: &[f64]) -> f64 {
        weights
            .iter()
            .zip(samples)
            .map(|(w, k)| w * values[k])
            .sum()
    }

    /// Away from the ends, where the slope is 0 by decree.
    #[test]
    fn parabolas_are_met_exactly() {
        for axis in axes() {
            let values: Vec<f64> = elapsed(&axis)
                .iter()
                .map(|t| 1.0 - 3.0 * t + t * t)
                .collect();
            for delay in [-0.31, -0.1, 0.0, 0.04, 0.2, 0.333] {
                let t = elapsed(&axis)[10] - delay;
                let stencil = axis.stencil(axis.before(10, delay));
                let value = sum(stencil.weights, stencil.samples, &values);
                let rate = sum(stencil.rates, stencil.samples, &values);
                assert!((value - (1.0 - 3.0 * t + t * t)).abs() < 1e-13, "{delay}");
                assert!((rate - (2.0 * t - 3.0)).abs() < 1e-12, "{delay}");
            }
        }
    }

    /// Value and rate as the instant passes over samples and both ends: steps of 1e-7 s change them by no more
    /// than their slopes (below 20 /s and 1000 /s²) allow.
    #[test]
    fn nothing_jumps_anywhere() {
        for axis in axes() {
            let values: Vec<f64> = (0..20)
                .map(|k| f64::from((k / 4) % 2) + 0.1 * f64::from(k))
                .collect();
            let times = elapsed(&axis);
            for &edge in &times {
                let delay = times[9] - edge;
                let both = [-1e-7, 0.0, 1e-7].map(|change| {
                    let at = axis.before(9, delay + change);
                    let stencil = axis.stencil(at);
                    let linear = (
                        sum(stencil.weights, stencil.samples, &values),
                        sum(stencil.rates, stencil.samples, &values),
                    );
                    [linear, axis.recorded(&values, at)]
                });
                for (i, [a, b]) in both
                    .iter()
                    .zip(&both[1..])
                    .flat_map(|(a, b)| [[a[0], b[0]], [a[1], b[1]]])
                    .enumerate()
                {
                    assert!(
                        (a.0 - b.0).abs() < 3e-6 && (a.1 - b.1).abs() < 2e-4,
                        "{i}: {a:?} {b:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn recorded_steps_do_not_overshoot() {
        for axis in axes() {
            let values: Vec<f64> = (0..20).map(|k| f64::from((k / 5) % 2)).collect();
            for k in 0..200 {
                let (value, _) = axis.recorded(&values, axis.before(19, 0.01 * f64::from(k)));
                assert!((0.0..=1.0).contains(&value), "{value}");
            }
        }
    }

    #[test]
    fn no_delay_is_the_sample_itself() {
        for axis in axes() {
            let values: Vec<f64> = (0..20).map(|k| (f64::from(k) * 1.7).sin()).collect();
            for k in 0..20 {
                let stencil = axis.stencil(axis.before(k, 0.0));
                assert_eq!(sum(stencil.weights, stencil.samples, &values), values[k]);
                assert_eq!(axis.recorded(&values, axis.before(k, 0.0)).0, values[k]);
            }
        }
    }
}
