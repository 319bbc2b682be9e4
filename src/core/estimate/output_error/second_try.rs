//! Output error from the start that the options ask for, and once more from multiple shooting where that start was the
//! automatic one and the iteration from it ended short of a minimum.

use std::ops::ControlFlow;

use crate::estimate::answer::Solution;
use crate::estimate::descent::fallback::is_divided;
use crate::estimate::options::start::INTERVAL;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::iteration::{Iteration, Outcome};
use crate::estimate::report::progress::{Progress, Watcher};
use crate::estimate::report::start::{StartKind, StartReport};
use crate::estimate::start::find_start;
use crate::estimate::start::found::Start;
use crate::estimate::start::shooting::multiple_shooting;
use crate::stop;

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
    let first = Run::from(problem, &start, 0, watcher)?;
    if !start.may_shoot || !first.ended_short() {
        return Ok(first.solution);
    }
    let failure = format!(
        "the iteration ended {} at -ln L {:.1}",
        first.solution.estimate.outcome.name(),
        first.solution.estimate.cost
    );
    let mut told = |report: &StartReport| watcher(Progress::Start(report));
    let Ok(shot) = multiple_shooting(problem, start.theta, INTERVAL, &mut told) else {
        return Ok(first.solution);
    };
    let mut shot = Start {
        theta: shot.theta,
        stopped: shot.stopped,
        may_shoot: false,
    };
    if !shot.stopped {
        let say = format!("{failure}: once more, from multiple shooting");
        shot.stopped = first.tell(say, watcher).is_break();
    }
    let number = first.solution.estimate.iterations + 1;
    let second = match stop::droppable(|| Run::from(problem, &shot, number, watcher)) {
        Ok(Ok(second)) => second,
        Ok(Err(_)) if !shot.stopped => return Ok(first.solution),
        _ => return Ok(first.cancelled()),
    };
    let is_cancelled = second.solution.estimate.outcome == Outcome::Cancelled;
    let (kept, which) = match second.solution.estimate.cost < first.solution.estimate.cost {
        true => (second, "is kept"),
        false => (first, "is no better"),
    };
    if is_cancelled {
        return Ok(kept.cancelled());
    }
    // everything is done: too late to stop
    let _ = kept.tell(
        format!("{failure}; that from multiple shooting {which}"),
        watcher,
    );
    Ok(kept.solution)
}

/// A descent from one start.
pub(super) struct Run {
    pub solution: Solution,
    /// Slope of the cost at the end, [`Iteration::gradient_norm`].
    slope: f64,
    /// The budget was large enough for both methods.
    divided: bool,
}

impl Run {
    /// `number` is that of the first iterate: a second run counts on from the first.
    pub(super) fn from(
        problem: &Problem,
        start: &Start,
        number: usize,
        watcher: &mut Watcher<'_>,
    ) -> Result<Self, Unusable> {
        let mut stopped = start.stopped;
        let mut slope = f64::INFINITY;
        let mut observer = |iteration: &Iteration| {
            slope = iteration.gradient_norm;
            let mut iteration = iteration.clone();
            iteration.number += number;
            let told = watcher(Progress::Iteration(&iteration));
            // who asked to stop during the search for a start gets what was found so far
            if std::mem::take(&mut stopped) {
                ControlFlow::Break(())
            } else {
                told
            }
        };
        let theta = start.theta.clone();
        let mut solution = super::from(problem, theta, &mut observer)?;
        solution.estimate.iterations += number;
        Ok(Self {
            solution,
            slope,
            divided: is_divided(&problem.options),
        })
    }

    fn ended_short(&self) -> bool {
        match self.solution.estimate.outcome {
            Outcome::Diverged => true,
            Outcome::Stalled => !self.slope.is_finite() || self.slope > FLAT,
            // both methods have had their share of it
            Outcome::Budget => self.divided,
            _ => false,
        }
    }

    /// The better run, where the second was stopped on request.
    fn cancelled(self) -> Solution {
        (self.solution).stopped("trying once more, from multiple shooting")
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
