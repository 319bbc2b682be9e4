//! First-order lags, T ẏ = u - y with y_0 = u_0, in steps that are exact for a signal that is a straight line between
//! its samples, or held there.
//!
//! What is off, w = y - u, goes along samples by w_k = e w_(k-1) - g (u_k - u_(k-1)) with e = exp(-h/T) and
//! g = (1 - e) T/h. At T = 0 both are 0 and nothing is off; their derivatives by T are 0 and 1/h there, so that y has
//! its derivative -du/dt. Below 0 the signal leads by what it would lag, y = u - w(-T), so that there are derivatives
//! to both sides of 0.
//!
//! A held signal jumps at its samples, w_k = e w_(k-1) - (u_k - u_(k-1)), and what is handed on, to be held in its
//! turn, is the mean over the step: u_k + g w_k.

use super::interpolation::Axis;
use crate::model::Scalar;

#[derive(Clone, Copy, Debug)]
pub(super) struct Lag {
    /// |T|
    time: f64,
    /// -1 where the signal leads.
    pub sign: f64,
    /// Of even steps, the one that all are.
    even: Option<LagStep>,
}

/// e and g of one step, and their derivatives by |T|.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct LagStep {
    pub decay: f64,
    pub gain: f64,
    pub decay_slope: f64,
    pub gain_slope: f64,
}

impl LagStep {
    fn new(time: f64, h: f64) -> Self {
        let x = h / time;
        // what is faster is gone within the step; T = 0 among it
        if x > 700.0 {
            return Self {
                decay: 0.0,
                gain: time / h,
                decay_slope: 0.0,
                gain_slope: h.recip(),
            };
        }
        let (decay, caught_up) = ((-x).exp(), -(-x).exp_m1());
        Self {
            decay,
            gain: caught_up / x,
            decay_slope: decay * x * x / h,
            gain_slope: (caught_up - x * decay) / h,
        }
    }
}

impl Lag {
    pub(super) fn new(time: f64, axis: &Axis) -> Self {
        let sign = if time < 0.0 { -1.0 } else { 1.0 };
        let time = time.abs();
        Self {
            time,
            sign,
            even: axis.even_step().map(|h| LagStep::new(time, h)),
        }
    }

    /// The step from sample `k` to the next.
    pub(super) fn step(&self, axis: &Axis, k: usize) -> LagStep {
        self.even
            .unwrap_or_else(|| LagStep::new(self.time, axis.length(k)))
    }

    /// Passes a signal that is a straight line between samples. `beyond` is what T has beyond its real value.
    pub(super) fn pass<T: Scalar>(&self, axis: &Axis, signal: &mut [T], beyond: T) {
        let (real, sign) = (T::from_f64, T::from_f64(self.sign));
        let of = |value: f64, slope: f64| real(value) + real(slope) * (sign * beyond);
        let Some(&(mut before)) = signal.first() else {
            return;
        };
        let mut w = real(0.0);
        for (k, u) in signal.iter_mut().enumerate().skip(1) {
            let step = self.step(axis, k - 1);
            let change = *u - before;
            w = of(step.decay, step.decay_slope) * w - of(step.gain, step.gain_slope) * change;
            before = *u;
            *u = *u + sign * w;
        }
    }

    /// ∂y/∂T of what [`Self::pass`] would make of a signal.
    pub(super) fn slope(&self, axis: &Axis, signal: &[f64]) -> Vec<f64> {
        let (mut w, mut slope) = (0.0, 0.0);
        let changes = signal.windows(2).enumerate().map(|(k, pair)| {
            let (step, change) = (self.step(axis, k), pair[1] - pair[0]);
            slope = step.decay * slope + step.decay_slope * w - step.gain_slope * change;
            w = step.decay * w - step.gain * change;
            slope
        });
        std::iter::once(0.0).chain(changes).collect()
    }

    /// As [`Self::pass`], for a signal that is held between samples.
    pub(super) fn pass_held(&self, axis: &Axis, signal: &mut [f64]) {
        if signal.len() < 2 {
            return;
        }
        let (mut w, mut before) = (0.0, signal[0]);
        for (k, u) in signal.iter_mut().enumerate() {
            w = self.held_decay(axis, k).decay * w - (*u - before);
            before = *u;
            *u += self.sign * self.held(axis, k).gain * w;
        }
    }

    /// ∂y/∂T of what [`Self::pass_held`] would make of a signal.
    pub(super) fn held_slope(&self, axis: &Axis, signal: &[f64]) -> Vec<f64> {
        if signal.len() < 2 {
            return vec![0.0; signal.len()];
        }
        let (mut w, mut slope, mut before) = (0.0, 0.0, signal[0]);
        let at = |(k, &u): (usize, &f64)| {
            let past = self.held_decay(axis, k);
            slope = past.decay * slope + past.decay_slope * w;
            w = past.decay * w - (u - before);
            before = u;
            let next = self.held(axis, k);
            next.gain_slope * w + next.gain * slope
        };
        signal.iter().enumerate().map(at).collect()
    }

