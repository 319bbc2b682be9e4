//! The output-error method: Gauss-Newton or Levenberg-Marquardt on the likelihood concentrated in R.

use std::ops::ControlFlow;

use nalgebra::DVector;

use super::answer::{Solution, answer};
use super::error_bounds::ErrorBounds;
use super::evaluation::{Evaluator, Unusable};
use super::iterate::{Iterate, Taken};
use super::likelihood::Weighting;
use super::options::Method;
use super::problem::Problem;
use super::report::{Iteration, Outcome};
use super::step::advanced;

/// Told of each iteration; may stop the solver.
pub type Observer<'o> = dyn FnMut(&Iteration) -> ControlFlow<()> + 'o;

/// Damping: where it starts, what success and failure make of it, and below what it is none.
const DAMPING_START: f64 = 1e-3;
const DAMPING_EASED: f64 = 1e-2;
const DAMPING_RAISED: f64 = 10.0;
const DAMPING_NONE: f64 = 1e-10;

/// How often a step may be shortened, or the damping raised, within one iteration.
const MOST_TRIALS: usize = 16;

/// The cost is a sum over all samples: differences below this share of it are rounding.
const ROUNDING: f64 = 1e-13;

/// Estimates θ from the start values of the problem, as they stand.
///
/// # Errors
/// The start values give no cost, so that there is nothing to begin with.
pub fn output_error(problem: &Problem, observer: &mut Observer<'_>) -> Result<Solution, Unusable> {
    Ok(descend(problem, problem.unknowns.start(), observer)?.solution(problem))
}

/// Where the iteration ended, and why.
pub(super) struct Descent<'p> {
    pub evaluator: Evaluator<'p>,
    pub last: Iterate,
    pub iterations: usize,
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
        stopped,
    })
}

impl Descent<'_> {
    pub fn solution(self, problem: &Problem) -> Solution {
        let at = &self.last;
        let bounds = ErrorBounds::new(&at.information, &at.held);
        let said = self.stopped.say(problem, self.iterations, at, &bounds);
        answer(problem, at, &bounds, &self.evaluator, self.iterations, said)
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
                let weighting =
                    Weighting::new(&problem.options.noise, &residuals, problem.samples());
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

/// Why the loop ended.
enum Stopped {
    Minimum { distance: f64 },
    Budget { distance: f64 },
    Stalled { distance: f64 },
    Diverged,
    NoDirection,
    OnRequest,
}

impl Stopped {
    /// The outcome, and what to say of it.
    fn say(
        self,
        problem: &Problem,
        iterations: usize,
        at: &Iterate,
        bounds: &ErrorBounds,
    ) -> (Outcome, String) {
        match self {
            Self::Minimum { distance } => minimum(problem, at, bounds, distance),
            Self::Budget { distance } => {
                let reason = format!(
                    "the budget of {iterations} iterations is used up; a further step would move the estimate by {distance:.1e} standard errors"
                );
                (Outcome::Budget, reason)
            }
            Self::Stalled { distance } => {
                let remedy = match problem.options.method {
                    Method::GaussNewton => {
                        "; try the method levenberg_marquardt, or other start values"
                    }
                    Method::LevenbergMarquardt => "; try other start values",
                };
                let reason = format!(
                    "no step lowers the cost any more, though the next one would be {distance:.1e} standard errors long{remedy}"
                );
                (Outcome::Stalled, reason)
            }
            Self::Diverged => {
                let reason = "every step tried leads to a simulation that leaves the range of numbers; start closer, or set bounds";
                (Outcome::Diverged, reason.to_string())
            }
            Self::NoDirection => (
                Outcome::Stalled,
                "the information matrix gives no direction to go on in".to_string(),
            ),
            Self::OnRequest => (
                Outcome::Cancelled,
                format!("stopped on request after {iterations} iteration(s)"),
            ),
        }
    }
}

/// A point from which no step of any length leads further down: what kind of one.
fn minimum(
    problem: &Problem,
    at: &Iterate,
    bounds: &ErrorBounds,
    distance: f64,
) -> (Outcome, String) {
    let collinear = bounds.collinear(problem);
    if !collinear.is_empty() {
        let sets: Vec<String> = collinear
            .iter()
            .map(|set| set.parameters.join(" + "))
            .collect();
        let reason = format!(
            "the data cannot tell apart, or cannot see: {}; fix one of each set, or fly a maneuver that separates them",
            sets.join("; ")
        );
        return (Outcome::Singular, reason);
    }
    let held: Vec<String> = (0..at.held.len())
        .filter(|&place| at.held[place].is_some())
        .map(|place| problem.name(place))
        .collect();
    let reason = format!(
        "converged: a further step would move the estimate by {distance:.1e} standard errors"
    );
    if held.is_empty() {
        (Outcome::Converged, reason)
    } else {
        (
            Outcome::AtBound,
            format!("{reason}; held at a bound: {}", held.join(", ")),
        )
    }
}
