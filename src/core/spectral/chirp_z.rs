//! The chirp-z transform: sums over a signal at frequencies that are evenly spaced, but need not be those of its length.
//!
//! With n k = (n² + k² - (k - n)²)/2 the sum is a convolution, which the fast Fourier transform makes (Rabiner, Schafer and
//! Rader, Bell System Technical Journal 48, 1969; Bluestein 1970).

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::stop;
use num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

/// Σ_n x_n exp(-2πi (first + k step) n) for n < `samples` and k < `count`.
#[derive(Clone)]
pub struct ChirpZ {
    samples: usize,
    /// exp(-2πi (first n + step n²/2)) by n.
    into: Vec<Complex64>,
    /// exp(-2πi step k²/2) by k.
    out: Vec<Complex64>,
    /// The transform of exp(2πi step m²/2) over m from -(samples - 1) to count - 1, wrapped, over its length.
    kernel: Vec<Complex64>,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
}

impl ChirpZ {
    /// `first` and `step` in cycles per sample.
    pub fn new(samples: usize, first: f64, step: f64, count: usize) -> Self {
        let length = (samples + count).next_power_of_two();
        let mut planner = FftPlanner::new();
        let forward = planner.plan_fft_forward(length);
        let chirp = |n: usize| turn(step, 0.5 * (n as f64) * (n as f64));
        let into = (0..samples).map(|n| {
            stop::check_sometimes(n);
            (turn(first, n as f64) * chirp(n)).conj()
        });
        let mut kernel = vec![Complex64::ZERO; length];
        for (m, value) in kernel.iter_mut().take(count).enumerate() {
            *value = chirp(m);
        }
        for m in 1..samples {
            stop::check_sometimes(m);
            kernel[length - m] = chirp(m);
        }
        forward.process(&mut kernel);
        stop::check();
        // the inverse transform is not divided by its length
        kernel.iter_mut().for_each(|value| *value /= length as f64);
        Self {
            samples,
            into: into.collect(),
            out: (0..count).map(|k| chirp(k).conj()).collect(),
            kernel,
            forward,
            inverse: planner.plan_fft_inverse(length),
        }
    }

    /// Of `samples` values.
    pub fn of(&self, signal: &[f64]) -> Vec<Complex64> {
        stop::check();
        let mut values = vec![Complex64::ZERO; self.kernel.len()];
        let turned = signal.iter().take(self.samples).zip(&self.into);
        for (value, (x, chirp)) in values.iter_mut().zip(turned) {
            *value = chirp * x;
        }
        self.forward.process(&mut values);
        stop::check();
        for (value, kernel) in values.iter_mut().zip(&self.kernel) {
            *value *= kernel;
        }
        self.inverse.process(&mut values);
        stop::check();
        let out = self.out.iter().zip(values);
        out.map(|(chirp, value)| chirp * value).collect()
    }
}

/// exp(2πi cycles times), with whole turns taken off the product before it is rounded.
fn turn(cycles: f64, times: f64) -> Complex64 {
    let product = cycles * times;
    let rest = cycles.mul_add(times, -product);
    Complex64::from_polar(1.0, TAU * ((product - product.round()) + rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_the_definition() {
        for (samples, first, step, count) in [
            (1, 0.1, 0.01, 3),
            (50, 0.013, 0.0021, 40),
            (777, 0.0, 0.37, 5),
        ] {
            let signal: Vec<f64> = (0..samples)
                .map(|n| (n as f64 * 0.71).sin() + 0.2)
                .collect();
            let found = ChirpZ::new(samples, first, step, count).of(&signal);
            for (k, value) in found.iter().enumerate() {
                let frequency = first + k as f64 * step;
                let sum: Complex64 = signal
                    .iter()
                    .enumerate()
                    .map(|(n, x)| x * turn(frequency, n as f64).conj())
                    .sum();
                assert!(
                    (value - sum).norm() < 1e-11 * samples as f64,
                    "{samples}, {k}"
                );
            }
        }
    }
}
