//! One look at the data for a θ: residuals, and with sensitivities the sums that a step is made of.

use nalgebra::{DMatrix, DVector};

use super::local_sums::LocalSums;
use super::options::{Noise, NoiseStructure};
use super::problem::Problem;
use super::products::dot;
use super::sums::{ResidualSums, Sums, mirror};
use crate::simulate::{Diverged, Outputs, Sensitivities};

/// Why a θ gives no cost.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Unusable {
    /// The simulation left the range of numbers.
    LeftRange { segment: usize, sample: usize },
    /// Outputs are finite, but the cost or a derivative of an output is not.
    NotFinite,
    /// The covariance of the residuals is singular: some outputs' residuals are not independent.
    SingularNoise,
}

/// Evaluates a problem at any θ; buffers are kept.
pub struct Evaluator<'p> {
    problem: &'p Problem,
    machinery: Sensitivities<'p>,
    outputs: Outputs<'p>,
    parameters: Vec<f64>,
    full: bool,
    /// Simulations with sensitivities, and without, so far.
    pub evaluations: usize,
    pub simulations: usize,
}

impl<'p> Evaluator<'p> {
    pub fn new(problem: &'p Problem) -> Self {
        let options = &problem.options;
        let machinery = Sensitivities::new(
            &problem.model,
            &problem.columns,
            options.integrator,
            options.input_interpolation,
        );
        let full = matches!(
            options.noise,
            Noise::Estimated {
                structure: NoiseStructure::Full
            }
        );
        Self {
            problem,
            machinery,
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

    pub(super) fn problem(&self) -> &'p Problem {
        self.problem
    }

    /// Residuals alone.
    pub(super) fn residuals(&mut self, theta: &[f64]) -> Result<ResidualSums, Unusable> {
        self.simulations += 1;
        let problem = self.problem;
        let outputs = problem.model.outputs.len();
        let mut sums = DMatrix::zeros(outputs, outputs);
        let mut residuals = vec![Vec::new(); outputs];
        for (index, segment) in problem.segments.iter().enumerate() {
            problem
                .unknowns
                .parameters(index, theta, &mut self.parameters);
            let run = self.outputs.run(segment, &self.parameters, |first, y| {
                for ((residuals, y), z) in residuals.iter_mut().zip(y).zip(&segment.measured) {
                    residuals.clear();
                    residuals.extend(z[first..].iter().zip(*y).map(|(z, y)| z - y));
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

    /// Residuals and the sums of their sensitivities.
    pub(super) fn sums(&mut self, theta: &[f64]) -> Result<Sums, Unusable> {
        self.evaluations += 1;
        let problem = self.problem;
        let outputs = problem.model.outputs.len();
        let unknowns = problem.unknowns.len();
        let pairs = if self.full {
            outputs * (outputs + 1) / 2
        } else {
            outputs
        };
        let mut total = Sums {
            residuals: DMatrix::zeros(outputs, outputs),
            products: vec![DMatrix::zeros(unknowns, unknowns); pairs],
            gradients: vec![
                vec![DVector::zeros(unknowns); if self.full { outputs } else { 1 }];
                outputs
            ],
        };
        for (index, segment) in problem.segments.iter().enumerate() {
            problem
                .unknowns
                .parameters(index, theta, &mut self.parameters);
            let mut local = LocalSums::new(problem, self.full);
            self.machinery
                .run(segment, &self.parameters, |block| local.add(block, segment))
                .map_err(|diverged| left_range(index, &diverged))?;
            local.scatter(problem, index, &mut total);
        }
        mirror(&mut total.residuals);
        let finite = total.residuals.iter().all(|v| v.is_finite())
            && total
                .products
                .iter()
                .all(|product| product.iter().all(|v| v.is_finite()));
        if finite {
            Ok(total)
        } else {
            Err(Unusable::NotFinite)
        }
    }
}

fn left_range(segment: usize, diverged: &Diverged) -> Unusable {
    Unusable::LeftRange {
        segment,
        sample: diverged.sample,
    }
}
