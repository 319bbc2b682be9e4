//! Lines in the spectrum of what is left: an output that swings at one frequency though no input does.
//!
//! The periodogram of noise is smooth but for chance: averaged over M windows it is χ² with 2M degrees of freedom about the
//! spectrum of the noise, which the median of the lines around tells.

use num_complex::Complex64;
use rustfft::{Fft, FftPlanner};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::estimate::TimeHistory;

/// Noise alone makes a line once in so many diagnoses.
const FALSE_ALARM: f64 = 1e-4;

/// Samples of a window, at most.
const WINDOW: usize = 512;

/// Lines to either side that tell the spectrum of the noise, but for the nearest, over which a line spreads.
const AROUND: usize = 12;
const NEAREST: usize = 3;

/// An input whose own line stands out as much drives the output there.
const DRIVEN: f64 = 6.0;

/// Windows overlap by half: so many of their degrees of freedom are their own (Welch, 1967).
const OWN: f64 = 0.75;

/// A swing that no input drives.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Line {
    pub output: String,
    /// SI
    pub unit: String,
    /// Hz
    pub frequency: f64,
    /// In `unit`, on average.
    pub amplitude: f64,
}

/// The clearest line of each output, over flights of one sampling rate.
pub(super) fn lines(histories: &[TimeHistory]) -> Vec<Line> {
    let Some(first) = histories.first() else {
        return Vec::new();
    };
    let shortest = histories.iter().map(|h| h.time.len()).min().unwrap_or(0);
    let size = WINDOW.min(shortest);
    if size / 2 <= 2 * AROUND {
        return Vec::new();
    }
    let step = (first.time[first.time.len() - 1] - first.time[0]) / (first.time.len() - 1) as f64;
    let windows = Windows::new(size);
    let inputs: Vec<Vec<f64>> = (0..first.inputs.len())
        .map(|input| {
            windows
                .power(histories.iter().map(|h| h.inputs[input].values.as_slice()))
                .0
        })
        .collect();
    let questions = (first.outputs.len() * size / 2) as f64;
    let of_output = |output: usize| {
        let residuals = histories
            .iter()
            .map(|h| h.outputs[output].residual.as_slice());
        let (power, count) = windows.power(residuals);
        let stands_out = |line: &usize| ratio(&power, *line);
        let drives = |input: &Vec<f64>, line: usize| {
            (line - 1..=line + 1).any(|near| ratio(input, near) > DRIVEN)
        };
        let line = (AROUND..power.len().saturating_sub(AROUND))
            .filter(|line| !inputs.iter().any(|input| drives(input, *line)))
            .max_by(|a, b| stands_out(a).total_cmp(&stands_out(b)))?;
        let is_clear = stands_out(&line) > critical(count, questions);
        is_clear.then(|| Line {
            output: first.outputs[output].name.clone(),
            unit: first.outputs[output].unit.clone(),
            frequency: line as f64 / (size as f64 * step),
            amplitude: windows.amplitude(power[line]),
        })
    };
    (0..first.outputs.len()).filter_map(of_output).collect()
}

/// The power of a line over the median of those around it.
fn ratio(power: &[f64], line: usize) -> f64 {
    let near = line.saturating_sub(AROUND)..power.len().min(line + AROUND + 1);
    let mut around: Vec<f64> = near
        .filter(|other| other.abs_diff(line) > NEAREST)
        .map(|other| power[other])
        .collect();
    around.sort_by(f64::total_cmp);
    match around.get(around.len() / 2) {
        Some(&median) if median > 0.0 => power[line] / median,
        _ => 0.0,
    }
}

/// The ratio that noise alone exceeds in one of `questions` once in so many diagnoses, of periodograms over `windows`.
fn critical(windows: f64, questions: f64) -> f64 {
    let freedom = (2.0 * OWN * windows).max(2.0);
    ChiSquared::new(freedom).map_or(f64::INFINITY, |law| {
        law.inverse_cdf(1.0 - FALSE_ALARM / questions) / law.inverse_cdf(0.5)
    })
}

struct Windows {
    hann: Vec<f64>,
    plan: std::sync::Arc<dyn Fft<f64>>,
}

