//! Lines in the spectrum of what is left: an output that swings at one frequency though no input does.
//!
//! The periodogram of noise is smooth but for chance: averaged over M windows it is χ² with 2M degrees of freedom about the
//! spectrum of the noise, which the mean of the lines around tells. Of both the ratio has Fisher's distribution.

use num_complex::Complex64;
use rustfft::{Fft, FftPlanner};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use crate::estimate::TimeHistory;
use crate::stop;

/// Noise alone makes a line once in so many diagnoses.
const FALSE_ALARM: f64 = 1e-3;

/// Samples of a window of a part of a flight, and of one of a whole flight, at most.
const WINDOW: usize = 512;
const LONGEST: usize = 8192;

/// Lines to either side that tell the spectrum of the noise, but for the nearest, over which a line spreads.
const AROUND: usize = 24;
const NEAREST: usize = 3;

/// Lines beside each other share samples: so many of those around are worth one of their own.
const WORTH_ONE: f64 = 2.0;

/// Independent series are as coherent as one that drives the other once in so many inputs.
const BY_CHANCE: f64 = 0.01;

/// An input whose own line stands out so far drives what swings with it.
const SWINGS_TOO: f64 = 4.0;

/// Where windows overlap by half, so many of their degrees of freedom are their own (Welch, 1967).
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

/// The clearest line of each output, over flights of one sampling rate. A swing of one frequency stands out most in windows as
/// long as a flight, one that comes and goes in shorter ones.
pub(super) fn lines(histories: &[TimeHistory]) -> Vec<Line> {
    let Some(first) = histories.first() else {
        return Vec::new();
    };
    let shortest = histories.iter().map(|h| h.time.len()).min().unwrap_or(0);
    let mut sizes = vec![shortest.min(LONGEST)];
    sizes.extend((WINDOW < shortest).then_some(WINDOW));
    sizes.retain(|size| size / 2 > 2 * AROUND);
    let looks: Vec<Look<'_>> = (sizes.iter())
        .map(|size| Look::new(histories, *size, sizes.len()))
        .collect();
    let clearest = |output: usize| {
        let found = looks.iter().filter_map(|look| look.clearest(output));
        found
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, line)| line)
    };
    (0..first.outputs.len()).filter_map(clearest).collect()
}

/// Residuals in windows of one size.
struct Look<'h> {
    histories: &'h [TimeHistory],
    windows: Windows,
    /// By input.
    inputs: Vec<Vec<Spectrum>>,
    /// Hz
    resolution: f64,
    /// Share of the windows' degrees of freedom that is their own.
    own: f64,
    /// Lines of all outputs that are asked, in all looks.
    questions: f64,
}

impl<'h> Look<'h> {
    fn new(histories: &'h [TimeHistory], size: usize, looks: usize) -> Self {
        let first = &histories[0];
        let samples = first.time.len();
        let step = (first.time[samples - 1] - first.time[0]) / (samples - 1) as f64;
        let windows = Windows::new(size);
        let of_input =
            |input: usize| windows.spectra(histories.iter().map(|h| &*h.inputs[input].values));
        Self {
            inputs: (0..first.inputs.len()).map(of_input).collect(),
            own: if histories.iter().all(|h| 2 * h.time.len() < 3 * size) {
                1.0
            } else {
                OWN
            },
            resolution: 1.0 / (size as f64 * step),
            questions: (looks * first.outputs.len() * size / 2) as f64,
            histories,
            windows,
        }
    }

    /// The clearest line of an output, by how much it stands out beyond chance.
    fn clearest(&self, output: usize) -> Option<(f64, Line)> {
        let residuals = self.histories.iter().map(|h| &*h.outputs[output].residual);
        let spectra = self.windows.spectra(residuals);
        let power = power_of(&spectra);
        let count = self.own * spectra.iter().flatten().count() as f64;
        let is_driven = |line: usize| {
            let drives = |input: &Vec<Spectrum>| match count > 1.0 {
                true => coherence(&spectra, input, line) > by_chance(count),
                // one window is coherent with any other
                false => ratio(&power_of(input), line) > SWINGS_TOO,
            };
            self.inputs.iter().any(drives)
        };
        let line = (AROUND..power.len().saturating_sub(AROUND))
            .max_by(|&a, &b| ratio(&power, a).total_cmp(&ratio(&power, b)))?;
        let beyond = ratio(&power, line) / critical(count, self.questions);
        let series = &self.histories[0].outputs[output];
        (beyond > 1.0 && !is_driven(line)).then(|| {
            let line = Line {
                output: series.name.clone(),
                unit: series.unit.clone(),
                frequency: line as f64 * self.resolution,
                amplitude: self.windows.amplitude(power[line]),
            };
            (beyond, line)
        })
    }
}

