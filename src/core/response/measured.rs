//! From a recording to its frequency responses.

use num_complex::Complex64;

use super::bandwidth::bandwidth;
use super::conditioned::{Point, responses};
use super::cross_spectra::{CrossSpectra, Layout};
use super::options::ResponseOptions;
use super::report::{FrequencyResponse, FrequencyResponses};
use super::transfer_function::{Weighted, fitted};
use crate::flight::{Fault, Maneuver};

/// Periods of a frequency that a window must hold to tell of it; of the longest window, one is enough.
const PERIODS: f64 = 5.0;

/// Windows without a word: so many, the shortest by so much shorter than the longest.
const WINDOWS: usize = 5;
const SHORTEST: f64 = 0.2;

/// The responses of a recording, from all its stretches without gaps.
///
/// # Errors
/// An option is out of range; a channel is not recorded, stands still, or is a sum of others; the recording is not sampled
/// evenly, or shorter than a window. Pointers are the options' fields.
pub fn frequency_responses(
    maneuver: &Maneuver,
    options: &ResponseOptions,
) -> Result<FrequencyResponses, Vec<Fault>> {
    let fault = |field: &str, code: &'static str, message: String| {
        Err(vec![Fault::new(format!("/{field}"), code, message)])
    };
    if let Some((field, message)) = options.fault() {
        return fault(field, "bad_option", message);
    }
    let names: Vec<&String> = options.inputs.iter().chain(&options.outputs).collect();
    for (place, name) in names.iter().enumerate() {
        let field = if place < options.inputs.len() {
            "inputs"
        } else {
            "outputs"
        };
        if !maneuver.channels().contains_key(*name) {
            let all: Vec<&str> = maneuver.channels().keys().map(String::as_str).collect();
            let message = format!("there is no channel '{name}'; there are {}", all.join(", "));
            return fault(field, "unknown_channel", message);
        }
        if names[..place].contains(name) {
            return fault(field, "bad_option", format!("'{name}' is named twice"));
        }
    }
    let sampling = maneuver.sampling();
    if !sampling.even {
        let message = "the recording is sampled unevenly, and windows need even steps; upload it evenly sampled";
        return fault("inputs", "uneven_sampling", message.to_string());
    }
    let step = sampling.step;
    let [from, to] = options.band_hz;
    if to > 0.5 / step {
        let message = format!(
            "samples are {step} s apart, which tells of frequencies up to {:.4} Hz",
            0.5 / step
        );
        return fault("band_hz", "bad_option", message);
    }
    let segments = sampling.segments();
    let stretches: Vec<Vec<Vec<f64>>> = segments
        .iter()
        .map(|rows| {
            names
                .iter()
                .map(|name| maneuver.channels()[*name].values[rows.clone()].to_vec())
                .collect()
        })
        .collect();
    let longest = segments
        .iter()
        .map(ExactSizeIterator::len)
        .max()
        .unwrap_or(0);
    let lengths = lengths(options, longest, step);
    let layout = Layout {
        step,
        first: from,
        spacing: (to - from) / (options.points - 1) as f64,
        count: options.points,
    };
    let windows: Vec<(f64, CrossSpectra)> = lengths
        .iter()
        .filter_map(|&length| {
            let spectra = CrossSpectra::of(&stretches, length, layout)?;
            Some((length as f64 * step, spectra))
        })
        .collect();
    if windows.is_empty() {
        let message = format!(
            "no stretch of the recording without gaps and missing values is as long as a window; the longest has {:.2} s",
            longest as f64 * step
        );
        return fault("windows", "too_few_samples", message);
    }
    let frequency: Vec<f64> = (0..options.points)
        .map(|k| from + k as f64 * layout.spacing)
        .collect();
    let all = Measured {
        options,
        frequency: &frequency,
        windows: &windows,
        signals: names.len(),
    };
    let found: Vec<FrequencyResponse> = (0..options.outputs.len())
        .flat_map(|output| all.of_output(output))
        .collect();
    if found
        .iter()
        .all(|response| response.magnitude.iter().all(Option::is_none))
    {
        let message = "at no frequency is there a response: inputs stand still or are sums of one another, or no window holds a period of the band";
        return fault("inputs", "no_response", message.to_string());
    }
    Ok(FrequencyResponses {
        windows: windows.iter().map(|(length, _)| *length).collect(),
        responses: found,
        frequency_hz: frequency,
    })
}

/// In samples, longest first.
fn lengths(options: &ResponseOptions, longest: usize, step: f64) -> Vec<usize> {
    let seconds: Vec<f64> = if options.windows.is_empty() {
        // five windows and more for each unknown of a frequency: a coherence of few is by chance
        let share = 2.5 * (1 + options.inputs.len()) as f64;
        let most = longest as f64 * step / share;
        let share = |i: usize| SHORTEST.powf(i as f64 / (WINDOWS - 1) as f64);
        (0..WINDOWS).map(|i| most * share(i)).collect()
    } else {
        options.windows.clone()
    };
    let samples = seconds
        .iter()
        .map(|length| (length / step).round() as usize);
    let mut samples: Vec<usize> = samples
        .filter(|&count| count >= 8 && count <= longest)
        .collect();
    samples.sort_unstable_by(|a, b| b.cmp(a));
    samples.dedup();
    samples
}

