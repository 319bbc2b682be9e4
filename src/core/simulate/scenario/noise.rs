//! Measurement noise of a scenario: white, or coloured as real residuals are.

use std::f64::consts::{PI, SQRT_2};

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

/// The spectrum of a noise; its standard deviation is given apart from it.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum NoiseColour {
    /// Samples are independent.
    #[default]
    White,
    /// A first-order Gauss-Markov process: autocorrelation exp(-lag/correlation_time), s.
    FirstOrder {
        /// The lag at which the autocorrelation has fallen to 1/e, s.
        correlation_time: f64,
    },
    /// White noise behind a second-order Butterworth low-pass of this bandwidth, Hz.
    BandLimited {
        /// The frequency at which the power has fallen to one half, Hz.
        bandwidth: f64,
    },
}

impl NoiseColour {
    /// What is wrong with it for samples `step` seconds apart.
    pub(super) fn fault(self, step: f64, count: usize) -> Option<String> {
        let duration = step * count as f64;
        match self {
            Self::White => None,
            Self::FirstOrder { correlation_time } => (!(correlation_time > 0.0
                && correlation_time <= duration))
                .then(|| format!("correlation_time must be above 0 and at most {duration} s")),
            Self::BandLimited { bandwidth } => {
                let (least, most) = (1.0 / duration, 0.45 / step);
                (!(least..=most).contains(&bandwidth))
                    .then(|| format!("bandwidth must be from {least} to {most} Hz"))
            }
        }
    }

    /// `count` samples of unit variance, stationary from the first.
    pub(super) fn samples(self, step: f64, count: usize, random: &mut ChaCha8Rng) -> Vec<f64> {
        let mut white = || -> f64 { StandardNormal.sample(random) };
        match self {
            Self::White => (0..count).map(|_| white()).collect(),
            Self::FirstOrder { correlation_time } => {
                let kept = (-step / correlation_time).exp();
                let fresh = (1.0 - kept * kept).sqrt();
                let mut value = white();
                let next = |_| {
                    let now = value;
                    value = kept * value + fresh * white();
                    now
                };
                (0..count).map(next).collect()
            }
            Self::BandLimited { bandwidth } => {
                let mut filter = LowPass::new(bandwidth * step);
                // in ten times 1/(2π bandwidth) the filter has forgotten how it began
                let settling = (10.0 / (2.0 * PI * bandwidth * step)).ceil() as usize + 2;
                let mut response = LowPass::new(bandwidth * step);
                let power: f64 = (0..=settling)
                    .map(|k| response.next(if k == 0 { 1.0 } else { 0.0 }).powi(2))
                    .sum();
                (0..settling).for_each(|_| {
                    filter.next(white());
                });
                (0..count)
                    .map(|_| filter.next(white()) / power.sqrt())
                    .collect()
            }
        }
    }
}

/// Second-order Butterworth low-pass, by the bilinear transformation.
struct LowPass {
    gain: f64,
    feedback: [f64; 2],
    inputs: [f64; 2],
    outputs: [f64; 2],
}

impl LowPass {
    /// `bandwidth` in cycles a sample.
    fn new(bandwidth: f64) -> Self {
        let k = (PI * bandwidth).tan();
        let scale = 1.0 + SQRT_2 * k + k * k;
        Self {
            gain: k * k / scale,
            feedback: [
                2.0 * (k * k - 1.0) / scale,
                (1.0 - SQRT_2 * k + k * k) / scale,
            ],
            inputs: [0.0; 2],
            outputs: [0.0; 2],
        }
    }

    fn next(&mut self, input: f64) -> f64 {
        let [u1, u2] = self.inputs;
        let [y1, y2] = self.outputs;
        let output =
            self.gain * (input + 2.0 * u1 + u2) - self.feedback[0] * y1 - self.feedback[1] * y2;
        self.inputs = [input, u1];
        self.outputs = [output, y1];
        output
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::*;

    /// Of 200 000 samples with at least 5000 of them independent, variance and correlation are known to 2 %;
    /// three times that is allowed.
    #[test]
    fn variance_and_correlation_are_those_asked_for() {
        let first_order = NoiseColour::FirstOrder {
            correlation_time: 0.2,
        };
        let band_limited = NoiseColour::BandLimited { bandwidth: 2.0 };
        // a Butterworth's autocorrelation is exp(-w) (cos w + sin w) at w = 2π f lag / √2
        let w = 2.0 * PI * 2.0 * 0.08 / SQRT_2;
        let butterworth = (-w).exp() * (w.cos() + w.sin());
        let cases = [
            (NoiseColour::White, 0.0),
            (first_order, (-0.4_f64).exp()),
            (band_limited, butterworth),
        ];
        for (colour, expected) in cases {
            let mut random = ChaCha8Rng::seed_from_u64(1);
            let e = colour.samples(0.04, 200_000, &mut random);
            let n = e.len() as f64;
            let variance = e.iter().map(|v| v * v).sum::<f64>() / n;
            let at_two = e.iter().zip(&e[2..]).map(|(a, b)| a * b).sum::<f64>() / n;
            assert!((variance - 1.0).abs() < 0.06, "{colour:?}: {variance}");
            assert!(
                (at_two - expected).abs() < 0.06,
                "{colour:?}: {at_two}, not {expected}"
            );
        }
    }
}
