//! Gauss-Newton or Levenberg-Marquardt on the likelihood concentrated in R.

use super::iterate::{Iterate, Taken};
use super::search::{Nothing, Search};
use super::stopped::Stopped;
use crate::estimate::answer::{Ending, Solution, answer};
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::identifiability::DataInformation;
use crate::estimate::report::progress::Observer;

/// Where the iteration ended, and why.
pub(crate) struct Descent<'p> {
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
pub(crate) fn descend<'p>(
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
    pub(crate) fn solution(self, problem: &Problem) -> Solution {
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
