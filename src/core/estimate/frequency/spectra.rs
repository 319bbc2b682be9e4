//! The transforms of one segment, and what is estimated of its ends and trends.
//!
//! All transforms are scaled so that the real and the imaginary part of white noise of variance σ² have the variance σ² each,
//! whatever the length of the record: R means what it means in the time domain. Where frequencies are closer than 1/T, each
//! counts by its share of that.

use num_complex::Complex64;

use super::path::Window;
use crate::estimate::options::frequency::{Ends, FrequencyOptions, Trend};
use crate::simulate::{InputInterpolation, Segment, Steps};
use crate::spectral::{Between, FourierIntegral, Frequencies};

/// What a quantity that is estimated of the ends or the trend of a segment adds to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Target {
    /// The right side of a state equation.
    State(usize),
    /// An output, as it is recorded.
    Output(usize),
}

/// One such quantity: where it acts, and its transform.
#[derive(Clone, Debug)]
pub(super) struct Term {
    pub target: Target,
    /// By frequency.
    pub transform: Vec<Complex64>,
}

/// Transforms over the band, by frequency.
pub(super) struct Spectra {
    /// rad/s.
    pub omega: Vec<f64>,
    /// By input: about its first sample.
    pub inputs: Vec<Vec<Complex64>>,
    /// By input that has a delay: its samples, for the ends.
    pub windows: Vec<Option<Window>>,
    /// By output: about its mean.
    pub outputs: Vec<Vec<Complex64>>,
    pub terms: Vec<Term>,
    /// From an integral over time to the scaled transform.
    pub scale: f64,
    pub frequencies: Frequencies,
    /// How many of the frequencies are independent.
    pub independent: usize,
}

/// How the signals of a problem are transformed.
pub(super) struct Transform<'a> {
    pub options: &'a FrequencyOptions,
    pub interpolation: InputInterpolation,
    /// Outputs that are derivatives of states, with the state in the place of samples: they come first.
    pub derivatives: usize,
    /// Inputs that are measured states: they come last.
    pub measured: usize,
    pub states: usize,
    /// By input, whether it has a delay.
    pub delayed: &'a [bool],
}

/// The frequencies at which a segment is looked at.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Band {
    pub frequencies: Frequencies,
    /// How many of them are independent in a record of its length.
    pub independent: usize,
}

/// The frequencies of an evenly sampled segment within the band that the options ask for.
pub(crate) fn band_frequencies(segment: &Segment, options: &FrequencyOptions) -> Band {
    let duration = segment.steps.length(0) * (segment.len() - 1) as f64;
    let frequencies = match options.step_hz {
        None => Frequencies::harmonics(duration, options.band_hz),
        Some(step) => Frequencies::spaced(step, options.band_hz),
    };
    let share = match options.step_hz {
        None => 1.0,
        Some(step) => (step * duration).min(1.0),
    };
    Band {
        frequencies,
        independent: ((frequencies.count as f64 * share).round() as usize).max(1),
    }
}

impl Transform<'_> {
    /// The transforms of a segment that is sampled evenly and lacks no value.
    pub(super) fn of(&self, segment: &Segment) -> Spectra {
        let step = match &segment.steps {
            Steps::Even(step) => *step,
            Steps::Uneven(steps) => steps[0],
        };
        let Band {
            frequencies,
            independent,
        } = band_frequencies(segment, self.options);
        let integral = FourierIntegral::new(segment.len(), step, frequencies);
        let share = independent as f64 / frequencies.count.max(1) as f64;
        let scale = share.sqrt() / (step * (0.5 * segment.len() as f64).sqrt());
        let recorded = segment.inputs.len() - self.measured;
        let between = |input: usize| match self.interpolation {
            _ if input >= recorded => Between::Cubic,
            InputInterpolation::Linear => Between::Line,
            InputInterpolation::Hold => Between::Held,
        };
        let inputs = segment.inputs.iter().enumerate();
        let inputs = inputs.map(|(i, samples)| {
            scaled(integral.of(&about(samples, samples[0]), between(i)), scale)
        });
        let outputs = segment.measured.iter().enumerate();
        let outputs = outputs.map(|(i, samples)| {
            let transform = if i < self.derivatives {
                derivative(&integral, samples, self.options.ends)
            } else {
                let mean = samples.iter().sum::<f64>() / samples.len() as f64;
                integral.of(&about(samples, mean), Between::Cubic)
            };
            scaled(transform, scale)
        });
        let windows = segment.inputs.iter().zip(self.delayed);
        Spectra {
            inputs: inputs.collect(),
            outputs: outputs.collect(),
            windows: windows
                .map(|(samples, is_delayed)| is_delayed.then(|| Window::of(samples, step)))
                .collect(),
            terms: self.terms(&integral, segment.measured.len(), scale),
            omega: integral.omega().to_vec(),
            scale,
            frequencies,
            independent,
        }
    }

    /// What is estimated of the ends and trends: the same for all segments, and in the same order.
    fn terms(&self, integral: &FourierIntegral, outputs: usize, scale: f64) -> Vec<Term> {
        let mut terms = Vec::new();
        let mut add = |target: Target, transform: Vec<Complex64>| {
            let transform = scaled(transform, scale);
            terms.push(Term { target, transform });
        };
        let end = integral.at_end();
        let start = vec![Complex64::ONE; end.len()];
        // at multiples of 1/T both ends, and a constant, cannot be told from one another, or from nothing
        let harmonic = self.options.step_hz.is_none();
        if self.options.ends == Ends::Estimated {
            let states = (0..self.states).map(Target::State);
            for target in states.chain((0..self.derivatives).map(Target::Output)) {
                add(target, start.clone());
                if !harmonic {
                    add(target, end.clone());
                }
            }
        }
        let omega = integral.omega();
        let duration = integral.duration();
        let constant = |k: usize| (start[k] - end[k]) / Complex64::new(0.0, omega[k]);
        for target in (0..outputs).map(Target::Output) {
            if !harmonic {
                add(target, (0..omega.len()).map(constant).collect());
            }
            if self.options.trend == Trend::Linear {
                // ∫ t exp(-iωt) dt
                let line =
                    |k: usize| (constant(k) - end[k] * duration) / Complex64::new(0.0, omega[k]);
                add(target, (0..omega.len()).map(line).collect());
            }
        }
        terms
    }
}

fn about(samples: &[f64], level: f64) -> Vec<f64> {
    samples.iter().map(|x| x - level).collect()
}

fn scaled(mut transform: Vec<Complex64>, scale: f64) -> Vec<Complex64> {
    transform.iter_mut().for_each(|value| *value *= scale);
    transform
}

/// ∫ dx/dt exp(-iωt) dt = iω X + x(T) exp(-iωT) - x(0), by parts. With ends at rest they do not differ.
fn derivative(integral: &FourierIntegral, samples: &[f64], ends: Ends) -> Vec<Complex64> {
    let first = samples[0];
    let own = integral.of(&about(samples, first), Between::Cubic);
    let change = match ends {
        Ends::Estimated => samples[samples.len() - 1] - first,
        Ends::AtRest => 0.0,
    };
    let omega = integral.omega().iter();
    let with_end = own.iter().zip(omega).zip(integral.at_end());
    with_end
        .map(|((x, &omega), end)| Complex64::new(0.0, omega) * x + end * change)
        .collect()
}
