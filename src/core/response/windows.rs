//! Windows of several lengths over a recording, and which of them are too few to tell anything.

use super::cross_spectra::{CrossSpectra, Layout};
use super::options::ResponseOptions;
use super::record::Record;
use crate::flight::Fault;

/// Windows without a word: so many, the shortest by so much shorter than the longest.
const WINDOWS: usize = 5;
const SHORTEST: f64 = 0.2;

/// Least samples of a window.
const LEAST_SAMPLES: usize = 8;

/// Windows without overlap that there must be beside one for each input. As many windows as inputs explain an output altogether,
/// with a coherence of one, whatever it does; of one more, the random error is still told too small by a third.
const MORE: usize = 2;

/// The lengths of windows.
pub(super) struct Lengths {
    /// In samples, longest first: those that fit in.
    pub fitting: Vec<usize>,
    /// In seconds: those that do not, or have too few samples.
    pub others: Vec<f64>,
}

/// Spectra over windows.
pub(super) struct Windows {
    /// Length, s, and spectra; longest first.
    pub usable: Vec<(f64, CrossSpectra)>,
    /// Lengths, s, of which there are too few.
    pub left_out: Vec<f64>,
}

impl Windows {
    pub(super) fn lengths(options: &ResponseOptions, record: &Record) -> Lengths {
        let seconds: Vec<f64> = if options.windows.is_empty() {
            // five windows and more for each unknown of a frequency: a coherence of few is by chance
            let share = 2.5 * (1 + options.inputs.len()) as f64;
            let most = record.longest as f64 * record.step / share;
            let share = |i: usize| SHORTEST.powf(i as f64 / (WINDOWS - 1) as f64);
            (0..WINDOWS).map(|i| most * share(i)).collect()
        } else {
            options.windows.clone()
        };
        let mut lengths = Lengths {
            fitting: Vec::new(),
            others: Vec::new(),
        };
        for length in seconds {
            let samples = (length / record.step).round() as usize;
            match (LEAST_SAMPLES..=record.longest).contains(&samples) {
                true => lengths.fitting.push(samples),
                false => lengths.others.push(length),
            }
        }
        lengths.fitting.sort_unstable_by(|a, b| b.cmp(a));
        lengths.fitting.dedup();
        lengths
    }

    /// # Errors
    /// No length is left.
    pub(super) fn over(
        record: &Record,
        lengths: &Lengths,
        layout: Layout,
        inputs: usize,
    ) -> Result<Self, Fault> {
        let needed = inputs + MORE;
        let (mut usable, mut left_out) = (Vec::new(), lengths.others.clone());
        let mut most = 0.0_f64;
        for &length in &lengths.fitting {
            let seconds = length as f64 * record.step;
            let spectra = CrossSpectra::of(&record.stretches, length, layout);
            let count = spectra.as_ref().map_or(0.0, |spectra| spectra.independent);
            most = most.max(count);
            match spectra.filter(|_| count >= needed as f64) {
                Some(spectra) => usable.push((seconds, spectra)),
                None => left_out.push(seconds),
            }
        }
        if !usable.is_empty() {
            return Ok(Self { usable, left_out });
        }
        let longest = record.longest as f64 * record.step;
        if most == 0.0 {
            let message = format!(
                "no stretch of the recording without gaps and missing values is as long as a window, or windows have fewer than {LEAST_SAMPLES} samples; the longest stretch has {longest:.2} s"
            );
            return Err(Fault::new("/windows", "too_few_samples", message));
        }
        let message = format!(
            "windows fit in {most:.1} times at most without overlap, and with {inputs} input(s) there must be {needed}: the coherence of fewer is near one by chance; choose windows of {:.2} s or less, or a longer recording",
            longest / needed as f64
        );
        Err(Fault::new("/windows", "too_few_windows", message))
    }
}
