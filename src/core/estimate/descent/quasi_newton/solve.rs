//! The descent of output error by the adjoint's gradient and BFGS.

use nalgebra::{DMatrix, DVector};

use super::optimiser::{Optimiser, Update};
use crate::estimate::descent::Descent;
use crate::estimate::descent::iterate::Iterate;
use crate::estimate::descent::step::Newton;
use crate::estimate::descent::stopped::Stopped;
use crate::estimate::evaluation::derivatives::adjoint::CostAndGradient;
use crate::estimate::evaluation::derivatives::perturbation::size;
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::evaluation::normal_equations::NormalEquations;
use crate::estimate::linear::spectrum::Spectrum;
use crate::estimate::options::technique::Scaling;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::iteration::Iteration;
use crate::estimate::report::progress::Observer;
use crate::stop;

/// How often the end of the descent may turn out to be none: the information matrix is then taken for the
/// Hessian, and the descent goes on.
const MOST_RESTARTS: usize = 3;

/// The first idea of the inverse Hessian, and whether its scale is still to be found.
pub(crate) fn initial_inverse(
    evaluator: &mut Evaluator<'_>,
    scaling: Scaling,
    theta: &[f64],
) -> Result<(DMatrix<f64>, bool), Unusable> {
    let n = theta.len();
    match scaling {
        Scaling::None => Ok((DMatrix::identity(n, n), true)),
        Scaling::Sizes => {
            let square = |v: &f64| size(*v).powi(2);
            let squares = DVector::from_iterator(n, theta.iter().map(square));
            Ok((DMatrix::from_diagonal(&squares), true))
        }
        Scaling::Information => {
            let information = NormalEquations::at(evaluator, theta)?.information;
            Ok((inverse(&information).ok_or(Unusable::NotFinite)?, false))
        }
    }
}

/// Over the directions that the data see.
fn inverse(information: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    Spectrum::of(information, &information.diagonal()).map(|spectrum| spectrum.inverse())
}

/// Goes down from a θ until there is a reason to stop.
///
/// # Errors
/// This θ gives no cost.
pub(crate) fn descend<'p>(
    problem: &'p Problem,
    theta: Vec<f64>,
    scaling: Scaling,
    observer: &mut Observer<'_>,
) -> Result<Descent<Evaluator<'p>>, Unusable> {
    let unknowns = &problem.unknowns;
    let mut evaluator = Evaluator::new(problem);
    let mut adjoint = CostAndGradient::new(problem);
    let (cost, gradient) = adjoint.at(&theta)?;
    let (inverse_hessian, unscaled) = initial_inverse(&mut evaluator, scaling, &theta)?;
    let bounds = (0..unknowns.len()).map(|i| (unknowns.at(i).lower, unknowns.at(i).upper));
    let mut optimiser = Optimiser::new(
        (theta, cost, gradient),
        bounds.unzip(),
        inverse_hessian,
        unscaled,
        Update::Bfgs,
    );
    let (mut iteration, mut restarts) = (0, 0);
    let first = report(problem, &mut adjoint, &optimiser, 0, 0.0)?;
    let mut told_to_stop = observer(&first).is_break();
    let (stopped, last) = loop {
        let out_of_budget = iteration == problem.options.max_iterations;
        let at_end = optimiser.distance() < problem.options.tolerance;
        if !(told_to_stop || out_of_budget || at_end) {
            let mut objective = |theta: &[f64]| adjoint.at(theta).ok();
            match stop::droppable(|| optimiser.step(&mut objective)) {
                Ok(Ok(moved)) => {
                    iteration += 1;
                    let length = moved.length;
                    let report = report(problem, &mut adjoint, &optimiser, iteration, length)?;
                    told_to_stop = observer(&report).is_break();
                    continue;
                }
                Ok(Err(_)) => {}
                Err(_) => told_to_stop = true,
            }
        }
        // the Hessian gathered so far may be wrong: look at the information matrix itself
        let last = Iterate::at(problem, &mut evaluator, optimiser.theta.clone())?;
        let Some(distance) = last.newton.as_ref().map(Newton::distance) else {
            break (Stopped::NoDirection, last);
        };
        if told_to_stop {
            break (Stopped::OnRequest, last);
        }
        if distance < problem.options.tolerance {
            break (Stopped::Minimum { distance }, last);
        }
        if out_of_budget {
            break (Stopped::Budget { distance }, last);
        }
        match inverse(&last.information) {
            Some(inverse) if restarts < MOST_RESTARTS => optimiser.restart(inverse),
            _ => break (Stopped::Stalled { distance }, last),
        }
        restarts += 1;
    };
    evaluator.evaluations += adjoint.gradients;
    // a way forward that was kept serves more than one way back
    evaluator.simulations += adjoint.simulations.saturating_sub(adjoint.gradients);
    Ok(Descent {
        evaluator,
        first_information: None,
        last,
        iterations: iteration,
        stopped,
    })
}

fn report(
    problem: &Problem,
    adjoint: &mut CostAndGradient<'_>,
    at: &Optimiser,
    number: usize,
    step: f64,
) -> Result<Iteration, Unusable> {
    let weighting = adjoint.weighting(&at.theta)?;
    Ok(Iteration {
        number,
        cost: at.cost,
        det_r: weighting.det(),
        variance: weighting.covariance.diagonal().iter().copied().collect(),
        parameters: problem.in_own_units(&at.theta),
        gradient_norm: at.gradient.component_mul(&at.errors()).norm(),
        step,
        damping: 0.0,
        halvings: 0,
    })
}
