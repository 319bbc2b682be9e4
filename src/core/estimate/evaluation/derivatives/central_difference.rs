//! (y(θ + h) − y(θ − h)) / 2h: error h²/6 y‴ from the cut-off series, ε|y|/h from rounding (Machado 2022, eq. 4.7).

use super::perturbation::{Perturbation, size};

#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct CentralDifference {
    /// Relative to the parameter's size.
    pub(crate) step: f64,
}

impl Perturbation for CentralDifference {
    type Number = f64;
    const RUNS: usize = 2;

    fn perturbed(&self, run: usize, value: f64) -> f64 {
        let step = self.step * size(value);
        if run == 0 { value + step } else { value - step }
    }

    fn slope(&self, value: f64, _: f64, runs: &[f64]) -> f64 {
        let taken = self.perturbed(0, value) - self.perturbed(1, value);
        // a step too small to be one shows no difference
        if taken == 0.0 {
            0.0
        } else {
            (runs[0] - runs[1]) / taken
        }
    }
}
