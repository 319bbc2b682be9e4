//! Output error from the start that the options ask for, and once more from multiple shooting where that start was the
//! automatic one and the iteration from it ended short of a minimum.

use std::ops::ControlFlow;

use super::answer::Solution;
use super::derivatives::Derivatives;
use super::estimator::{Progress, Watcher};
use super::evaluation::Unusable;
use super::output_error::descend;
use super::problem::Problem;
use super::quasi_newton;
use super::report::{Iteration, Outcome};
use super::shooting::multiple_shooting;
use super::start::{INTERVAL, Start, StartKind, StartReport, find_start};

/// A stalled iteration is at its minimum, but for rounding, where the cost slopes by less than this over one standard
/// error.
const FLAT: f64 = 0.01;

/// # Errors
/// The start gives no cost.
pub(super) fn from_start(
    problem: &Problem,
    watcher: &mut Watcher<'_>,
) -> Result<Solution, Unusable> {
    let start = find_start(problem, watcher)?;
    let first = Run::from(problem, &start, watcher)?;
    if !start.may_shoot || !first.ended_short() {
        return Ok(first.solution);
    }
    let mut told = |report: &StartReport| watcher(Progress::Start(report));
    let Ok(shot) = multiple_shooting(problem, start.theta, INTERVAL, &mut told) else {
        return Ok(first.solution);
    };
    let failure = format!(
        "the iteration ended {} at -ln L {:.1}",
        first.solution.estimate.outcome.name(),
        first.solution.estimate.cost
    );
    let say = format!("{failure}: once more, from multiple shooting");
    if shot.stopped || first.tell(say, watcher).is_break() {
        return Ok(first.solution);
    }
    let Ok(second) = Run::from(problem, &shot, watcher) else {
        return Ok(first.solution);
    };
    let (kept, which) = match second.solution.estimate.cost < first.solution.estimate.cost {
        true => (second, "is kept"),
        false => (first, "is no better"),
    };
    // everything is done: too late to stop
    let _ = kept.tell(
        format!("{failure}; that from multiple shooting {which}"),
        watcher,
    );
    Ok(kept.solution)
}

struct Run {
    solution: Solution,
    /// Slope of the cost at the end, [`Iteration::gradient_norm`].
    slope: f64,
}

impl Run {
    fn from(problem: &Problem, start: &Start, watcher: &mut Watcher<'_>) -> Result<Self, Unusable> {
        let mut stopped = start.stopped;
        let mut slope = f64::INFINITY;
        let mut observer = |iteration: &Iteration| {
            slope = iteration.gradient_norm;
            let told = watcher(Progress::Iteration(iteration));
            // who asked to stop during the search for a start gets what was found so far
            if std::mem::take(&mut stopped) {
                ControlFlow::Break(())
            } else {
                told
            }
        };
        let theta = start.theta.clone();
        let solution = match problem.options.derivatives {
            Derivatives::Adjoint { scaling } => {
                quasi_newton::solve(problem, theta, scaling, &mut observer)?
            }
            _ => descend(problem, theta, &mut observer)?.solution(problem),
        };
        Ok(Self { solution, slope })
    }

    fn ended_short(&self) -> bool {
        match self.solution.estimate.outcome {
            Outcome::Diverged => true,
            Outcome::Stalled => !self.slope.is_finite() || self.slope > FLAT,
            _ => false,
        }
    }

    fn tell(&self, text: String, watcher: &mut Watcher<'_>) -> ControlFlow<()> {
        let found = &self.solution.estimate;
        watcher(Progress::Start(&StartReport {
            method: StartKind::MultipleShooting,
            evaluations: found.evaluations + found.simulations,
            cost: Some(found.cost),
            text,
        }))
    }
}
