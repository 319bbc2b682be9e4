//! Forces that the declared model does not know, and what they remember.

use crate::motion::{Added, Motion};

/// A force with states of its own.
pub(crate) trait Force {
    fn states(&self) -> usize {
        0
    }
    /// Its states in steady flight.
    fn start(&self, _motion: &Motion) -> Vec<f64> {
        Vec::new()
    }
    fn act(&self, motion: &Motion, own: &[f64], rates: &mut [f64], added: &mut Added);
}

/// A term: no memory.
pub(crate) struct Term<F>(pub F);

impl<F: Fn(&Motion, &mut Added)> Force for Term<F> {
    fn act(&self, motion: &Motion, _: &[f64], _: &mut [f64], added: &mut Added) {
        (self.0)(motion, added);
    }
}

/// A force that follows something with a first-order lag: its state w has dw/dt = (seen − w)/time.
pub(crate) struct Lagged<S, F> {
    pub time: f64,
    pub seen: S,
    pub force: F,
}

impl<S: Fn(&Motion) -> f64, F: Fn(f64, f64, &mut Added)> Force for Lagged<S, F> {
    fn states(&self) -> usize {
        1
    }
    fn start(&self, motion: &Motion) -> Vec<f64> {
        vec![(self.seen)(motion)]
    }
    fn act(&self, motion: &Motion, own: &[f64], rates: &mut [f64], added: &mut Added) {
        let seen = (self.seen)(motion);
        rates[0] = (seen - own[0]) / self.time;
        (self.force)(seen, own[0], added);
    }
}

/// A mass on a spring that something shakes: slosh, a store, a bending mode.
pub(crate) struct Oscillator<S, F> {
    /// rad/s
    pub frequency: f64,
    pub damping: f64,
    pub driven: S,
    /// From place and acceleration.
    pub force: F,
}

impl<S: Fn(&Motion) -> f64, F: Fn(f64, f64, &mut Added)> Force for Oscillator<S, F> {
    fn states(&self) -> usize {
        2
    }
    fn start(&self, motion: &Motion) -> Vec<f64> {
        vec![(self.driven)(motion), 0.0]
    }
    fn act(&self, motion: &Motion, own: &[f64], rates: &mut [f64], added: &mut Added) {
        let w = self.frequency;
        rates[0] = own[1];
        rates[1] = w * w * ((self.driven)(motion) - own[0]) - 2.0 * self.damping * w * own[1];
        (self.force)(own[0], rates[1], added);
    }
}
