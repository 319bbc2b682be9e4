//! The finite Fourier transform of a sampled signal as an integral over time.
//!
//! A sum over samples is the integral by rectangles, with an error that grows with frequency and with what the ends do. Here
//! the signal between samples is a polynomial, and the integral of that is exact: the sum times a weight that depends on the
//! frequency alone, and corrections from the samples next to both ends (Filon; Press and others, Numerical Recipes, sec. 13.9;
//! Morelli, NASA TM-110340, 1997).

use num_complex::Complex64;

use super::chirp_z::ChirpZ;
use super::frequencies::Frequencies;
use super::moments::moments;
use crate::stop;

/// What a signal does between its samples.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Between {
    /// The cubic through two samples at either side; at the ends, through the first or last four.
    Cubic,
    /// A straight line.
    Line,
    /// The earlier sample, held.
    Held,
}

/// ∫_0^T x(t) exp(-iωt) dt at some frequencies, of signals of one length and step.
#[derive(Clone)]
pub struct FourierIntegral {
    sums: ChirpZ,
    samples: usize,
    /// Seconds from sample to sample.
    step: f64,
    /// By frequency.
    omega: Vec<f64>,
}

/// Samples at either end that count by weights of their own.
pub(super) const AT_END: usize = 4;

/// What the integral makes of the samples: weight times sum, and corrections.
#[derive(Clone, Debug)]
pub(super) struct Rule {
    pub weight: Complex64,
    /// Of the first samples.
    pub first: [Complex64; AT_END],
    /// Of the last samples, by distance from the last, for a clock that is zero there.
    pub last: [Complex64; AT_END],
}

impl FourierIntegral {
    /// Of signals of `samples` values, `step` seconds apart, from t = 0 to the last sample.
    pub fn new(samples: usize, step: f64, frequencies: Frequencies) -> Self {
        let cycles = (frequencies.first * step, frequencies.step * step);
        Self {
            sums: ChirpZ::new(samples, cycles.0, cycles.1, frequencies.count),
            samples,
            step,
            omega: frequencies.angular().collect(),
        }
    }

    /// ω by frequency, rad/s.
    pub fn omega(&self) -> &[f64] {
        &self.omega
    }

    /// From the first sample to the last, s.
    pub fn duration(&self) -> f64 {
        self.step * (self.samples.max(1) - 1) as f64
    }

    /// exp(-iωT) by frequency.
    pub fn at_end(&self) -> Vec<Complex64> {
        let turn = |omega: &f64| Complex64::from_polar(1.0, -omega * self.duration());
        self.omega.iter().map(turn).collect()
    }

    /// The transform, by frequency. Signals of fewer than four samples have straight lines in place of cubics.
    pub fn of(&self, signal: &[f64], between: Between) -> Vec<Complex64> {
        let sums = self.sums.of(signal);
        let at_end = self.at_end();
        let between = match between {
            Between::Cubic if self.samples < AT_END => Between::Line,
            between => between,
        };
        let corrected = |k: usize| {
            stop::check_sometimes(k);
            let rule = Rule::new(between, self.omega[k] * self.step);
            let first = signal.iter().zip(rule.first);
            let first: Complex64 = first.map(|(x, weight)| weight * x).sum();
            let last = signal.iter().rev().zip(rule.last);
            let last: Complex64 = last.map(|(x, weight)| weight * x).sum();
            (rule.weight * sums[k] + first + last * at_end[k]) * self.step
        };
        (0..sums.len()).map(corrected).collect()
    }
}

/// The cubic that is 1 at `own` and 0 at the others, about the place `from`: its coefficients by power.
fn lagrange(nodes: [f64; 4], own: usize, from: f64) -> [f64; 4] {
    let mut powers = [1.0, 0.0, 0.0, 0.0];
    for (other, node) in nodes.iter().enumerate().filter(|(other, _)| *other != own) {
        let scale = 1.0 / (nodes[own] - nodes[other]);
        for p in (0..4).rev() {
            let below = if p > 0 { powers[p - 1] } else { 0.0 };
            powers[p] = (below + powers[p] * (from - node)) * scale;
        }
    }
    powers
}

impl Rule {
    pub(super) fn new(between: Between, angle: f64) -> Self {
        let zero = [Complex64::ZERO; AT_END];
        let (mut first, mut last) = (zero, zero);
        let turn = |samples: f64| Complex64::from_polar(1.0, angle * samples);
        let weight = match between {
            Between::Held => {
                let [held] = moments(angle);
                last[0] = -held;
                held
            }
            Between::Line => {
                let [level, slope] = moments(angle);
                first[0] = -slope * turn(1.0);
                // the last sample has no interval behind it
                last[0] = slope - level;
                (level - slope) + slope * turn(1.0)
            }
            Between::Cubic => return Self::cubic(angle),
        };
        Self {
            weight,
            first,
            last,
        }
    }

