//! From a recording to its frequency responses.

use num_complex::Complex64;

use super::bandwidth::bandwidth;
use super::conditioned::{Point, responses};
use super::cost;
use super::cross_spectra::{CrossSpectra, Layout, resolution};
use super::options::ResponseOptions;
use super::record::Record;
use super::report::{RecordedResponse, RecordedResponses};
use super::transfer_function::{Weighted, fitted};
use super::windows::Windows;
use crate::flight::{Fault, Maneuver};

/// Periods of a frequency that a window must hold to tell of it; of the longest window, one is enough.
const PERIODS: f64 = 5.0;

/// The responses of a recording, from all its stretches without gaps.
///
/// # Errors
/// An option is out of range; a channel is not recorded, stands still, or is a sum of others; the recording is not sampled
/// evenly, or has room for too few windows; it would take too long, or too much memory. Pointers are the options' fields.
pub fn frequency_responses(
    maneuver: &Maneuver,
    options: &ResponseOptions,
) -> Result<RecordedResponses, Vec<Fault>> {
    let record = Record::of(maneuver, options)?;
    let lengths = Windows::lengths(options, &record);
    if let Some(fault) = cost::fault(options, &record, &lengths) {
        return Err(vec![fault]);
    }
    let layout = Layout::over(options, record.step);
    let windows = Windows::over(&record, &lengths, layout, options.inputs.len())
        .map_err(|fault| vec![fault])?;
    let frequency: Vec<f64> = layout.frequencies().collect();
    let all = Measured {
        options,
        frequency: &frequency,
        spacing: layout.spacing,
        windows: &windows.usable,
        signals: options.inputs.len() + options.outputs.len(),
    };
    let found: Vec<RecordedResponse> = (0..options.outputs.len())
        .flat_map(|output| all.of_output(output))
        .collect();
    let mut magnitudes = found.iter().flat_map(|response| &response.magnitude);
    if magnitudes.all(Option::is_none) {
        let message = "at no frequency is there a response: inputs are sums of one another, or no window holds a period of the band; name fewer inputs, or a band of higher frequencies";
        return Err(vec![Fault::new("/inputs", "no_response", message)]);
    }
    Ok(RecordedResponses {
        windows: windows.usable.iter().map(|(length, _)| *length).collect(),
        left_out_windows: windows.left_out,
        responses: found,
        frequency_hz: frequency,
    })
}

struct Measured<'a> {
    options: &'a ResponseOptions,
    frequency: &'a [f64],
    /// Hz
    spacing: f64,
    /// Length, s, and spectra; longest first.
    windows: &'a [(f64, CrossSpectra)],
    signals: usize,
}

/// A frequency's responses by input, and by how much of an independent frequency it counts.
struct Composite {
    points: Vec<Point>,
    share: f64,
}

impl Measured<'_> {
    fn of_output(&self, output: usize) -> Vec<RecordedResponse> {
        let inputs = self.options.inputs.len();
        let all: Vec<Option<Composite>> = (0..self.frequency.len())
            .map(|k| self.composite(k, inputs + output))
            .collect();
        (0..inputs)
            .map(|input| self.response(input, output, &all))
            .collect()
    }

    /// Windows put together at a frequency: spectra with weights W², W = (ε/ε_least)⁻⁴ (Tischler and Remple, ch. 10).
    fn composite(&self, k: usize, output: usize) -> Option<Composite> {
        let inputs = self.options.inputs.len();
        let usable = self
            .windows
            .iter()
            .enumerate()
            .filter(|(place, (length, _))| {
                let periods = if *place == 0 { 1.0 } else { PERIODS };
                length * self.frequency[k] >= periods
            });
        let each = usable.filter_map(|(_, (length, spectra))| {
            let own = &spectra.by_frequency[k];
            let points = responses(own, self.signals, inputs, output, spectra.independent)?;
            let worst = points.iter().map(|point| point.error).fold(0.0, f64::max);
            Some((*length, spectra, worst.max(f64::MIN_POSITIVE)))
        });
        let each: Vec<(f64, &CrossSpectra, f64)> = each.collect();
        let least = each
            .iter()
            .map(|(_, _, error)| *error)
            .fold(f64::INFINITY, f64::min);
        let mut sum = vec![Complex64::ZERO; self.signals * self.signals];
        let (mut weights, mut independent, mut apart) = (0.0, 0.0, 0.0);
        for (length, spectra, error) in each {
            let weight = (error / least).powi(-8);
            let own = sum.iter_mut().zip(&spectra.by_frequency[k]);
            own.for_each(|(sum, own)| *sum += own * weight);
            weights += weight;
            independent += weight * spectra.independent;
            apart += weight * resolution(length);
        }
        if weights == 0.0 {
            return None;
        }
        sum.iter_mut().for_each(|sum| *sum /= weights);
        let points = responses(&sum, self.signals, inputs, output, independent / weights)?;
        Some(Composite {
            points,
            share: (self.spacing * weights / apart).min(1.0),
        })
    }

    fn response(&self, input: usize, output: usize, all: &[Option<Composite>]) -> RecordedResponse {
        let points: Vec<Option<Point>> = (all.iter())
            .map(|composite| Some(composite.as_ref()?.points[input]))
            .collect();
        let of = |value: fn(&Point) -> f64| -> Vec<Option<f64>> {
            points
                .iter()
                .map(|point| point.as_ref().map(value))
                .collect()
        };
        let decibels = of(|point| 20.0 * point.response.norm().log10());
        let phase = unwrapped(&points);
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
                    error: point.error,
                    independent: all[k].as_ref()?.share,
                })
            })
            .collect();
        RecordedResponse {
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