    /// The step over which sample `k` is held: behind the last, as long as the one before it.
    fn held(&self, axis: &Axis, k: usize) -> LagStep {
        self.step(axis, k.min(axis.last().saturating_sub(1)))
    }

    /// The step that leads to sample `k`; before the first nothing is off.
    fn held_decay(&self, axis: &Axis, k: usize) -> LagStep {
        self.step(axis, k.saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Segment, Steps, Substeps};

    const COUNT: usize = 40;

    fn axes() -> [Axis; 2] {
        let uneven = (0..COUNT - 1).map(|k| 0.02 + 0.013 * (k % 4) as f64);
        [Steps::Even(0.04), Steps::Uneven(uneven.collect())].map(|steps| {
            Axis::new(&Segment {
                label: String::new(),
                time: vec![0.0; COUNT],
                steps,
                substeps: Substeps::default(),
                inputs: Vec::new(),
                measured: Vec::new(),
            })
        })
    }

    /// Smooth with an edge in it, starting away from 0.
    fn signal() -> Vec<f64> {
        let at = |k: usize| 0.3 + (0.4 * k as f64).sin() + f64::from(u8::from(k > 17));
        (0..COUNT).map(at).collect()
    }

    /// T ẏ = u - y by a thousand implicit midpoint steps to each sample; y and its mean over each step.
    fn integrated(time: f64, axis: &Axis, signal: &[f64], held: bool) -> (Vec<f64>, Vec<f64>) {
        const FINE: usize = 1000;
        let (mut y, mut means) = (vec![signal[0]], Vec::new());
        for k in 0..signal.len() - 1 {
            let (h, mut at, mut mean) = (axis.length(k) / FINE as f64, y[k], 0.0);
            for i in 0..FINE {
                let share = if held {
                    0.0
                } else {
                    (i as f64 + 0.5) / FINE as f64
                };
                let u = signal[k] + share * (signal[k + 1] - signal[k]);
                let next = at + h * (u - at) / (time + 0.5 * h);
                mean += 0.5 * (at + next) / FINE as f64;
                at = next;
            }
            y.push(at);
            means.push(mean);
        }
        (y, means)
    }

    /// The midpoint rule is off by (h/1000T)²/12 of what is still to come.
    #[test]
    fn steps_are_those_of_the_continuous_lag() {
        for axis in axes() {
            for time in [0.01, 0.05, 0.3, 4.0] {
                let (wanted, _) = integrated(time, &axis, &signal(), false);
                let mut lagged = signal();
                Lag::new(time, &axis).pass(&axis, &mut lagged, 0.0);
                let (_, means) = integrated(time, &axis, &signal(), true);
                let mut held = signal();
                Lag::new(time, &axis).pass_held(&axis, &mut held);
                let pairs = lagged.iter().zip(&wanted).chain(held.iter().zip(&means));
                for (k, (found, wanted)) in pairs.enumerate() {
                    assert!(
                        (found - wanted).abs() < 1e-6,
                        "{time} {k}: {found} {wanted}"
                    );
                }
            }
        }
    }

    #[test]
    fn no_lag_is_the_signal_itself() {
        for axis in axes() {
            for time in [0.0, -0.0, 1e-320] {
                let mut lagged = signal();
                Lag::new(time, &axis).pass(&axis, &mut lagged, 0.0);
                assert_eq!(lagged, signal());
                Lag::new(time, &axis).pass_held(&axis, &mut lagged);
                assert_eq!(lagged, signal());
            }
        }
    }

    /// Against central differences, which at 0 are taken over both sides of it; and what is faster than a thousandth
    /// of a step joins what is slower without a jump.
    #[test]
    fn slopes_are_those_of_the_lag() {
        let both = |time: f64, axis: &Axis| {
            let (mut lagged, mut held) = (signal(), signal());
            Lag::new(time, axis).pass(axis, &mut lagged, 0.0);
            Lag::new(time, axis).pass_held(axis, &mut held);
            [lagged, held].concat()
        };
        for axis in axes() {
            for time in [0.0, 1e-5, 4e-5, 6e-5, 0.004, 0.04, 0.5, 30.0, -0.02, -1.0] {
                let step = 1e-7 * time.abs().max(0.1);
                let (above, below) = (both(time + step, &axis), both(time - step, &axis));
                let lag = Lag::new(time, &axis);
                let slopes = [
                    lag.slope(&axis, &signal()),
                    lag.held_slope(&axis, &signal()),
                ];
                for (k, slope) in slopes.concat().into_iter().enumerate() {
                    let wanted = (above[k] - below[k]) / (2.0 * step);
                    let size = wanted.abs().max(0.1);
                    assert!(
                        (slope - wanted).abs() < 1e-5 * size,
                        "{time} {k}: {slope} {wanted}"
                    );
                }
            }
        }
    }
}
