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
pub(super) mod finer_steps;
mod gain;
mod iterate;
mod layout;
mod limit;
mod lyapunov;
mod predictor;
mod relaxation;
mod riccati;
mod search;
mod start;

use crate::estimate::accuracy::error_bounds::ErrorBounds;
use crate::estimate::answer::Solution;
use crate::estimate::descent::damping;
use crate::estimate::descent::fallback::Fallback;
use crate::estimate::descent::iterate::Taken;
use crate::estimate::descent::search::Nothing;
use crate::estimate::descent::stopped::Stopped;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::progress::Observer;
use crate::stop;
use iterate::{GainNoise, Iterate};
use limit::restore;
use relaxation::relaxed;
use search::{Trial, search};

pub use evaluation::{FilterEquations, FilterEvaluator};

/// Names of the free intensities, in the order in which they follow the parameters.
pub(crate) fn process_noise_names(problem: &Problem) -> Vec<String> {
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
    let mut xi = evaluator.start();
    restore(&mut evaluator, &mut xi, &gain_noise.inverse, &[])?;
    let mut current = Iterate::at(&mut evaluator, xi, gain_noise)?;
    let mut taken = Taken::default();
    let mut fallback = Fallback::new(&problem.options);
    let mut damping = damping::start(fallback.method());
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
        if fallback.turns_at(iteration) {
            damping = damping::start(fallback.method());
        }
        let onward = || {
            let way = (fallback.method(), &mut damping);
            let found = search(&mut evaluator, &current, way);
            // while R has still to follow, that is what comes next
            if lag > problem.options.tolerance {
                return found;
            }
            found.or_else(|nothing| {
                let method = fallback.turn();
                damping = damping::start(method);
                let other = search(&mut evaluator, &current, (method, &mut damping));
                other.map_err(|other| other.or(nothing))
            })
        };
        let Ok(found) = stop::droppable(onward) else {
            break Stopped::OnRequest;
        };
        let (lower, how) = match found {
            Ok(found) => found,
            // nothing is left to gain with this R in the gain, but R itself still has to follow
            Err(_) if lag > problem.options.tolerance => {
                let here = Trial {
                    xi: current.xi.clone(),
                    weighting: current.weighting.clone(),
                };
                (here, Taken::default())
            }
            Err(Nothing { in_range: true }) => break Stopped::Stalled { distance },
            Err(Nothing { in_range: false }) => break Stopped::Diverged,
        };
        let follow = || relaxed(&mut evaluator, &current, lower);
        let next = match stop::droppable(follow) {
            Ok(Ok(next)) => next,
            Ok(Err(_)) => break Stopped::Stalled { distance },
            Err(_) => break Stopped::OnRequest,
        };
        (current, taken) = (next, how);
        iteration += 1;
    };
    let bounds = ErrorBounds::conventional(&current.information, &current.held);
    Ok(answer::answer(
        &mut evaluator,
        &current,
        &bounds,
        iteration,
        stopped,
    ))
}
