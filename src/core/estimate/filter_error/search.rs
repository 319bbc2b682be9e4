//! The way from some unknowns to others of lower cost, with R in the gain held.

use nalgebra::DVector;

use super::evaluation::FilterEvaluator;
use super::iterate::Iterate;
use super::limit::restore;
use crate::estimate::descent::iterate::Taken;
use crate::estimate::descent::search::{DAMPING_RAISED, DAMPING_START, MOST_TRIALS, ROUNDING};
use crate::estimate::descent::step::length;
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::options::Method;
use crate::estimate::problem::unusable::Unusable;

/// Unknowns of lower cost with the same R in the gain.
pub(super) struct Trial {
    pub xi: Vec<f64>,
    pub weighting: Weighting,
}

/// No unknowns of lower cost were found; were there any that could be predicted with?
pub(super) struct Nothing {
    pub in_range: bool,
}

/// Looks for unknowns of lower cost: by halving the step (Gauss-Newton) or by damping it more (Levenberg-Marquardt).
pub(super) fn search(
    evaluator: &mut FilterEvaluator<'_>,
    current: &Iterate,
    start_damping: f64,
) -> Result<(Trial, Taken), Nothing> {
    let Some(newton) = &current.newton else {
        return Err(Nothing { in_range: true });
    };
    let problem = evaluator.problem;
    let most = current.weighting.cost + ROUNDING * (1.0 + current.weighting.cost.abs());
    let (mut damping, mut share) = (start_damping, 1.0);
    let mut in_range = false;
    for halvings in 0..MOST_TRIALS {
        let step = current.step(evaluator, newton, damping) * share;
        if let Ok(trial) = trial(evaluator, current, &step) {
            in_range = true;
            if trial.weighting.cost <= most {
                let moved = trial.xi.iter().zip(&current.xi).map(|(a, b)| a - b);
                let mut moved = DVector::from_iterator(step.len(), moved);
                // these follow from the others, and count with them
                current.limit.places.iter().for_each(|&i| moved[i] = 0.0);
                let length = length(&moved, &current.information);
                let taken = Taken {
                    length,
                    damping,
                    halvings,
                };
                return Ok((trial, taken));
            }
        }
        match problem.options.method {
            Method::GaussNewton => share *= 0.5,
            Method::LevenbergMarquardt => damping = (damping * DAMPING_RAISED).max(DAMPING_START),
        }
    }
    Err(Nothing { in_range })
}

/// The cost behind a step, brought back into the bounds and to the limit of the gain.
fn trial(
    evaluator: &mut FilterEvaluator<'_>,
    current: &Iterate,
    step: &DVector<f64>,
) -> Result<Trial, Unusable> {
    let problem = evaluator.problem;
    let moved = |(place, &value): (usize, &f64)| {
        let (lower, upper) = evaluator.layout.limits(problem, place);
        (value + step[place]).clamp(lower, upper)
    };
    let mut xi: Vec<f64> = current.xi.iter().enumerate().map(moved).collect();
    let weight = &current.gain_noise.inverse;
    restore(evaluator, &mut xi, weight, &current.limit.places)?;
    let innovations = evaluator.innovations(&xi, weight, |_, _, _| {})?;
    let weighting = Weighting::at(problem, &xi, &innovations)?;
    Ok(Trial { xi, weighting })
}
