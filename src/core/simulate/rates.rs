//! How fast a model moves: eigenvalues of ∂f/∂x at points of a segment, against which steps are measured.

use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{DMatrix, Schur};
use num_complex::Complex64;

use super::segment::Segment;
use super::simulation::initial_state;
use crate::model::{Model, Workspace};

/// Instants at which inputs are looked at.
const INSTANTS: usize = 8;

/// What the eigenvalues at some points have in common.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Rates {
    /// The largest |λ|, 1/s.
    pub fastest: f64,
    /// The largest Re λ, 1/s; negative or 0 where nothing grows.
    pub growth: f64,
}

/// Growth, as the exponent of e, beyond which no number is left: steps of whatever length diverge.
const BOUNDLESS: f64 = 500.0;

impl Rates {
    /// Whether a simulation of so many seconds can stay in the range of numbers.
    pub(crate) fn stay_in_range(&self, duration: f64) -> bool {
        self.growth * duration < BOUNDLESS
    }

    fn add(&mut self, eigenvalue: Complex64) {
        self.fastest = self.fastest.max(eigenvalue.norm());
        self.growth = self.growth.max(eigenvalue.re);
    }

    /// The larger of each.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            fastest: self.fastest.max(other.fastest),
            growth: self.growth.max(other.growth),
        }
    }
}

/// ∂f/∂x of a model for a θ.
pub(crate) struct StateMatrixAt<'m> {
    model: &'m Model,
    workspace: Workspace<f64>,
}

impl<'m> StateMatrixAt<'m> {
    /// `parameters` are all of the model's, SI.
    pub(crate) fn new(model: &'m Model, parameters: &[f64]) -> Self {
        let program = &model.dynamics_jacobian.program;
        let mut workspace = program.workspace();
        program.set_parameters(&mut workspace, parameters);
        Self { model, workspace }
    }

    /// Whether it is the same everywhere.
    pub(crate) fn is_constant(&self) -> bool {
        let jacobian = &self.model.dynamics_jacobian;
        (0..jacobian.by_state.len()).all(|entry| !jacobian.program.varies(entry))
    }

    /// In a state at sample `k` of a segment.
    pub(crate) fn at(&mut self, segment: &Segment, k: usize, state: &[f64]) -> DMatrix<f64> {
        let jacobian = &self.model.dynamics_jacobian;
        let program = &jacobian.program;
        program.states(&mut self.workspace).copy_from_slice(state);
        for (to, samples) in (program.inputs(&mut self.workspace).iter_mut()).zip(&segment.inputs) {
            *to = samples[k];
        }
        *program.time(&mut self.workspace) = segment.time[k] - segment.time[0];
        program.run(&mut self.workspace);
        let n = self.model.states.len();
        let mut matrix = DMatrix::zeros(n, n);
        for (entry, &place) in jacobian.by_state.iter().enumerate() {
            matrix[place] = program.result(&self.workspace, entry);
        }
        matrix
    }

    /// The rates in a state; none where an entry is not finite.
    pub(crate) fn rates(&mut self, segment: &Segment, k: usize, state: &[f64]) -> Rates {
        let matrix = self.at(segment, k, state);
        let mut rates = Rates::default();
        for eigenvalue in eigenvalues(matrix) {
            rates.add(eigenvalue);
        }
        rates
    }

    /// The rates in the initial state, with the inputs of some instants of a segment.
    pub(crate) fn rates_at_start(&mut self, segment: &Segment, parameters: &[f64]) -> Rates {
        let state = initial_state(self.model, parameters);
        let instants = if self.is_constant() { 1 } else { INSTANTS };
        let last = segment.len().saturating_sub(1);
        let at = |instant: usize| instant * last / (instants.max(2) - 1);
        (0..instants)
            .map(|instant| self.rates(segment, at(instant), &state))
            .fold(Rates::default(), Rates::and)
    }
}

/// None where an entry is not finite, or there is nothing to find.
fn eigenvalues(mut matrix: DMatrix<f64>) -> Vec<Complex64> {
    if matrix.is_empty() || !matrix.iter().all(|entry| entry.is_finite()) {
        return Vec::new();
    }
    balance_parlett_reinsch(&mut matrix);
    match Schur::try_new(matrix, f64::EPSILON, 10_000) {
        Some(schur) => (schur.complex_eigenvalues().iter())
            .map(|value| Complex64::new(value.re, value.im))
            .collect(),
        None => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// λ² + 0.4 λ + 9 = 0 beside λ = -2 and λ = 0.1.
    #[test]
    fn eigenvalues_of_blocks_are_those_of_each() {
        let mut matrix = DMatrix::zeros(4, 4);
        (matrix[(0, 1)], matrix[(1, 0)], matrix[(1, 1)]) = (1.0, -9.0, -0.4);
        (matrix[(2, 2)], matrix[(3, 3)], matrix[(2, 3)]) = (-2.0, 0.1, 1e6);
        let mut rates = Rates::default();
        eigenvalues(matrix)
            .into_iter()
            .for_each(|value| rates.add(value));
        assert!((rates.fastest - 3.0).abs() < 1e-12, "{rates:?}");
        assert!((rates.growth - 0.1).abs() < 1e-12, "{rates:?}");
    }
}