    /// By interval: ∫_0^1 of each of the four cubics that the interval's signal is made of.
    fn cubic(angle: f64) -> Self {
        let powers: [Complex64; 4] = moments(angle);
        let turn = |samples: f64| Complex64::from_polar(1.0, angle * samples);
        let weights = |from: f64| -> [Complex64; 4] {
            std::array::from_fn(|own| {
                let cubic = lagrange([0.0, 1.0, 2.0, 3.0], own, from);
                cubic.iter().zip(powers).map(|(c, power)| power * c).sum()
            })
        };
        // inner intervals lie between the second and third of their four samples
        let inner = weights(1.0);
        let (mut first, mut last) = (weights(0.0), [Complex64::ZERO; AT_END]);
        for (own, weight) in weights(2.0).into_iter().enumerate() {
            last[AT_END - 1 - own] = weight * turn(1.0);
        }
        let mut weight = Complex64::ZERO;
        for (place, inner) in inner.into_iter().enumerate() {
            // the sample's distance from the start of the interval
            let offset = place as f64 - 1.0;
            let share = inner * turn(offset);
            weight += share;
            // the sum runs over all samples: those that no inner interval has in this place are taken off
            for (n, first) in first.iter_mut().enumerate().take(place) {
                *first -= share * turn(-(n as f64));
            }
            for (n, last) in last.iter_mut().enumerate().take(3 - place) {
                *last -= share * turn(n as f64);
            }
        }
        Self {
            weight,
            first,
            last,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frequencies() -> Frequencies {
        Frequencies {
            first: 0.07,
            step: 0.11,
            count: 20,
        }
    }

    /// Against the integral in closed form of what each rule takes for the signal.
    #[test]
    fn polynomials_up_to_the_rules_order_are_integrated_exactly() {
        let (samples, step) = (41, 0.1);
        let integral = FourierIntegral::new(samples, step, frequencies());
        let time: Vec<f64> = (0..samples).map(|n| n as f64 * step).collect();
        let duration = integral.duration();
        for (between, degree) in [(Between::Held, 0), (Between::Line, 1), (Between::Cubic, 3)] {
            for power in 0..=degree {
                let signal: Vec<f64> = time.iter().map(|t| t.powi(power)).collect();
                let found = integral.of(&signal, between);
                for (value, &omega) in found.iter().zip(integral.omega()) {
                    // by parts, as long as the angle is not small
                    let over = Complex64::new(0.0, omega);
                    let end = Complex64::from_polar(1.0, -omega * duration);
                    let mut exact = (1.0 - end) / over;
                    for p in 1..=power {
                        exact = (exact * f64::from(p) - duration.powi(p) * end) / over;
                    }
                    let error = (value - exact).norm() / (1.0 + exact.norm());
                    assert!(error < 1e-10, "{between:?}, t^{power}, {omega}: {error:e}");
                }
            }
        }
    }

    /// ∫_0^T sin(at) exp(-iωt) dt in closed form: cubics do far better than straight lines.
    #[test]
    fn a_smooth_signal_is_integrated_to_many_digits() {
        let (samples, step, a) = (401, 0.02, 7.3);
        let integral = FourierIntegral::new(samples, step, frequencies());
        let signal: Vec<f64> = (0..samples).map(|n| (a * n as f64 * step).sin()).collect();
        let exact = |omega: f64| {
            let part = |sign: f64| {
                let rate = Complex64::new(0.0, sign * a - omega);
                ((rate * integral.duration()).exp() - 1.0) / rate
            };
            (part(1.0) - part(-1.0)) / Complex64::new(0.0, 2.0)
        };
        let worst = |between: Between| {
            let found = integral.of(&signal, between);
            let errors = found.iter().zip(integral.omega());
            errors
                .map(|(x, &omega)| (x - exact(omega)).norm())
                .fold(0.0, f64::max)
        };
        let (cubic, line) = (worst(Between::Cubic), worst(Between::Line));
        assert!(cubic < 5e-5 && cubic < 0.03 * line, "{cubic:e}, {line:e}");
    }

    #[test]
    fn very_short_signals_have_a_transform() {
        for samples in 1..5 {
            let integral = FourierIntegral::new(samples, 0.1, frequencies());
            let signal = vec![1.0; samples];
            let all = [Between::Cubic, Between::Line, Between::Held];
            let exact = integral.duration();
            for between in all {
                let found = integral.of(&signal, between);
                assert!(found.iter().all(|x| x.norm() <= exact + 1e-12), "{samples}");
            }
        }
    }
}