impl Windows {
    fn new(size: usize) -> Self {
        let weight = |k: usize| {
            (std::f64::consts::PI * (k as f64 + 0.5) / size as f64)
                .sin()
                .powi(2)
        };
        Self {
            hann: (0..size).map(weight).collect(),
            plan: FftPlanner::new().plan_fft_forward(size),
        }
    }

    /// Mean power by line over all windows without a gap, and how many these are.
    fn power<'s>(&self, series: impl Iterator<Item = &'s [f64]>) -> (Vec<f64>, f64) {
        let size = self.hann.len();
        let mut power = vec![0.0; size / 2];
        let mut count = 0.0;
        for values in series {
            let mut from = 0;
            while from + size <= values.len() {
                let window = &values[from..from + size];
                from += size / 2;
                if !window.iter().all(|value| value.is_finite()) {
                    continue;
                }
                let mean = window.iter().sum::<f64>() / size as f64;
                let weighted = window.iter().zip(&self.hann);
                let mut buffer: Vec<Complex64> = weighted
                    .map(|(value, w)| Complex64::new((value - mean) * w, 0.0))
                    .collect();
                self.plan.process(&mut buffer);
                power
                    .iter_mut()
                    .zip(&buffer)
                    .for_each(|(sum, x)| *sum += x.norm_sqr());
                count += 1.0;
            }
        }
        power
            .iter_mut()
            .for_each(|sum| *sum /= f64::max(count, 1.0));
        (power, count)
    }

    /// Of a swing with this power in its line.
    fn amplitude(&self, power: f64) -> f64 {
        2.0 * power.sqrt() / self.hann.iter().sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::estimate::{OutputSeries, Role, Series};

    const STEP: f64 = 0.02;
    const SAMPLES: usize = 1500;

    /// Coloured noise, a doublet as input, and what else is left.
    fn flight(seed: u64, left: impl Fn(f64) -> f64) -> TimeHistory {
        let mut chance = ChaCha8Rng::seed_from_u64(seed);
        let mut noise = 0.0;
        let mut residual = Vec::new();
        for k in 0..SAMPLES {
            let white: f64 = (0..12).map(|_| chance.random::<f64>() - 0.5).sum();
            noise = 0.9 * noise + white;
            residual.push(noise + left(k as f64 * STEP));
        }
        let time: Vec<f64> = (0..SAMPLES).map(|k| k as f64 * STEP).collect();
        let input = |t: &f64| (3.0 * std::f64::consts::TAU * t).sin();
        TimeHistory {
            segment: format!("flight {seed}"),
            role: Role::Estimation,
            inputs: vec![Series {
                name: "de".into(),
                unit: "rad".into(),
                values: time.iter().map(input).collect(),
            }],
            outputs: vec![OutputSeries {
                name: "az".into(),
                unit: "m/s^2".into(),
                measured: residual.clone(),
                model: vec![0.0; SAMPLES],
                declared: Vec::new(),
                residual,
            }],
            time,
        }
    }

    fn found(left: impl Fn(f64) -> f64 + Copy, seeds: u64) -> Vec<Line> {
        let flights: Vec<TimeHistory> = (seeds..seeds + 2).map(|seed| flight(seed, left)).collect();
        lines(&flights)
    }

    #[test]
    fn a_vibration_is_found_and_noise_is_none() {
        let swing = |t: f64| 1.2 * (4.3 * std::f64::consts::TAU * t).sin();
        let [line] = &found(swing, 1)[..] else {
            panic!("one line");
        };
        assert!((line.frequency - 4.3).abs() < 0.1, "{line:?}");
        assert!((line.amplitude - 1.2).abs() < 0.4, "{line:?}");
        let alarms = (0..200).filter(|seed| !found(|_| 0.0, 10 * seed).is_empty());
        assert_eq!(alarms.count(), 0);
        // what an input drives is another matter
        let driven = |t: f64| 1.2 * (3.0 * std::f64::consts::TAU * t).sin();
        assert_eq!(found(driven, 1), []);
        assert_eq!(lines(&[]), []);
    }
}
