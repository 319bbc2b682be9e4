//! The start that needs no choice: the better of the document's values and those of equation error.

use super::equation_error::equation_error_start;
use super::found::Start;
use super::shooting::multiple_shooting;
use crate::estimate::evaluation::evaluate::Evaluate;
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::likelihood::constants::cost_of_constants;
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::options::start::INTERVAL;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::progress::{Progress, Watcher, unobserved};
use crate::estimate::report::start::{StartKind, StartReport};

/// # Errors
/// What is wrong with the document's start values, where nothing else gives a cost either.
pub(crate) fn automatic(problem: &Problem, watcher: &mut Watcher<'_>) -> Result<Start, Unusable> {
    let mut evaluator = Evaluator::new(problem);
    let document = problem.unknowns.start();
    let of_document = startable(&mut evaluator, &document);
    let mut best = Candidate {
        kind: StartKind::Document,
        theta: document,
        cost: of_document.ok(),
    };
    let mut evaluations = 2;
    let regression = equation_error_start(problem, &mut unobserved).ok();
    if let Some((theta, count)) = &regression {
        evaluations += count;
        let cost = startable(&mut evaluator, theta).ok();
        if is_lower(cost, best.cost) || best.cost.is_none() {
            best = Candidate {
                kind: StartKind::EquationError,
                theta: theta.clone(),
                cost,
            };
        }
    }
    let mut stopped = false;
    let shoots = regression.is_some() && !is_lower(best.cost, cost_of_constants(problem));
    if shoots {
        let mut told = |report: &StartReport| watcher(Progress::Start(report));
        let shot = multiple_shooting(problem, best.theta.clone(), INTERVAL, &mut told);
        if let Ok(shot) = shot {
            stopped = shot.stopped;
            let cost = startable(&mut evaluator, &shot.theta).ok();
            if is_lower(cost, best.cost) {
                best = Candidate {
                    kind: StartKind::MultipleShooting,
                    theta: shot.theta,
                    cost,
                };
            }
        }
    }
    if best.cost.is_none() {
        of_document?;
    }
    let report = StartReport {
        method: best.kind,
        evaluations,
        cost: best.cost,
        text: best.text(of_document.ok()),
    };
    stopped |= watcher(Progress::Start(&report)).is_break();
    Ok(Start {
        theta: best.theta,
        stopped,
        may_shoot: regression.is_some() && !shoots,
    })
}

/// -ln L at a θ from which the iteration can begin: sensitivities are finite too.
fn startable(evaluator: &mut Evaluator<'_>, theta: &[f64]) -> Result<f64, Unusable> {
    let sums = evaluator.sums(theta)?;
    let problem = evaluator.problem();
    Weighting::at(problem, theta, &sums.residuals).map(|weighting| weighting.cost)
}

struct Candidate {
    kind: StartKind,
    theta: Vec<f64>,
    cost: Option<f64>,
}

impl Candidate {
    fn text(&self, of_document: Option<f64>) -> String {
        let from = match self.kind {
            StartKind::EquationError => "equation error",
            StartKind::MultipleShooting => "multiple shooting",
            _ => {
                return "start values as given: equation error finds none of lower cost"
                    .to_string();
            }
        };
        let instead = match of_document {
            Some(cost) => format!("the given ones have {cost:.1}"),
            None => "with the given ones the simulation leaves the range of numbers".to_string(),
        };
        let own = self
            .cost
            .map_or("unknown".to_string(), |cost| format!("{cost:.1}"));
        format!("start values from {from}: -ln L {own}; {instead}")
    }
}

fn is_lower(cost: Option<f64>, than: Option<f64>) -> bool {
    cost.is_some_and(|cost| than.is_none_or(|than| cost < than))
}
