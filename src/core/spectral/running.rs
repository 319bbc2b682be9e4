//! The finite Fourier transform of signals that grow by a sample at a time, perhaps with a memory that fades.
//!
//! ```text
//! X_n(f) = λ X_(n-1)(f) + x_n exp(-iω n Δt)
//! ```
//!
//! (Morelli, J. Guidance, Control, and Dynamics 23, 2000, eq. 17). What a signal does between its samples is taken into account as
//! in [`super::FourierIntegral`], so that with λ = 1 both are the same but for rounding.

use num_complex::Complex64;

use super::frequencies::Frequencies;
use super::integral::{AT_END, Between, Rule};

/// Samples from which on a transform has two ends.
const FEWEST: usize = 2 * AT_END;

/// Running transforms of some signals at some frequencies; a sample costs no allocation.
#[derive(Clone, Debug)]
pub struct RunningTransform {
    step: f64,
    /// λ.
    forgetting: f64,
    /// rad/s.
    omega: Vec<f64>,
    /// exp(-iωt) at the last sample, by frequency.
    turn: Vec<Complex64>,
    samples: usize,
    /// λ to the power of the samples since the first.
    faded: f64,
    signals: Vec<Signal>,
}

#[derive(Clone, Debug)]
struct Signal {
    /// By frequency.
    rules: Vec<Rule>,
    sums: Vec<Complex64>,
    first: [f64; AT_END],
    /// The last sample first.
    last: [f64; AT_END],
}

impl RunningTransform {
    /// Of signals that are sampled each `step` seconds, and what each does between its samples.
    pub fn new(step: f64, forgetting: f64, frequencies: Frequencies, signals: &[Between]) -> Self {
        let omega: Vec<f64> = frequencies.angular().collect();
        let signal = |&between: &Between| Signal {
            rules: (omega.iter())
                .map(|omega| Rule::new(between, omega * step))
                .collect(),
            sums: vec![Complex64::ZERO; omega.len()],
            first: [0.0; AT_END],
            last: [0.0; AT_END],
        };
        Self {
            step,
            forgetting,
            turn: vec![Complex64::ONE; omega.len()],
            samples: 0,
            faded: 1.0,
            signals: signals.iter().map(signal).collect(),
            omega,
        }
    }

    /// ω by frequency, rad/s.
    pub fn omega(&self) -> &[f64] {
        &self.omega
    }

    /// exp(-iωT) by frequency, T the time of the last sample.
    pub fn at_end(&self) -> &[Complex64] {
        &self.turn
    }

    /// What is left of the weight of the first sample.
    pub fn faded(&self) -> f64 {
        self.faded
    }

    /// Whether there are samples enough for a transform.
    pub fn is_ready(&self) -> bool {
        self.samples >= FEWEST
    }

    /// Takes in a sample of each signal.
    pub fn push(&mut self, values: &[f64]) {
        let time = self.samples as f64 * self.step;
        for (turn, omega) in self.turn.iter_mut().zip(&self.omega) {
            *turn = Complex64::from_polar(1.0, -omega * time);
        }
        for (signal, &value) in self.signals.iter_mut().zip(values) {
            signal.push(value, self.samples, self.forgetting, &self.turn);
        }
        if self.samples > 0 {
            self.faded *= self.forgetting;
        }
        self.samples += 1;
    }

    /// The transform of a signal at frequency `k`: the integral over time, each instant with the weight that is left of it.
    pub fn at(&self, signal: usize, k: usize) -> Complex64 {
        let signal = &self.signals[signal];
        let rule = &signal.rules[k];
        let first = signal.first.iter().zip(&rule.first);
        let first: Complex64 = first.map(|(x, weight)| weight * x).sum();
        let mut last = Complex64::ZERO;
        let mut left = 1.0;
        for (x, weight) in signal.last.iter().zip(&rule.last) {
            last += weight * x * left;
            left *= self.forgetting;
        }
        (rule.weight * signal.sums[k] + first * self.faded + last * self.turn[k]) * self.step
    }
}

impl Signal {
    fn push(&mut self, value: f64, before: usize, forgetting: f64, turn: &[Complex64]) {
        for (sum, turn) in self.sums.iter_mut().zip(turn) {
            *sum = *sum * forgetting + turn * value;
        }
        if before < AT_END {
            self.first[before] = value;
        }
        self.last.rotate_right(1);
        self.last[0] = value;
    }
}

#[cfg(test)]
mod tests {
    use super::super::integral::FourierIntegral;
    use super::*;

    const FREQUENCIES: Frequencies = Frequencies {
        first: 0.07,
        step: 0.11,
        count: 20,
    };

    fn signal(n: usize) -> f64 {
        (0.37 * n as f64).sin() + 0.1 * (1.9 * n as f64).cos() + 0.01 * n as f64
    }

    #[test]
    fn without_forgetting_it_is_the_transform_of_the_whole_record() {
        let step = 0.05;
        let all = [Between::Cubic, Between::Line, Between::Held];
        let mut running = RunningTransform::new(step, 1.0, FREQUENCIES, &all);
        for n in 0..200 {
            running.push(&[signal(n); 3]);
            if !running.is_ready() {
                continue;
            }
            let record: Vec<f64> = (0..=n).map(signal).collect();
            let integral = FourierIntegral::new(n + 1, step, FREQUENCIES);
            for (i, between) in all.into_iter().enumerate() {
                for (k, whole) in integral.of(&record, between).iter().enumerate() {
                    let error = (running.at(i, k) - whole).norm();
                    assert!(error < 1e-11, "{between:?}, {n}: {error:e}");
                }
            }
        }
    }

    /// ∫_0^T exp(-a (T - t)) exp(-iωt) dt with a = -ln λ / Δt, in closed form.
    #[test]
    fn forgetting_weighs_each_instant_by_its_age() {
        let (step, forgetting) = (0.02, 0.998_f64);
        let mut running = RunningTransform::new(step, forgetting, FREQUENCIES, &[Between::Line]);
        let count = 1500;
        (0..count).for_each(|_| running.push(&[1.0]));
        let (rate, end) = (-forgetting.ln() / step, (count - 1) as f64 * step);
        for (k, &omega) in running.omega().iter().enumerate() {
            let over = Complex64::new(rate, -omega);
            let exact = (Complex64::from_polar(1.0, -omega * end) - (-rate * end).exp()) / over;
            let error = (running.at(0, k) - exact).norm() / exact.norm();
            assert!(error < 2e-3, "{omega}: {error:e}");
        }
    }
}
