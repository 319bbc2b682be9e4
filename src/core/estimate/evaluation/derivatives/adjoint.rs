//! Cost and gradient by the adjoint: ∂J/∂θ = Σ (∂y_k/∂θ)ᵀ ȳ_k with ȳ_k = −R⁻¹ (z_k − y_k).
//!
//! Where R is estimated, it is that of greatest likelihood for θ, and ∂J/∂R is zero there: the gradient of the
//! concentrated cost is that with R held (Machado 2022, eq. 3.19). So R is made on the way forward, and the way
//! back needs to know no more of it.

use nalgebra::{DMatrix, DVector};

use crate::estimate::likelihood::priors;
use crate::estimate::likelihood::sums::mirror;
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::problem::missing::present;
use crate::estimate::problem::unusable::{Unusable, left_range};
use crate::estimate::problem::{Problem, set_parameters};
use crate::simulate::{Adjoint, Checkpoints};

/// Evaluates cost and gradient of a problem at any θ; buffers are kept.
pub struct CostAndGradient<'p> {
    problem: &'p Problem,
    machinery: Adjoint<'p>,
    /// By segment.
    checkpoints: Vec<Checkpoints>,
    /// The last way forward: where it was, and what came of it.
    last: Option<(Vec<f64>, Weighting)>,
    /// Ways forward so far.
    pub simulations: usize,
    /// Ways back so far.
    pub gradients: usize,
}

impl<'p> CostAndGradient<'p> {
    /// Machinery for the problem's model and integration scheme.
    pub fn new(problem: &'p Problem) -> Self {
        let options = &problem.options;
        let (integrator, interpolation) = (options.integrator, options.input_interpolation);
        Self {
            problem,
            machinery: Adjoint::new(&problem.model, integrator, interpolation),
            checkpoints: Vec::new(),
            last: None,
            simulations: 0,
            gradients: 0,
        }
    }

    /// -ln L and its gradient, by place of θ.
    ///
    /// # Errors
    /// The simulation or the cost leaves the range of numbers.
    pub fn at(&mut self, theta: &[f64]) -> Result<(f64, DVector<f64>), Unusable> {
        let weighting = self.weighting(theta)?;
        let gradient = self.gradient(theta, &weighting)?;
        Ok((weighting.cost, gradient))
    }

    /// The way forward.
    pub(crate) fn weighting(&mut self, theta: &[f64]) -> Result<Weighting, Unusable> {
        if let Some((_, weighting)) = self.last.as_ref().filter(|(at, _)| at == theta) {
            return Ok(weighting.clone());
        }
        self.last = None;
        self.simulations += 1;
        let problem = self.problem;
        let noise = &problem.options.noise;
        let outputs = problem.model.outputs.len();
        let mut sums = DMatrix::zeros(outputs, outputs);
        let (mut residual, mut parameters) = (vec![0.0; outputs], Vec::new());
        self.checkpoints.clear();
        for (index, segment) in problem.segments.iter().enumerate() {
            set_parameters(problem, index, theta, &mut parameters)?;
            let add = |k: usize, y: &[f64]| {
                for i in 0..outputs {
                    residual[i] = present(segment.measured[i][k] - y[i], segment.measured[i][k]);
                    for j in if noise.is_full() { 0..i } else { i..i } {
                        sums[(i, j)] += residual[i] * residual[j];
                    }
                    sums[(i, i)] += residual[i] * residual[i];
                }
            };
            let kept = self.machinery.forward(segment, &parameters, add);
            let kept = kept.map_err(|diverged| left_range(index, &diverged))?;
            self.checkpoints.push(kept);
        }
        mirror(&mut sums);
        if sums.iter().any(|v| !v.is_finite()) {
            return Err(Unusable::NotFinite);
        }
        let weighting = Weighting::at(problem, theta, &sums)?;
        self.last = Some((theta.to_vec(), weighting.clone()));
        Ok(weighting)
    }

    /// The way back, after the way forward with the same θ.
    fn gradient(&mut self, theta: &[f64], weighting: &Weighting) -> Result<DVector<f64>, Unusable> {
        self.gradients += 1;
        let problem = self.problem;
        let mut total = DVector::zeros(problem.unknowns.len());
        let mut residual = vec![0.0; problem.model.outputs.len()];
        let mut parameters = Vec::new();
        for (index, segment) in problem.segments.iter().enumerate() {
            problem.unknowns.parameters(index, theta, &mut parameters);
            let mut own = vec![0.0; parameters.len()];
            let seed = |k: usize, y: &[f64], to: &mut [f64]| {
                for (i, e) in residual.iter_mut().enumerate() {
                    *e = present(y[i] - segment.measured[i][k], segment.measured[i][k]);
                }
                weighting.weighted(&residual, to);
            };
            let kept = &self.checkpoints[index];
            self.machinery
                .reverse(segment, &parameters, kept, seed, &mut own);
            for (parameter, value) in own.into_iter().enumerate() {
                if let Some(place) = problem.unknowns.place(index, parameter) {
                    total[place] += value;
                }
            }
        }
        priors::add_gradient(&problem.unknowns, theta, &mut total);
        if total.iter().all(|v: &f64| v.is_finite()) {
            Ok(total)
        } else {
            Err(Unusable::NotFinite)
        }
    }

    /// Bytes in use, those of the checkpoints of the last way forward included.
    pub fn bytes(&self) -> usize {
        let kept: usize = self.checkpoints.iter().map(Checkpoints::bytes).sum();
        kept + self.machinery.bytes()
    }
}
