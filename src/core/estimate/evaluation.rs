//! One look at the data for a θ: residuals, and with sensitivities the sums that a step is made of.

use nalgebra::DMatrix;

use super::derivatives::{self, CentralDifference, ComplexStep, Derivatives, ForwardDifference};
use super::options::{Noise, NoiseStructure};
use super::problem::Problem;
use super::products::dot;
use super::strand::{self, Strand};
use super::sums::{ResidualSums, Sums, mirror};
use crate::simulate::{Block, Diverged, Outputs, delay_out_of_bounds};

/// Why a θ gives no cost.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Unusable {
    /// The simulation left the range of numbers.
    LeftRange { segment: usize, sample: usize },
    /// Outputs are finite, but the cost or a derivative of an output is not.
    NotFinite,
    /// The Riccati equation of the Kalman filter has no solution with which the filter is stable.
    NoSteadyGain { segment: usize },
    /// An input or output is delayed by more than [`crate::simulate::MOST_DELAY`] samples, or by no number; by its
    /// place in [`crate::model::Delays::at`].
    Delayed { segment: usize, delay: usize },
    /// The covariance of the residuals is singular: some outputs' residuals are not independent.
    SingularNoise,
    /// Equation error was asked for, and no output measures a state.
    NoMeasuredState,
}

/// Evaluates a problem at any θ; buffers are kept.
pub struct Evaluator<'p> {
    problem: &'p Problem,
    /// One for each thread; the first does what is done in turn.
    strands: Vec<Strand<'p>>,
    outputs: Outputs<'p>,
    parameters: Vec<f64>,
    full: bool,
    /// Simulations with sensitivities, and without, so far.
    pub evaluations: usize,
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
            set_parameters(problem, index, theta, &mut self.parameters)?;
            let run = self.outputs.run(segment, &self.parameters, |first, y| {
                for ((residuals, y), z) in residuals.iter_mut().zip(y).zip(&segment.measured) {
                    residuals.clear();
                    // a missing sample does not count, whatever the model says there
                    let residual = |(z, y): (&f64, &f64)| if z.is_nan() { 0.0 } else { z - y };
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

    /// Runs along one segment and hands outputs and sensitivities to `sink`.
    pub(super) fn sweep(
        &mut self,
        theta: &[f64],
        segment: usize,
        sink: impl FnMut(&Block<'_>),
    ) -> Result<(), Unusable> {
        self.strands[0].run(self.problem, segment, theta, sink)
    }

    /// Residuals and the sums of their sensitivities.
    pub(super) fn sums(&mut self, theta: &[f64]) -> Result<Sums, Unusable> {
        self.evaluations += 1;
        let problem = self.problem;
        let outputs = problem.model.outputs.len();
        let unknowns = problem.unknowns.len();
        let full = self.full;
        match problem.options.derivatives {
            Derivatives::ForwardDifference { step } => {
                return derivatives::sums(&ForwardDifference { step }, problem, theta, full);
            }
            Derivatives::CentralDifference { step } => {
                return derivatives::sums(&CentralDifference { step }, problem, theta, full);
            }
            Derivatives::ComplexStep { step } => {
                return derivatives::sums(&ComplexStep { step }, problem, theta, full);
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

/// All parameters of the model for a segment, SI.
///
/// # Errors
/// A delay is longer than any may be.
pub(super) fn set_parameters(
    problem: &Problem,
    segment: usize,
    theta: &[f64],
    parameters: &mut Vec<f64>,
) -> Result<(), Unusable> {
    (problem.unknowns).parameters(segment, theta, parameters);
    match delay_out_of_bounds(&problem.model, &problem.segments[segment], parameters) {
        Some(delay) => Err(Unusable::Delayed { segment, delay }),
        None => Ok(()),
    }
}

pub(super) fn left_range(segment: usize, diverged: &Diverged) -> Unusable {
    Unusable::LeftRange {
        segment,
        sample: diverged.sample,
    }
}
