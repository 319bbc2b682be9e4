//! One look at the data for a θ: residuals, and with sensitivities the sums that a step is made of.

use nalgebra::DMatrix;

use super::derivatives::central_difference::CentralDifference;
use super::derivatives::complex_step::ComplexStep;
use super::derivatives::forward_difference::ForwardDifference;
use super::derivatives::perturbation::sums;
use super::evaluate::Evaluate;
use super::strand;
use super::strand::Strand;
use crate::estimate::likelihood::sums::{ResidualSums, Sums, mirror};
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::linear::products::dot;
use crate::estimate::options::technique::Derivatives;
use crate::estimate::options::{Noise, NoiseStructure};
use crate::estimate::problem::missing::present;
use crate::estimate::problem::unusable::{Unusable, left_range};
use crate::estimate::problem::{Problem, set_parameters};
use crate::simulate::{Block, Outputs};

/// Evaluates a problem at any θ; buffers are kept.
pub struct Evaluator<'p> {
    problem: &'p Problem,
    /// One for each thread; the first does what is done in turn.
    strands: Vec<Strand<'p>>,
    outputs: Outputs<'p>,
    parameters: Vec<f64>,
    full: bool,
    /// Simulations with sensitivities so far.
    pub evaluations: usize,
    /// Simulations without sensitivities so far.
    pub simulations: usize,
}

impl<'p> Evaluator<'p> {
    /// By one thread.
    pub fn new(problem: &'p Problem) -> Self {
        Self::with(problem, vec![Strand::new(problem)])
    }

    /// By several threads where there are several long segments; the numbers are the same.
    pub fn on_all_cores(problem: &'p Problem) -> Self {
        Self::with(problem, Strand::several(problem))
    }

    fn with(problem: &'p Problem, strands: Vec<Strand<'p>>) -> Self {
        let options = &problem.options;
        let full = matches!(
            options.noise,
            Noise::Estimated {
                structure: NoiseStructure::Full
            }
        );
        Self {
            problem,
            strands,
            outputs: Outputs::new(
                &problem.model,
                options.integrator,
                options.input_interpolation,
            ),
            parameters: Vec::new(),
            full,
            evaluations: 0,
            simulations: 0,
        }
    }

    /// Runs along one segment and hands outputs and sensitivities to `sink`.
    pub(crate) fn sweep(
        &mut self,
        theta: &[f64],
        segment: usize,
        sink: impl FnMut(&Block<'_>),
    ) -> Result<(), Unusable> {
        self.strands[0].run(self.problem, segment, theta, sink)
    }

    /// -ln L at a θ, R concentrated.
    ///
    /// # Errors
    /// The θ gives no cost.
    pub(crate) fn cost(&mut self, theta: &[f64]) -> Result<f64, Unusable> {
        let residuals = self.residuals(theta)?;
        Weighting::at(self.problem, theta, &residuals).map(|weighting| weighting.cost)
    }
}

impl<'p> Evaluate<'p> for Evaluator<'p> {
    fn problem(&self) -> &'p Problem {
        self.problem
    }

    fn residuals(&mut self, theta: &[f64]) -> Result<ResidualSums, Unusable> {
        self.simulations += 1;
        let problem = self.problem;
        let outputs = problem.model.outputs.len();
        let mut sums = DMatrix::zeros(outputs, outputs);
        let mut residuals = vec![Vec::new(); outputs];
        for (index, segment) in problem.segments.iter().enumerate() {
            set_parameters(problem, index, theta, &mut self.parameters)?;
            let run = self.outputs.run(segment, &self.parameters, |first, y| {
                for ((residuals, y), z) in residuals.iter_mut().zip(y).zip(&segment.measured) {
                    residuals.clear();
                    let residual = |(z, y): (&f64, &f64)| present(z - y, *z);
                    residuals.extend(z[first..].iter().zip(*y).map(residual));
                }
                for i in 0..outputs {
                    for j in if self.full { 0..=i } else { i..=i } {
                        sums[(i, j)] += dot(&residuals[i], &residuals[j]);
                    }
                }
            });
            run.map_err(|diverged| left_range(index, &diverged))?;
        }
        mirror(&mut sums);
        if sums.iter().all(|v| v.is_finite()) {
            Ok(sums)
        } else {
            Err(Unusable::NotFinite)
        }
    }

    fn sums(&mut self, theta: &[f64]) -> Result<Sums, Unusable> {
        self.evaluations += 1;
        let problem = self.problem;
        let outputs = problem.model.outputs.len();
        let unknowns = problem.unknowns.len();
        let full = self.full;
        match problem.options.derivatives {
            Derivatives::ForwardDifference { step } => {
                return sums(&ForwardDifference { step }, problem, theta, full);
            }
            Derivatives::CentralDifference { step } => {
                return sums(&CentralDifference { step }, problem, theta, full);
            }
            Derivatives::ComplexStep { step } => {
                return sums(&ComplexStep { step }, problem, theta, full);
            }
            // the adjoint has no rows of its own: where they are needed, these are
            Derivatives::ForwardSensitivities {} | Derivatives::Adjoint { .. } => {}
        }
        let mut total = Sums::zeros(outputs, unknowns, full);
        let locals = strand::sums(&mut self.strands, problem, theta, full)?;
        for (segment, local) in locals.into_iter().enumerate() {
            local.add_to(problem, segment, &mut total);
        }
        mirror(&mut total.residuals);
        total.finite()
    }
}
