//! (y(θ + h) − y(θ)) / h: error h/2 y″ from the cut-off series, ε|y|/h from rounding (Machado 2022, eq. 4.4).

use super::perturbation::{Perturbation, size};

#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct ForwardDifference {
    /// Relative to the parameter's size.
    pub(crate) step: f64,
}

impl Perturbation for ForwardDifference {
    type Number = f64;
    const RUNS: usize = 1;

    fn perturbed(&self, _: usize, value: f64) -> f64 {
        value + self.step * size(value)
    }

    fn slope(&self, value: f64, y: f64, runs: &[f64]) -> f64 {
        // the step as it was taken, not as it was meant: θ + h is rounded
        let taken = self.perturbed(0, value) - value;
        // a step too small to be one shows no difference
        if taken == 0.0 {
            0.0
        } else {
            (runs[0] - y) / taken
        }
    }
}
