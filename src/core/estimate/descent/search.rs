//! The way from one iterate to the next: the first θ of lower cost among some that are worth a try.
//!
//! First what earlier steps tell of this one ([`super::acceleration`]), then the step itself. Where that leads nowhere,
//! Gauss-Newton halves it, and Levenberg-Marquardt takes the better of the step halved and the step damped more: damping
//! leaves directions that the data hardly see where they are, which is what a step needs that leads astray along them, but
//! not one that leads too far along a valley.

use nalgebra::DVector;

use super::acceleration::Acceleration;
use super::damping;
use super::iterate::{Iterate, Taken};
use super::step::{Newton, advanced, length};
use crate::estimate::evaluation::evaluate::Evaluate;
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::options::Method;
use crate::estimate::problem::Problem;

/// Steps damped by less than this are full ones, as far as the next can learn from them.
const DAMPING_SLIGHT: f64 = 1e-6;

/// How often a step may be shortened, or the damping raised, within one iteration.
pub(crate) const MOST_TRIALS: usize = 16;

/// The cost is a sum over all samples: differences below this share of it are rounding.
pub(crate) const ROUNDING: f64 = 1e-13;

/// And gains below this share say nothing of the quadratic model.
const FINEST: f64 = 1e-11;

/// No θ of lower cost was found; was there any that could be simulated?
#[derive(Clone, Copy)]
pub(crate) struct Nothing {
    pub in_range: bool,
}

impl Nothing {
    /// Of two searches from one place.
    pub(crate) fn or(self, other: Self) -> Self {
        Self {
            in_range: self.in_range || other.in_range,
        }
    }
}

/// The memory that one search hands on to the next.
pub(crate) struct Search<'p> {
    problem: &'p Problem,
    method: Method,
    damping: f64,
    acceleration: Acceleration,
    /// The last search went on beyond its first trial; so may this one.
    careful: bool,
}

impl<'p> Search<'p> {
    pub(crate) fn new(problem: &'p Problem, method: Method) -> Self {
        Self {
            problem,
            method,
            damping: damping::start(method),
            acceleration: Acceleration::default(),
            careful: false,
        }
    }

    /// The next iterate, and how it was reached.
    pub(crate) fn onward(
        &mut self,
        evaluator: &mut impl Evaluate<'p>,
        current: &Iterate,
        newton: &Newton,
    ) -> Result<Box<(Iterate, Taken)>, Nothing> {
        let accelerated = self.accelerated(evaluator, current, newton);
        let is_accelerated = accelerated.is_some();
        let found = match accelerated {
            Some(found) => found,
            None => self.along(evaluator, current, newton)?,
        };
        let (next, taken) = &*found;
        if taken.halvings > 0 || next.held != current.held {
            self.acceleration.forget();
        }
        self.careful = taken.halvings > 0;
        if !is_accelerated {
            let moved = moved(current, next);
            let promised = newton.promised(&moved, taken.damping, taken.share);
            let costs = (current.weighting.cost, next.weighting.cost);
            self.damping = damping::eased(taken.damping, gain(costs, promised));
        }
        Ok(found)
    }

    /// By what earlier steps tell.
    fn accelerated(
        &mut self,
        evaluator: &mut impl Evaluate<'p>,
        current: &Iterate,
        newton: &Newton,
    ) -> Option<Box<(Iterate, Taken)>> {
        if self.damping >= DAMPING_SLIGHT {
            return None;
        }
        let full = newton.step(0.0);
        let step = (self.acceleration).propose(&current.theta, full, &current.information)?;
        let theta = advanced(&self.problem.unknowns, &current.theta, &step, 1.0);
        let next = Iterate::at(self.problem, evaluator, theta).ok();
        let found = next.and_then(|next| {
            lower(
                current,
                next,
                Way {
                    damping: self.damping,
                    share: 1.0,
                },
                0,
            )
        });
        if found.is_none() {
            self.acceleration.forget();
        }
        found
    }

    /// Along the step, as short or as much damped as it must be.
    fn along(
        &self,
        evaluator: &mut impl Evaluate<'p>,
        current: &Iterate,
        newton: &Newton,
    ) -> Result<Box<(Iterate, Taken)>, Nothing> {
        let problem = self.problem;
        let theta = |way: Way| {
            let step = newton.step(way.damping);
            advanced(&problem.unknowns, &current.theta, &step, way.share)
        };
        let mut in_range = false;
        for trial in 0..MOST_TRIALS {
            let ways = Way::of_trial(self.method, self.damping, trial);
            // the first trial is nearly always taken: its sensitivities are then not worked out twice
            let way = if trial == 0 && !self.careful {
                Some(ways[0])
            } else {
                let costs = ways.iter().filter_map(|&way| {
                    let theta = theta(way);
                    let residuals = evaluator.residuals(&theta).ok()?;
                    in_range = true;
                    let weighting = Weighting::at(problem, &theta, &residuals).ok()?;
                    is_lower(&weighting, current).then_some((way, weighting.cost))
                });
                let best = costs.min_by(|a, b| a.1.total_cmp(&b.1));
                best.map(|(way, _)| way)
            };
            if let Some(way) = way
                && let Ok(next) = Iterate::at(problem, evaluator, theta(way))
            {
                in_range = true;
                if let Some(found) = lower(current, next, way, trial) {
                    return Ok(found);
                }
            }
        }
        Err(Nothing { in_range })
    }
}

/// How a step is made: with a damping, and a share of it taken.
#[derive(Clone, Copy)]
pub(crate) struct Way {
    pub damping: f64,
    pub share: f64,
}

impl Way {
    /// Those that are tried when `trial` have failed.
    pub(crate) fn of_trial(method: Method, damping: f64, trial: usize) -> Vec<Self> {
        let halved = Self {
            damping,
            share: 0.5_f64.powi(trial as i32),
        };
        if method == Method::GaussNewton || trial == 0 {
            return vec![halved];
        }
        let damped = Self {
            damping: (0..trial).fold(damping, |damping, _| damping::raised(damping)),
            share: 1.0,
        };
        vec![halved, damped]
    }
}

/// No higher than at the current iterate, but for rounding.
fn is_lower(weighting: &Weighting, current: &Iterate) -> bool {
    let now = current.weighting.cost;
    weighting.cost <= now + ROUNDING * (1.0 + now.abs())
}

/// The next iterate with how it was reached, if its cost is no higher.
fn lower(
    current: &Iterate,
    next: Iterate,
    way: Way,
    halvings: usize,
) -> Option<Box<(Iterate, Taken)>> {
    if !is_lower(&next.weighting, current) {
        return None;
    }
    let taken = Taken {
        length: length(&moved(current, &next), &current.information),
        damping: way.damping,
        share: way.share,
        halvings,
    };
    Some(Box::new((next, taken)))
}

/// The step from one iterate to another.
fn moved(current: &Iterate, next: &Iterate) -> DVector<f64> {
    let moved = next.theta.iter().zip(&current.theta).map(|(a, b)| a - b);
    DVector::from_iterator(current.theta.len(), moved)
}

/// What a step gained, as a share of what the quadratic model promised; all of it where both are rounding.
pub(crate) fn gain((before, after): (f64, f64), promised: f64) -> f64 {
    if promised > FINEST * (1.0 + before.abs()) {
        (before - after) / promised
    } else {
        1.0
    }
}
