//! Residuals in blocks, drawn with replacement and laid one behind the other: what is correlated within a block stays so,
//! and so does what the outputs have in common.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::fitted::Fitted;
use super::repeated::Scatter;
use crate::estimate::accuracy::autoregression::Autoregression;

/// Of a segment, the share that a block may be: fewer blocks than these leave nothing to draw from.
const LEAST_BLOCKS: usize = 4;

/// Autocorrelations that are looked at, and what is none any more.
const MOST_LAGS: usize = 10_000;
const SILENCE: f64 = 1e-6;

/// The residuals of all segments, ready to be drawn from.
pub(super) struct Blocks {
    /// By segment, then output: without their mean, as large as the noise was, without holes.
    residuals: Vec<Vec<Vec<f64>>>,
    /// By segment: samples of a block.
    lengths: Vec<usize>,
    /// Samples of a block where a segment is long enough.
    pub length: usize,
}

impl Blocks {
    /// `length`: of a block; absent, it follows from the correlation of the residuals.
    pub(super) fn new(fitted: &Fitted, length: Option<usize>) -> Self {
        let is_given = length.is_some();
        let models = fitted.colour.models.iter().enumerate();
        let optimal = models.map(|(output, model)| optimal_length(model, fitted.count(output)));
        let length = length.unwrap_or_else(|| optimal.max().unwrap_or(1));
        let within = |samples: usize| match is_given {
            true => length.clamp(1, samples.max(1)),
            false => length.clamp(1, (samples / LEAST_BLOCKS).max(1)),
        };
        let residuals = fitted.histories.iter().map(|history| {
            let outputs = history.outputs.iter().zip(&fitted.shrunk);
            outputs
                .map(|(output, factor)| centred(&output.residual, *factor))
                .collect()
        });
        Self {
            residuals: residuals.collect(),
            lengths: (fitted.histories.iter())
                .map(|history| within(history.time.len()))
                .collect(),
            length,
        }
    }

    /// Blocks that fit into all segments together.
    pub(super) fn count(&self) -> usize {
        let samples = self.residuals.iter().map(|outputs| outputs[0].len());
        samples
            .zip(&self.lengths)
            .map(|(samples, length)| samples / length)
            .sum()
    }
}

impl Scatter for Blocks {
    fn add(&self, random: &mut ChaCha8Rng, segment: usize, outputs: &mut [Vec<f64>]) {
        let length = self.lengths[segment];
        let residuals = &self.residuals[segment];
        let samples = residuals.first().map_or(0, Vec::len);
        let mut at = 0;
        while at < samples {
            let from = random.random_range(0..=samples - length);
            let until = samples.min(at + length);
            for (output, residuals) in outputs.iter_mut().zip(residuals) {
                let drawn = &residuals[from..];
                (output[at..until].iter_mut().zip(drawn)).for_each(|(z, e)| *z += e);
            }
            at = until;
        }
    }
}

/// Residuals times a factor, less their mean; where nothing was measured, that of the next sample that was, or at the end
/// of the last.
fn centred(residuals: &[f64], factor: f64) -> Vec<f64> {
    let finite = residuals.iter().filter(|e| e.is_finite());
    let (sum, count) = finite.fold((0.0, 0), |(sum, count), e| (sum + e, count + 1));
    let mean = sum / count.max(1) as f64;
    let mut filled: Vec<f64> = residuals.iter().map(|e| (e - mean) * factor).collect();
    let mut next = filled
        .iter()
        .rev()
        .copied()
        .find(|e| e.is_finite())
        .unwrap_or(0.0);
    for e in filled.iter_mut().rev() {
        if e.is_finite() {
            next = *e;
        } else {
            *e = next;
        }
    }
    filled
}

/// The block length of least mean square error of a moving-block variance, (2 G²/D)^⅓ N^⅓ with G = Σ |k| γ_k,
/// D = (4/3) g², g = Σ γ_k (Politis and White 2004, eq. 9), γ the autocovariance of an autoregressive model in place of
/// sample values under a window.
fn optimal_length(model: &Autoregression, samples: usize) -> usize {
    if model.coefficients.is_empty() {
        return 1;
    }
    let response = response(&model.coefficients);
    let (mut weighted, mut total) = (0.0, 0.0);
    for lag in 0..response.len() {
        let pairs = response.iter().zip(&response[lag..]);
        let covariance: f64 = pairs.map(|(a, b)| a * b).sum();
        let both = if lag == 0 { 1.0 } else { 2.0 };
        total += both * covariance;
        weighted += both * lag as f64 * covariance;
    }
    let ratio = weighted / total;
    let length = (1.5 * ratio * ratio * samples as f64).cbrt();
    if length.is_finite() {
        (length.ceil() as usize).clamp(1, samples.max(1))
    } else {
        1
    }
}

/// What one innovation leaves at each later sample.
fn response(coefficients: &[f64]) -> Vec<f64> {
    let mut response = vec![1.0_f64];
    let mut quiet = 0;
    while response.len() < MOST_LAGS && quiet <= coefficients.len() {
        let before = response.iter().rev();
        let next: f64 = coefficients.iter().zip(before).map(|(a, h)| a * h).sum();
        quiet = if next.abs() < SILENCE { quiet + 1 } else { 0 };
        response.push(next);
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a first-order process G/g = 2ρ/(1 − ρ²), so that b = (1.5 (2ρ/(1 − ρ²))² N)^⅓: 40.7 at ρ = 0.9 and N = 500, 17.4
    /// at 0.6 and 1000, and the next whole number is taken.
    #[test]
    fn the_block_length_of_a_first_order_process() {
        let of = |rho: f64, samples: usize| {
            let autocovariance: Vec<f64> = (0..10).map(|lag| rho.powi(lag)).collect();
            let model = Autoregression::fit(&autocovariance, samples);
            optimal_length(&model, samples)
        };
        assert_eq!(of(0.9, 500), 41);
        assert_eq!(of(0.6, 1000), 18);
        assert_eq!(of(0.0, 1000), 1);
    }

    #[test]
    fn residuals_are_centred_and_have_no_holes() {
        let made = centred(&[f64::NAN, 1.0, f64::NAN, 3.0, f64::NAN], 2.0);
        assert_eq!(made, [-2.0, -2.0, 2.0, 2.0, 2.0]);
        assert_eq!(centred(&[f64::NAN, f64::NAN], 1.0), [0.0, 0.0]);
    }
}
