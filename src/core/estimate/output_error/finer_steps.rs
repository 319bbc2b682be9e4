//! Output error with integration steps as short as the estimate is worth: the iteration goes on from the estimate with
//! shorter ones where they are too long.

use super::second_look::with_second_look;
use super::second_try::Run;
use crate::estimate::accuracy::finer_steps::{MOST_ROUNDS, with_finer};
use crate::estimate::answer::Solution;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::progress::Watcher;
use crate::estimate::start::found::Start;
use crate::stop;

/// # Errors
/// The start gives no cost.
pub(crate) fn from_start(
    problem: &Problem,
    watcher: &mut Watcher<'_>,
) -> Result<Solution, Unusable> {
    let mut found = with_second_look(problem, watcher)?;
    let mut finer = None;
    for _ in 0..MOST_ROUNDS {
        let Some(next) = with_finer(finer.as_ref().unwrap_or(problem), &found.estimate) else {
            break;
        };
        let start = Start {
            theta: found.theta.clone(),
            stopped: false,
            may_shoot: false,
        };
        let number = found.estimate.iterations + 1;
        let solution = match stop::droppable(|| Run::from(&next, &start, number, watcher)) {
            Ok(Ok(run)) => run.solution,
            Ok(Err(_)) => break,
            Err(_) => return Ok(found.stopped("going on with shorter integration steps")),
        };
        if !solution.may_follow(&found) {
            break;
        }
        found = solution.following(found);
        finer = Some(next);
    }
    Ok(found)
}
