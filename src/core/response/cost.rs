//! What responses cost in work and memory: known, and bounded, before any of it is spent.

use super::options::ResponseOptions;
use super::record::Record;
use super::windows::Lengths;
use crate::flight::Fault;

/// Most multiplications with additions of complex numbers: some ten seconds.
const MOST_WORK: f64 = 1e10;

/// Most complex numbers of all cross spectra: 160 megabytes.
const MOST_VALUES: f64 = 1e7;

/// What of the options is more than that, and the remedy.
pub(super) fn fault(
    options: &ResponseOptions,
    record: &Record,
    lengths: &Lengths,
) -> Option<Fault> {
    let signals = (options.inputs.len() + options.outputs.len()) as f64;
    let (points, windows) = (options.points as f64, lengths.fitting.len() as f64);
    let values = windows * points * signals * signals;
    let fault = |field: &str, message: String| {
        let pointer = format!("/{field}");
        Some(Fault::new(pointer, "too_large", message))
    };
    if values > MOST_VALUES {
        let message = format!(
            "spectra of {signals} channels at {points} frequencies over windows of {windows} lengths are {values:.1e} numbers, at most {MOST_VALUES:.0e} are allowed; ask for fewer points, channels or lengths"
        );
        return fault("points", message);
    }
    let transforms = transforms(record, lengths, points, signals);
    let fits = points * (windows + 1.0) * responses(options) + fits(options, points);
    let work = transforms + fits;
    if work <= MOST_WORK {
        return None;
    }
    let message = |remedy: &str| {
        format!(
            "this takes about {work:.1e} multiplications, at most {MOST_WORK:.0e} are allowed; {remedy}"
        )
    };
    match transforms > fits {
        true => fault(
            "windows",
            message("ask for longer windows, fewer lengths of them, or fewer points"),
        ),
        false => fault("points", message("ask for fewer points or channels")),
    }
}

/// Those of all windows, and their products.
fn transforms(record: &Record, lengths: &Lengths, points: f64, signals: f64) -> f64 {
    let of_length = |&length: &usize| {
        let counts = record.stretches.iter().map(|stretch| {
            let samples = stretch[0].len();
            let hop = (length / 2).max(1);
            samples.checked_sub(length).map_or(0, |rest| rest / hop + 1)
        });
        let padded = ((length as f64) + points).log2().ceil().exp2();
        // two transforms of each signal
        let each = signals * 2.0 * padded * padded.log2() + points * signals * signals;
        counts.sum::<usize>() as f64 * each
    };
    lengths.fitting.iter().map(of_length).sum()
}

/// Of all outputs at one frequency: an inverse each.
fn responses(options: &ResponseOptions) -> f64 {
    let inputs = options.inputs.len() as f64;
    options.outputs.len() as f64 * (inputs.powi(3) + 2.0 * inputs * inputs)
}

/// Of transfer functions: rounds of linear least squares from some delays, and descents.
fn fits(options: &ResponseOptions, points: f64) -> f64 {
    let Some(order) = options.transfer_function else {
        return 0.0;
    };
    let unknowns = (order.numerator + order.denominator + 2) as f64;
    let pairs = (options.inputs.len() * options.outputs.len()) as f64;
    pairs * points * unknowns * (ROUNDS * unknowns + EVALUATIONS)
}

/// Decompositions and products of all rows, by an unknown squared.
const ROUNDS: f64 = 400.0;
/// Looks at the cost and its derivatives.
const EVALUATIONS: f64 = 2000.0;
