//! The output-error method: Gauss-Newton or Levenberg-Marquardt on the likelihood concentrated in R.
//! (With the adjoint's gradient alone: `quasi_newton`.)

use std::ops::ControlFlow;

use nalgebra::DVector;

use super::answer::{Ending, Solution, answer};
use super::derivatives::Derivatives;
use super::evaluation::{Evaluator, Unusable};
use super::identifiability::DataInformation;
use super::iterate::{Iterate, Taken};
use super::likelihood::Weighting;
use super::options::Method;
use super::problem::Problem;
use super::quasi_newton;
use super::report::Iteration;
use super::step::advanced;
use super::stopped::Stopped;

/// Told of each iteration; may stop the solver.
pub type Observer<'o> = dyn FnMut(&Iteration) -> ControlFlow<()> + 'o;

/// Damping: where it starts, what success and failure make of it, and below what it is none.
pub(super) const DAMPING_START: f64 = 1e-3;
pub(super) const DAMPING_EASED: f64 = 1e-2;
pub(super) const DAMPING_RAISED: f64 = 10.0;
pub(super) const DAMPING_NONE: f64 = 1e-10;

/// How often a step may be shortened, or the damping raised, within one iteration.
pub(super) const MOST_TRIALS: usize = 16;

/// The cost is a sum over all samples: differences below this share of it are rounding.
pub(super) const ROUNDING: f64 = 1e-13;

/// Estimates θ from the start values of the problem, as they stand.
///
/// # Errors
/// The start values give no cost, so that there is nothing to begin with.
pub fn output_error(problem: &Problem, observer: &mut Observer<'_>) -> Result<Solution, Unusable> {
    let theta = problem.unknowns.start();
    match problem.options.derivatives {
        Derivatives::Adjoint { scaling } => quasi_newton::solve(problem, theta, scaling, observer),
        _ => Ok(descend(problem, theta, observer)?.solution(problem)),
    }
}

/// Where the iteration ended, and why.
pub(super) struct Descent<'p> {
    pub evaluator: Evaluator<'p>,
    pub last: Iterate,
    pub iterations: usize,
    /// What the data told at the start.
    before: Option<DataInformation>,
    stopped: Stopped,
}

/// Goes down from a θ until there is a reason to stop.
///
/// # Errors
/// This θ gives no cost.
pub(super) fn descend<'p>(
    problem: &'p Problem,
    theta: Vec<f64>,
    observer: &mut Observer<'_>,
) -> Result<Descent<'p>, Unusable> {
    let mut evaluator = Evaluator::new(problem);
    let mut current = Iterate::at(problem, &mut evaluator, theta)?;
    let before = DataInformation::of(problem, &current.information);
    let mut taken = Taken::default();
    let mut damping = match problem.options.method {
        Method::LevenbergMarquardt => DAMPING_START,
        Method::GaussNewton => 0.0,
    };
    let mut iteration = 0;
    let stopped = loop {
        if observer(&current.report(problem, iteration, &taken)).is_break() {
            break Stopped::OnRequest;
        }
        let Some(newton) = &current.newton else {
            break Stopped::NoDirection;
        };
        let distance = newton.distance();
        if distance < problem.options.tolerance {
            break Stopped::Minimum { distance };
        }
        if iteration == problem.options.max_iterations {
            break Stopped::Budget { distance };
        }
        match search(problem, &mut evaluator, &current, damping) {
            Ok((next, how)) => {
                let eased = how.damping * DAMPING_EASED;
                damping = if eased < DAMPING_NONE { 0.0 } else { eased };
                (current, taken) = (*next, how);
                iteration += 1;
            }
            Err(Nothing { in_range: true }) => break Stopped::Stalled { distance },
            Err(Nothing { in_range: false }) => break Stopped::Diverged,
        }
    };
    Ok(Descent {
        evaluator,
        last: current,
        iterations: iteration,
        before,
        stopped,
    })
}

impl Descent<'_> {
    pub fn solution(self, problem: &Problem) -> Solution {
        let Self {
            mut evaluator,
            last,
            iterations,
            before,
            stopped,
        } = self;
        let ending = Ending {
            stopped,
            iterations,
            before,
            at: &last,
        };
        answer(problem, ending, &mut evaluator)
    }
}

/// No θ of lower cost was found; was there any that could be simulated?
struct Nothing {
    in_range: bool,
}

/// Looks for a θ of lower cost: by halving the step (Gauss-Newton) or by damping it more (Levenberg-Marquardt).
fn search(
    problem: &Problem,
    evaluator: &mut Evaluator<'_>,
    current: &Iterate,
    start_damping: f64,
) -> Result<(Box<Iterate>, Taken), Nothing> {
    let Some(newton) = &current.newton else {
        return Err(Nothing { in_range: true });
    };
    let most = current.weighting.cost + ROUNDING * (1.0 + current.weighting.cost.abs());
    let (mut damping, mut share) = (start_damping, 1.0);
    let mut in_range = false;
    for trial in 0..MOST_TRIALS {
        let step = newton.step(damping);
        let theta = advanced(&problem.unknowns, &current.theta, &step, share);
        // the first trial is nearly always taken: its sensitivities are then not worked out twice
        let worth_it = trial == 0
            || evaluator.residuals(&theta).is_ok_and(|residuals| {
                in_range = true;
                let weighting = Weighting::at(problem, &theta, &residuals);
                weighting.is_ok_and(|weighting| weighting.cost <= most)
            });
        if worth_it && let Ok(next) = Iterate::at(problem, evaluator, theta) {
            in_range = true;
            if next.weighting.cost <= most {
                let moved = next.theta.iter().zip(&current.theta).map(|(a, b)| a - b);
                let moved = DVector::from_iterator(step.len(), moved);
                let length = moved.dot(&(&current.information * &moved)).max(0.0).sqrt();
                return Ok((
                    Box::new(next),
                    Taken {
                        length,
                        damping,
                        halvings: trial,
                    },
                ));
            }
        }
        match problem.options.method {
            Method::GaussNewton => share *= 0.5,
            Method::LevenbergMarquardt => damping = (damping * DAMPING_RAISED).max(DAMPING_START),
        }
    }
    Err(Nothing { in_range })
}
