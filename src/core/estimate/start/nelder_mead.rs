//! Simplex search by the cost alone, R concentrated (Nelder and Mead 1965), with coefficients that suit the number of
//! parameters (Gao and Han 2012): needs no derivatives, and passes over ripples that would trap a gradient.

use super::found::Start;
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::evaluation::normal_equations::NormalEquations;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::progress::{Progress, Watcher};
use crate::estimate::report::start::{StartKind, StartReport};
use crate::stop;

/// The first simplex reaches this share of each parameter's start, ...
const REACH: f64 = 0.1;
/// ... or this many of its own standard errors, where that is further.
const REACH_IN_ERRORS: f64 = 3.0;
/// Where a parameter starts at zero and nothing else is known.
const REACH_FROM_ZERO: f64 = 0.1;

/// Done when the corners' costs differ by less than this: a tenth of what one standard error makes.
const FLAT: f64 = 0.05;

/// Evaluations between two reports.
const REPORT_EVERY: usize = 100;

/// # Errors
/// No corner of the first simplex gives a cost.
pub(crate) fn nelder_mead(
    problem: &Problem,
    theta: Vec<f64>,
    most: usize,
    watcher: &mut Watcher<'_>,
) -> Result<Start, Unusable> {
    let mut search = Search::new(problem, most);
    let mut corners = search.simplex(theta);
    let mut stopped = false;
    let mut next_report = 0;
    loop {
        corners.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let (lowest, highest) = (corners[0].cost, corners[corners.len() - 1].cost);
        let done = search.evaluations >= most || highest - lowest < FLAT || corners.len() < 2;
        if search.evaluations >= next_report || done {
            next_report = search.evaluations + REPORT_EVERY;
            let report = search.report(lowest, done);
            stopped = watcher(Progress::Start(&report)).is_break();
        }
        if done || stopped {
            break;
        }
        stopped = stop::droppable(|| search.turn(&mut corners)).is_err();
        if stopped {
            break;
        }
    }
    let best = corners.swap_remove(0);
    match best.cost.is_finite() {
        true => Ok(Start {
            theta: best.theta,
            stopped,
            may_shoot: false,
        }),
        // says what is wrong there
        false => search
            .evaluator
            .cost(&best.theta)
            .and(Err(Unusable::NotFinite)),
    }
}

#[derive(Clone)]
struct Corner {
    theta: Vec<f64>,
    /// Infinite where the model cannot be simulated.
    cost: f64,
}

struct Search<'p> {
    problem: &'p Problem,
    evaluator: Evaluator<'p>,
    evaluations: usize,
    most: usize,
}

impl<'p> Search<'p> {
    fn new(problem: &'p Problem, most: usize) -> Self {
        Self {
            problem,
            evaluator: Evaluator::new(problem),
            evaluations: 0,
            most,
        }
    }

    fn corner(&mut self, mut theta: Vec<f64>) -> Corner {
        for (place, value) in theta.iter_mut().enumerate() {
            let unknown = self.problem.unknowns.at(place);
            *value = value.clamp(unknown.lower, unknown.upper);
        }
        self.evaluations += 1;
        let cost = self.evaluator.cost(&theta).unwrap_or(f64::INFINITY);
        Corner { theta, cost }
    }

    /// The start, and from it one corner along each parameter.
    fn simplex(&mut self, theta: Vec<f64>) -> Vec<Corner> {
        let information = NormalEquations::at(&mut self.evaluator, &theta)
            .map(|equations| equations.information.diagonal());
        let reach = |place: usize| {
            let own = REACH * theta[place].abs();
            let error = information.as_ref().map_or(0.0, |diagonal| {
                let error = diagonal[place].sqrt().recip();
                if error.is_finite() {
                    REACH_IN_ERRORS * error
                } else {
                    0.0
                }
            });
            match own.max(error) {
                0.0 => REACH_FROM_ZERO,
                reach => reach,
            }
        };
        let mut corners = vec![self.corner(theta.clone())];
        for place in 0..theta.len() {
            if self.evaluations >= self.most {
                break;
            }
            let unknown = self.problem.unknowns.at(place);
            let reach = reach(place);
            let mut moved = theta.clone();
            // away from a bound that is near
            moved[place] += if theta[place] + reach > unknown.upper {
                -reach
            } else {
                reach
            };
            corners.push(self.corner(moved));
        }
        corners
    }

    /// One turn of the simplex; corners are sorted by cost.
    fn turn(&mut self, corners: &mut [Corner]) {
        let last = corners.len() - 1;
        let n = last as f64;
        let (expand, contract, shrink) = (1.0 + 2.0 / n, 0.75 - 0.5 / n, 1.0 - 1.0 / n);
        // with one parameter the coefficients of many leave nothing of the simplex
        let (contract, shrink) = (contract.max(0.5), shrink.max(0.5));
        let centre: Vec<f64> = (0..corners[0].theta.len())
            .map(|i| {
                corners[..last]
                    .iter()
                    .map(|corner| corner.theta[i])
                    .sum::<f64>()
                    / n
            })
            .collect();
        let worst = corners[last].clone();
        let along = |share: f64| -> Vec<f64> {
            centre
                .iter()
                .zip(&worst.theta)
                .map(|(c, w)| c + share * (c - w))
                .collect()
        };
        let reflected = self.corner(along(1.0));
        if reflected.cost < corners[0].cost {
            let expanded = self.corner(along(expand));
            corners[last] = if expanded.cost < reflected.cost {
                expanded
            } else {
                reflected
            };
        } else if reflected.cost < corners[last - 1].cost {
            corners[last] = reflected;
        } else {
            let outside = reflected.cost < worst.cost;
            let contracted = self.corner(along(if outside { contract } else { -contract }));
            if contracted.cost < worst.cost.min(reflected.cost) {
                corners[last] = contracted;
            } else {
                let best = corners[0].theta.clone();
                for corner in &mut corners[1..] {
                    if self.evaluations >= self.most {
                        return;
                    }
                    let pulled = best
                        .iter()
                        .zip(&corner.theta)
                        .map(|(b, c)| b + shrink * (c - b));
                    *corner = self.corner(pulled.collect());
                }
            }
        }
    }

    fn report(&self, lowest: f64, done: bool) -> StartReport {
        let text = match (done, self.evaluations >= self.most) {
            (true, true) => "simplex search: its budget of simulations is used up",
            (true, false) => "simplex search: the simplex is flat",
            _ => "simplex search goes on",
        };
        StartReport {
            method: StartKind::NelderMead,
            evaluations: self.evaluations,
            cost: lowest.is_finite().then_some(lowest),
            text: text.to_string(),
        }
    }
}
