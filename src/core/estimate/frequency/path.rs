//! What a lag and a delay do to a transform: 1/(1 + iωT) and exp(-iωτ).
//!
//! A record ends before all of a delayed signal has come out, and has from before its start what it does not know. Beyond the
//! ends the signal is held, as elsewhere; what the window of T seconds loses and gains by that is worked out on straight
//! lines between the samples next to the ends.

use num_complex::Complex64;

use crate::model::Element;
use crate::spectral::line_integral;

/// A factor of a signal's transform, and its derivative by the size of the element.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Passed {
    pub factor: Complex64,
    pub slope: Complex64,
}

/// What an element multiplies transforms with. Play and rate limits have no such factor, and are not let in.
pub(super) fn passed(element: Element, size: f64, omega: f64) -> Passed {
    let turn = Complex64::new(0.0, omega);
    match element {
        Element::Lag => {
            let factor = (1.0 + turn * size).inv();
            Passed {
                factor,
                slope: -turn * factor * factor,
            }
        }
        Element::Delay | Element::Play | Element::RateLimit => {
            let factor = Complex64::from_polar(1.0, -omega * size);
            Passed {
                factor,
                slope: -turn * factor,
            }
        }
    }
}

/// The samples of a signal, about its first, by which a delayed window is told from that of the record.
pub(super) struct Window {
    samples: Vec<f64>,
    step: f64,
}

impl Window {
    pub(super) fn of(samples: &[f64], step: f64) -> Self {
        let first = samples[0];
        Self {
            samples: samples.iter().map(|x| x - first).collect(),
            step,
        }
    }

    fn duration(&self) -> f64 {
        self.step * (self.samples.len() - 1) as f64
    }

    /// On straight lines between samples, held beyond the ends.
    fn at(&self, time: f64) -> f64 {
        let place = (time / self.step).clamp(0.0, (self.samples.len() - 1) as f64);
        let before = (place as usize).min(self.samples.len().saturating_sub(2));
        let share = place - before as f64;
        let after = (before + 1).min(self.samples.len() - 1);
        self.samples[before] * (1.0 - share) + self.samples[after] * share
    }

    /// ∫_a^b x(t) exp(-iωt) dt, a ≤ b.
    fn piece(&self, a: f64, b: f64, omega: f64) -> Complex64 {
        let mut sum = Complex64::ZERO;
        let mut from = a;
        while from < b {
            // to the next sample, or one step on where there are none
            let next = ((from / self.step + 1e-9).floor() + 1.0) * self.step;
            let to = next.min(b);
            sum += line_integral([from, to], [self.at(from), self.at(to)], omega);
            from = to;
        }
        sum
    }

    /// The transform of the signal `delay` seconds later, over the window of the record, from its own transform, and the
    /// derivative by the delay.
    pub(super) fn delayed(&self, own: Complex64, delay: f64, omega: f64, scale: f64) -> Passed {
        let duration = self.duration();
        let end = self.at(duration - delay);
        let window = if delay >= 0.0 {
            // before its start the signal is zero
            own - self.piece(duration - delay, duration, omega) * scale
        } else {
            let beyond = self.piece(duration, duration - delay, omega);
            own + (beyond - self.piece(0.0, -delay, omega)) * scale
        };
        let Passed { factor, .. } = passed(Element::Delay, delay, omega);
        let whole = window * factor;
        let at_end = Complex64::from_polar(end * scale, -omega * duration);
        let at_start = self.at(-delay) * scale;
        Passed {
            factor: whole,
            slope: -Complex64::new(0.0, omega) * whole - at_end + at_start,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectral::{Between, FourierIntegral, Frequencies};

    /// A delay of whole samples is known sample by sample; slopes against central differences.
    #[test]
    fn a_delayed_signal_has_the_transform_of_its_samples() {
        let (samples, step) = (60, 0.05);
        let frequencies = Frequencies {
            first: 0.21,
            step: 0.4,
            count: 5,
        };
        let integral = FourierIntegral::new(samples, step, frequencies);
        let signal: Vec<f64> = (0..samples)
            .map(|k| (k as f64 * 0.13).sin() + 0.02 * k as f64)
            .collect();
        let window = Window::of(&signal, step);
        let own = integral.of(&window.samples, Between::Line);
        for shift in [-7_i64, 0, 1, 4] {
            let delay = shift as f64 * step;
            let at = |k: i64| window.samples[k.clamp(0, samples as i64 - 1) as usize];
            let shifted: Vec<f64> = (0..samples as i64).map(|k| at(k - shift)).collect();
            let exact = integral.of(&shifted, Between::Line);
            for (k, &omega) in integral.omega().iter().enumerate() {
                let found = window.delayed(own[k], delay, omega, 1.0);
                assert!((found.factor - exact[k]).norm() < 1e-12, "{shift}, {k}");
                // off the samples, where the line has one slope
                let h = 1e-6;
                let near = delay + 0.3 * step;
                let there = |delay: f64| window.delayed(own[k], delay, omega, 1.0).factor;
                let difference = (there(near + h) - there(near - h)) / (2.0 * h);
                let slope = window.delayed(own[k], near, omega, 1.0).slope;
                assert!(
                    (slope - difference).norm() < 1e-7 * (1.0 + slope.norm()),
                    "{shift}"
                );
            }
        }
    }
}
