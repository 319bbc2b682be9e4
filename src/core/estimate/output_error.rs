//! The output-error method: Gauss-Newton or Levenberg-Marquardt on the likelihood concentrated in R.
//! (With the adjoint's gradient alone: `quasi_newton`.)

use std::ops::ControlFlow;

use super::answer::{Ending, Solution, answer};
use super::derivatives::Derivatives;
use super::evaluation::{Evaluator, Unusable};
use super::identifiability::DataInformation;
use super::iterate::{Iterate, Taken};
use super::problem::Problem;
use super::quasi_newton;
use super::report::Iteration;
use super::search::{Nothing, Search};
use super::stopped::Stopped;

/// Told of each iteration; may stop the solver.
pub type Observer<'o> = dyn FnMut(&Iteration) -> ControlFlow<()> + 'o;

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
    let mut evaluator = Evaluator::on_all_cores(problem);
    let mut current = Iterate::at(problem, &mut evaluator, theta)?;
    let before = DataInformation::of(problem, &current.information);
    let mut search = Search::new(problem);
    let mut taken = Taken::default();
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
        match search.onward(&mut evaluator, &current, newton) {
            Ok(found) => {
                (current, taken) = *found;
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
    pub(super) fn solution(self, problem: &Problem) -> Solution {
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
