//! How far the same exact gradient gets with one optimiser and another.
//!
//! Machado 2022 reports an adjoint run that took more than 2000 iterations where the direct one, by the same
//! optimiser, took 160. An exact gradient is an exact gradient: what remains is what the optimiser makes of it.

use std::ops::ControlFlow;

use super::operations::operations;
use super::report::DescentResult;
use super::underway::{NoStudy, Study};
use crate::estimate::descent::quasi_newton::optimiser::{Optimiser, Update};
use crate::estimate::descent::quasi_newton::solve::initial_inverse;
use crate::estimate::evaluation::derivatives::adjoint::CostAndGradient;
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::options::technique::{Derivatives, Scaling};
use crate::estimate::output_error::output_error;

/// Half the square of 0.01 standard errors: so much higher than the minimum counts as there.
const THERE: f64 = 0.5e-4;

const MOST_ITERATIONS: usize = 3_000;
/// Most operations of one descent.
const MOST_OPERATIONS: u64 = 30_000_000_000;

/// Update and scaling; none is Gauss-Newton with damping, to compare with.
pub(super) const ALL: [Option<(Update, Scaling)>; 6] = [
    None,
    Some((Update::Bfgs, Scaling::Information)),
    Some((Update::Bfgs, Scaling::Sizes)),
    Some((Update::Bfgs, Scaling::None)),
    Some((Update::None, Scaling::Sizes)),
    Some((Update::None, Scaling::None)),
];

impl Study<'_, '_> {
    pub(super) fn descents(&mut self) -> Result<Vec<DescentResult>, NoStudy> {
        let minimum = self.minimum()?;
        let mut results = Vec::new();
        for how in ALL {
            let result = match how {
                None => self.gauss_newton(minimum)?,
                Some((update, scaling)) => self.descent(update, scaling, minimum)?,
            };
            let scaling = match result.scaling {
                Some(Scaling::Information) => ", scaled by the information matrix",
                Some(Scaling::Sizes) => ", scaled by the parameters' sizes",
                Some(Scaling::None) => ", unscaled",
                None => "",
            };
            let there = if result.reached { "there" } else { "not there" };
            self.tell(format!(
                "{}{scaling}: {there} after {} iterations",
                result.optimiser, result.iterations
            ))?;
            results.push(result);
        }
        Ok(results)
    }

    /// The lowest cost, by the default method.
    fn minimum(&mut self) -> Result<f64, NoStudy> {
        let mut lowest = f64::INFINITY;
        output_error(&self.problem, &mut |iteration| {
            lowest = lowest.min(iteration.cost);
            (self.listener)(None)
        })?;
        self.go_on()?;
        Ok(lowest)
    }

    fn gauss_newton(&mut self, minimum: f64) -> Result<DescentResult, NoStudy> {
        let (mut iterations, mut cost) = (0, f64::INFINITY);
        let solution = output_error(&self.problem, &mut |iteration| {
            (iterations, cost) = (iteration.number, iteration.cost);
            if cost <= minimum + THERE {
                ControlFlow::Break(())
            } else {
                (self.listener)(None)
            }
        })?;
        self.go_on()?;
        Ok(DescentResult {
            optimiser: "Gauss-Newton (damped)".to_string(),
            scaling: None,
            iterations,
            gradients: solution.estimate.evaluations,
            reached: cost <= minimum + THERE,
            cost_excess: cost - minimum,
        })
    }

    fn descent(
        &mut self,
        update: Update,
        scaling: Scaling,
        minimum: f64,
    ) -> Result<DescentResult, NoStudy> {
        let of_one = operations(&self.problem, &Derivatives::adjoint()).max(1);
        let most_gradients = (MOST_OPERATIONS / of_one).max(100) as usize;
        let problem = self.problem.clone();
        let unknowns = &problem.unknowns;
        let mut adjoint = CostAndGradient::new(&problem);
        let (cost, gradient) = adjoint.at(&self.theta)?;
        let mut evaluator = Evaluator::new(&problem);
        let (inverse, unscaled) = initial_inverse(&mut evaluator, scaling, &self.theta)?;
        let bounds = (0..unknowns.len()).map(|i| (unknowns.at(i).lower, unknowns.at(i).upper));
        let start = (self.theta.clone(), cost, gradient);
        let mut optimiser = Optimiser::new(start, bounds.unzip(), inverse, unscaled, update);
        let mut iterations = 0;
        while optimiser.cost > minimum + THERE
            && iterations < MOST_ITERATIONS
            && adjoint.gradients < most_gradients
        {
            self.go_on()?;
            let moved = optimiser.step(&mut |theta: &[f64]| adjoint.at(theta).ok());
            if moved.is_err() {
                break;
            }
            iterations += 1;
        }
        let name = match update {
            Update::Bfgs => "BFGS",
            Update::None => "steepest descent",
        };
        Ok(DescentResult {
            optimiser: name.to_string(),
            scaling: Some(scaling),
            iterations,
            gradients: adjoint.gradients,
            reached: optimiser.cost <= minimum + THERE,
            cost_excess: optimiser.cost - minimum,
        })
    }
}