struct Measured<'a> {
    options: &'a ResponseOptions,
    frequency: &'a [f64],
    /// Length, s, and spectra; longest first.
    windows: &'a [(f64, CrossSpectra)],
    signals: usize,
}

impl Measured<'_> {
    fn of_output(&self, output: usize) -> Vec<FrequencyResponse> {
        let inputs = self.options.inputs.len();
        let points: Vec<Option<Vec<Point>>> = (0..self.frequency.len())
            .map(|k| self.composite(k, inputs + output))
            .collect();
        (0..inputs)
            .map(|input| {
                let own: Vec<Option<Point>> = points
                    .iter()
                    .map(|all| Some(all.as_ref()?[input]))
                    .collect();
                self.response(input, output, &own)
            })
            .collect()
    }

    /// Windows put together at a frequency: spectra with weights W², W = (ε/ε_least)⁻⁴ (Tischler and Remple, ch. 10).
    fn composite(&self, k: usize, output: usize) -> Option<Vec<Point>> {
        let inputs = self.options.inputs.len();
        let usable = self
            .windows
            .iter()
            .enumerate()
            .filter(|(place, (length, _))| {
                let periods = if *place == 0 { 1.0 } else { PERIODS };
                length * self.frequency[k] >= periods
            });
        let each = usable.filter_map(|(_, (_, spectra))| {
            let own = &spectra.by_frequency[k];
            let points = responses(own, self.signals, inputs, output, spectra.independent)?;
            let worst = points.iter().map(|point| point.error).fold(0.0, f64::max);
            Some((spectra, worst.max(f64::MIN_POSITIVE)))
        });
        let each: Vec<(&CrossSpectra, f64)> = each.collect();
        let least = each
            .iter()
            .map(|(_, error)| *error)
            .fold(f64::INFINITY, f64::min);
        let mut sum = vec![Complex64::ZERO; self.signals * self.signals];
        let (mut weights, mut independent) = (0.0, 0.0);
        for (spectra, error) in each {
            let weight = (error / least).powi(-8);
            let own = sum.iter_mut().zip(&spectra.by_frequency[k]);
            own.for_each(|(sum, own)| *sum += own * weight);
            weights += weight;
            independent += weight * spectra.independent;
        }
        if weights == 0.0 {
            return None;
        }
        sum.iter_mut().for_each(|sum| *sum /= weights);
        responses(&sum, self.signals, inputs, output, independent / weights)
    }

    fn response(&self, input: usize, output: usize, points: &[Option<Point>]) -> FrequencyResponse {
        let of = |value: fn(&Point) -> f64| -> Vec<Option<f64>> {
            points
                .iter()
                .map(|point| point.as_ref().map(value))
                .collect()
        };
        let decibels = of(|point| 20.0 * point.response.norm().log10());
        let phase = unwrapped(points);
        let known: Vec<usize> = (0..points.len()).filter(|&k| points[k].is_some()).collect();
        let pick = |values: &[Option<f64>]| -> Vec<f64> {
            known.iter().filter_map(|&k| values[k]).collect()
        };
        let frequency: Vec<f64> = known.iter().map(|&k| self.frequency[k]).collect();
        let weighted: Vec<Weighted> = known
            .iter()
            .filter_map(|&k| {
                let point = points[k]?;
                Some(Weighted {
                    omega: std::f64::consts::TAU * self.frequency[k],
                    response: point.response,
                    coherence: point.coherence,
                })
            })
            .collect();
        FrequencyResponse {
            input: self.options.inputs[input].clone(),
            output: self.options.outputs[output].clone(),
            magnitude: of(|point| point.response.norm()),
            coherence: of(|point| point.coherence),
            multiple_coherence: of(|point| point.multiple),
            random_error: of(|point| point.error),
            bandwidth: bandwidth(&frequency, &pick(&decibels), &pick(&phase)),
            transfer_function: (self.options.transfer_function)
                .and_then(|order| fitted(&weighted, order)),
            magnitude_db: decibels,
            phase_deg: phase,
        }
    }
}

/// Phases in degrees, each within half a turn of the one before.
fn unwrapped(points: &[Option<Point>]) -> Vec<Option<f64>> {
    let mut before: Option<f64> = None;
    let phase = |point: &Option<Point>| {
        let own = point.as_ref()?.response.arg().to_degrees();
        let near = before.map_or(own, |before| own + 360.0 * ((before - own) / 360.0).round());
        before = Some(near);
        Some(near)
    };
    points.iter().map(phase).collect()
}
