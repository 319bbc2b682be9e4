//! The chirp-z transform: sums over a signal at frequencies that are evenly spaced, but need not be those of its length.
//!
//! With n k = (n² + k² - (k - n)²)/2 the sum is a convolution, which the fast Fourier transform makes (Rabiner, Schafer and
//! Rader, Bell System Technical Journal 48, 1969; Bluestein 1970).

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::fast_transform::FastTransform;

/// Σ_n x_n exp(-2πi (first + k step) n) for n < `samples` and k < `count`.
#[derive(Clone, Debug)]
pub struct ChirpZ {
    samples: usize,
    /// exp(-2πi (first n + step n²/2)) by n.
    into: Vec<Complex64>,
    /// exp(-2πi step k²/2) by k.
    out: Vec<Complex64>,
    /// The transform of exp(2πi step m²/2) over m from -(samples - 1) to count - 1, wrapped.
    kernel: Vec<Complex64>,
    fast: FastTransform,
}

impl ChirpZ {
    /// `first` and `step` in cycles per sample.
    pub fn new(samples: usize, first: f64, step: f64, count: usize) -> Self {
        let fast = FastTransform::at_least(samples + count);
        let chirp = |n: usize| turn(step, 0.5 * (n as f64) * (n as f64));
        let into = (0..samples).map(|n| (turn(first, n as f64) * chirp(n)).conj());
        let mut kernel = vec![Complex64::ZERO; fast.len()];
        for (m, value) in kernel.iter_mut().take(count).enumerate() {
            *value = chirp(m);
        }
        for m in 1..samples {
            kernel[fast.len() - m] = chirp(m);
        }
        fast.forward(&mut kernel);
        Self {
            samples,
            into: into.collect(),
            out: (0..count).map(|k| chirp(k).conj()).collect(),
            kernel,
            fast,
        }
    }

    /// Of `samples` values.
    pub fn of(&self, signal: &[f64]) -> Vec<Complex64> {
        let mut values = vec![Complex64::ZERO; self.fast.len()];
        let turned = signal.iter().take(self.samples).zip(&self.into);
        for (value, (x, chirp)) in values.iter_mut().zip(turned) {
            *value = chirp * x;
        }
        self.fast.forward(&mut values);
        for (value, kernel) in values.iter_mut().zip(&self.kernel) {
            *value *= kernel;
        }
        self.fast.inverse(&mut values);
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
