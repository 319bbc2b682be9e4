//! Gauss-Newton or Levenberg-Marquardt on the likelihood concentrated in R.

use super::Descent;
use super::fallback::Fallback;
use super::iterate::{Iterate, Taken};
use super::search::{Nothing, Search};
use super::stopped::Stopped;
use crate::estimate::evaluation::evaluate::Evaluate;
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::progress::Observer;
use crate::stop;

/// A minimum is another one where -ln L differs by more than this.
const ANOTHER: f64 = 0.1;

/// A step that is shorter than this share of the one that the quadratic model promises is one on the spot, ...
const ON_THE_SPOT: f64 = 1e-3;

/// ... and after so many, one after the other, a method leads nowhere.
const NOWHERE: usize = 10;

/// Goes down from a θ until there is a reason to stop. Where one method has not ended when half of the budget is used up,
/// the other begins at the start again.
///
/// # Errors
/// This θ gives no cost.
pub(crate) fn descend<'p>(
    problem: &'p Problem,
    theta: Vec<f64>,
    observer: &mut Observer<'_>,
) -> Result<Descent<Evaluator<'p>>, Unusable> {
    descend_with(Evaluator::on_all_cores(problem), theta, observer)
}

/// As [`descend`], by an evaluator of any domain.
///
/// # Errors
/// This θ gives no cost.
pub(crate) fn descend_with<'p, E: Evaluate<'p>>(
    mut evaluator: E,
    theta: Vec<f64>,
    observer: &mut Observer<'_>,
) -> Result<Descent<E>, Unusable> {
    let problem = evaluator.problem();
    let start = theta.clone();
    let mut current = Iterate::at(problem, &mut evaluator, theta)?;
    let first_information = Some(current.information.clone());
    let mut fallback = Fallback::new(&problem.options);
    let mut search = Search::new(problem, fallback.method());
    let mut taken = Taken::default();
    let mut iteration = 0;
    let mut spent: Option<(Iterate, f64)> = None;
    let mut on_the_spot = 0;
    let mut has_turned = false;
    let mut stopped = loop {
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
        if fallback.turns_at(iteration) {
            let first = || Iterate::at(problem, &mut evaluator, start.clone());
            let Ok(first) = stop::droppable(first) else {
                break Stopped::OnRequest;
            };
            if let Ok(first) = first {
                search = Search::new(problem, fallback.method());
                spent = Some((std::mem::replace(&mut current, first), distance));
                (on_the_spot, has_turned) = (0, false);
                taken = Taken::default();
                iteration += 1;
                continue;
            }
        }
        if on_the_spot == NOWHERE {
            if has_turned {
                break Stopped::Corner { distance };
            }
            search = Search::new(problem, fallback.turn());
            (on_the_spot, has_turned) = (0, true);
        }
        let onward = || {
            let found = search.onward(&mut evaluator, &current, newton);
            found.or_else(|nothing| {
                search = Search::new(problem, fallback.turn());
                let other = search.onward(&mut evaluator, &current, newton);
                other.map_err(|other| other.or(nothing))
            })
        };
        let Ok(found) = stop::droppable(onward) else {
            break Stopped::OnRequest;
        };
        match found {
            Ok(found) => {
                (current, taken) = *found;
                iteration += 1;
                on_the_spot = match taken.length < ON_THE_SPOT * distance {
                    true => on_the_spot + 1,
                    false => 0,
                };
            }
            Err(Nothing { in_range: true }) => break Stopped::Stalled { distance },
            Err(Nothing { in_range: false }) => break Stopped::Diverged,
        }
    };
    // what came nearest; a minimum that lies above where the first method had come is a false one, and no end
    let ended = matches!(stopped, Stopped::Minimum { .. });
    let margin = if ended { ANOTHER } else { 0.0 };
    if let Some((nearest, distance)) =
        spent.filter(|(spent, _)| spent.weighting.cost < current.weighting.cost - margin)
    {
        current = nearest;
        // the distance that is told is that of the iterate which is kept
        if stopped.distance().is_some() {
            stopped = Stopped::Budget { distance };
        }
    }
    Ok(Descent {
        evaluator,
        first_information,
        last: current,
        iterations: iteration,
        stopped,
    })
}