/// Of one window; `None` where it has a gap.
type Spectrum = Option<Vec<Complex64>>;

/// Mean power by line.
fn power_of(spectra: &[Spectrum]) -> Vec<f64> {
    let whole = || spectra.iter().flatten();
    let count = whole().count().max(1) as f64;
    let lines = whole().next().map_or(0, Vec::len);
    stop::check();
    (0..lines)
        .map(|line| whole().map(|x| x[line].norm_sqr()).sum::<f64>() / count)
        .collect()
}

/// The squared coherence that independent series have by chance over so many windows of their own: P(γ² > x) = (1 - x)^(M - 1).
fn by_chance(windows: f64) -> f64 {
    1.0 - BY_CHANCE.powf(1.0 / (windows - 1.0).max(0.0))
}

/// Squared coherence of two series at a line.
fn coherence(output: &[Spectrum], input: &[Spectrum], line: usize) -> f64 {
    let (mut cross, mut own, mut of_input) = (Complex64::new(0.0, 0.0), 0.0, 0.0);
    for (e, u) in output.iter().zip(input) {
        if let (Some(e), Some(u)) = (e, u) {
            cross += e[line] * u[line].conj();
            own += e[line].norm_sqr();
            of_input += u[line].norm_sqr();
        }
    }
    match own * of_input {
        whole if whole > 0.0 => cross.norm_sqr() / whole,
        _ => 0.0,
    }
}

/// The power of a line over the mean of those around it.
fn ratio(power: &[f64], line: usize) -> f64 {
    let near = line.saturating_sub(AROUND)..power.len().min(line + AROUND + 1);
    let around: Vec<f64> = near
        .filter(|other| other.abs_diff(line) > NEAREST)
        .map(|other| power[other])
        .collect();
    match around.iter().sum::<f64>() / around.len().max(1) as f64 {
        mean if mean > 0.0 => power[line] / mean,
        _ => 0.0,
    }
}

/// The ratio that noise alone exceeds in one of `questions` once in so many diagnoses, of periodograms over so many windows of
/// their own.
fn critical(windows: f64, questions: f64) -> f64 {
    let freedom = (2.0 * windows).max(2.0);
    let around = freedom * 2.0 * (AROUND - NEAREST) as f64 / WORTH_ONE;
    FisherSnedecor::new(freedom, around).map_or(f64::INFINITY, |law| {
        law.inverse_cdf(1.0 - FALSE_ALARM / questions)
    })
}

/// Sine tapers: what is slow leaks little into other lines, and a line keeps four fifths of its height.
struct Windows {
    taper: Vec<f64>,
    plan: std::sync::Arc<dyn Fft<f64>>,
}

impl Windows {
    fn new(size: usize) -> Self {
        let weight = |k: usize| (std::f64::consts::PI * (k as f64 + 0.5) / size as f64).sin();
        Self {
            taper: (0..size).map(weight).collect(),
            plan: FftPlanner::new().plan_fft_forward(size),
        }
    }

    /// Of the windows of some series, one after the other.
    fn spectra<'s>(&self, series: impl Iterator<Item = &'s [f64]>) -> Vec<Spectrum> {
        let size = self.taper.len();
        let of_window = |window: &[f64]| {
            stop::check();
            let mean = window.iter().sum::<f64>() / size as f64;
            let weighted = window.iter().zip(&self.taper);
            let mut buffer: Vec<Complex64> = weighted
                .map(|(value, w)| Complex64::new((value - mean) * w, 0.0))
                .collect();
            self.plan.process(&mut buffer);
            buffer.truncate(size / 2);
            (mean.is_finite()).then_some(buffer)
        };
        let starts = |values: &[f64]| (0..=values.len() - size).step_by(size / 2);
        series
            .flat_map(|values| starts(values).map(|from| of_window(&values[from..from + size])))
            .collect()
    }

    /// Of a swing with this power in its line.
    fn amplitude(&self, power: f64) -> f64 {
        2.0 * power.sqrt() / self.taper.iter().sum::<f64>()
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
        // one window alone
        let one = lines(&[flight(3, swing)]);
        assert!(
            one.iter().any(|line| (line.frequency - 4.3).abs() < 0.1),
            "{one:?}"
        );
        assert_eq!(lines(&[flight(3, driven)]), []);
    }
}
