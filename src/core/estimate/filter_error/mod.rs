//! The filter-error method: maximum likelihood with process noise and measurement noise.
//!
//! ```text
//! dx = f(x, u, θ) dt + F dw,  z_k = g(x_k, u_k, θ) + v_k,  F = diag(f_i)
//! J(θ, F) = ½ Σ_k e_kᵀ R⁻¹ e_k + (N/2) ln|R| + const,  e_k = z_k - y_k
//! ```
//!
//! y_k is predicted from the sample before it by a Kalman filter of steady gain K ([`gain`], [`predictor`]). R, the
//! covariance of the innovations e, is both the weight of the cost and a part of the gain. As in the natural formulation
//! (Maine and Iliff 1981; Jategaonkar 2015, ch. 5) it is relaxed: a step of θ and F goes with R in the gain held, then
//! R follows in closed form, and F is scaled so that the gain stays about what it was. The answer is where both rest.

mod answer;
mod evaluation;
mod gain;
mod iterate;
mod layout;
mod limit;
mod lyapunov;
mod predictor;
mod relaxation;
mod riccati;
mod start;

use nalgebra::DVector;

use crate::estimate::accuracy::error_bounds::ErrorBounds;
use crate::estimate::answer::Solution;
use crate::estimate::descent::iterate::Taken;
use crate::estimate::descent::search::{
    DAMPING_EASED, DAMPING_NONE, DAMPING_RAISED, DAMPING_START, MOST_TRIALS, ROUNDING,
};
use crate::estimate::descent::step::length;
use crate::estimate::descent::stopped::Stopped;
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::options::Method;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::progress::Observer;
use iterate::{GainNoise, Iterate};
use limit::restore;
use relaxation::relaxed;

pub use evaluation::{FilterEquations, FilterEvaluator};

/// Names of the free intensities, in the order in which they follow the parameters.
pub fn process_noise_names(problem: &Problem) -> Vec<String> {
    let states = problem.model.states.iter();
    let free = states.filter(|state| {
        let asked = problem.options.process_noise.get(&state.name);
        !asked.is_some_and(|noise| noise.fixed)
    });
    free.map(|state| layout::process_noise_name(&state.name))
        .collect()
}

/// Estimates θ and F from the start values of the problem.
///
/// # Errors
/// The start values give no cost, so that there is nothing to begin with.
pub fn filter_error(problem: &Problem, observer: &mut Observer<'_>) -> Result<Solution, Unusable> {
    let mut evaluator = FilterEvaluator::new(problem)?;
    let gain_noise = GainNoise::of(&evaluator.start_noise);
    let mut z = evaluator.start();
    restore(&mut evaluator, &mut z, &gain_noise.inverse, &[])?;
    let mut current = Iterate::at(&mut evaluator, z, gain_noise)?;
    let mut taken = Taken::default();
    let mut damping = match problem.options.method {
        Method::LevenbergMarquardt => DAMPING_START,
        Method::GaussNewton => 0.0,
    };
    let mut iteration = 0;
    let stopped = loop {
        let report = current.report(&evaluator, iteration, &taken);
        if observer(&report).is_break() {
            break Stopped::OnRequest;
        }
        let Some(newton) = &current.newton else {
            break Stopped::NoDirection;
        };
        let (step, lag) = (newton.distance(), current.lag(problem));
        let distance = step.max(lag);
        if distance < problem.options.tolerance {
            break Stopped::Minimum { distance };
        }
        if iteration == problem.options.max_iterations {
            break Stopped::Budget { distance };
        }
        let found = search(&mut evaluator, &current, damping);
        let (lower, how) = match found {
            Ok(found) => found,
            // nothing is left to gain with this R in the gain, but R itself still has to follow
            Err(_) if lag > problem.options.tolerance => {
                let here = Trial {
                    z: current.z.clone(),
                    weighting: current.weighting.clone(),
                };
                let how = Taken {
                    damping,
                    ..Taken::default()
                };
                (here, how)
            }
            Err(Nothing { in_range: true }) => break Stopped::Stalled { distance },
            Err(Nothing { in_range: false }) => break Stopped::Diverged,
        };
        let Ok(next) = relaxed(&mut evaluator, &current, lower) else {
            break Stopped::Stalled { distance };
        };
        let eased = how.damping * DAMPING_EASED;
        damping = if eased < DAMPING_NONE { 0.0 } else { eased };
        (current, taken) = (next, how);
        iteration += 1;
    };
    let bounds = ErrorBounds::conventional(&current.information, &current.held);
    Ok(answer::answer(
        &mut evaluator,
        &current,
        &bounds,
        iteration,
        &stopped,
    ))
}

/// Unknowns of lower cost with the same R in the gain.
struct Trial {
    z: Vec<f64>,
    weighting: Weighting,
}

/// No unknowns of lower cost were found; were there any that could be predicted with?
struct Nothing {
    in_range: bool,
}

/// Looks for unknowns of lower cost: by halving the step (Gauss-Newton) or by damping it more (Levenberg-Marquardt).
fn search(
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
                let moved = trial.z.iter().zip(&current.z).map(|(a, b)| a - b);
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
    let mut z: Vec<f64> = current.z.iter().enumerate().map(moved).collect();
    let weight = &current.gain_noise.inverse;
    restore(evaluator, &mut z, weight, &current.limit.places)?;
    let innovations = evaluator.innovations(&z, weight, |_, _, _| {})?;
    let weighting = Weighting::at(problem, &z, &innovations)?;
    Ok(Trial { z, weighting })
}
