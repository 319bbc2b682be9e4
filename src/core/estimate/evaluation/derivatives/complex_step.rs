//! Im y(θ + ih) / h: no difference is taken, so that h can be as small as numbers go (Machado 2022, eq. 4.10).

use num_complex::Complex64;

use super::perturbation::Perturbation;

#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct ComplexStep {
    /// Relative to the parameter's size, which counts as 1 at least.
    pub(crate) step: f64,
}

impl ComplexStep {
    /// There is no cancellation to fear from a large step, but underflow from a small one.
    fn taken(&self, value: f64) -> f64 {
        self.step * value.abs().max(1.0)
    }
}

impl Perturbation for ComplexStep {
    type Number = Complex64;
    const RUNS: usize = 1;

    fn perturbed(&self, _: usize, value: f64) -> Complex64 {
        Complex64::new(value, self.taken(value))
    }

    fn slope(&self, value: f64, _: f64, runs: &[Complex64]) -> f64 {
        runs[0].im / self.taken(value)
    }
}
