//! The way from one iterate to the next: the first θ of lower cost among some that are worth a try.
//!
//! First what earlier steps tell of this one ([`super::acceleration`]), then the step itself, then the step halved
//! (Gauss-Newton) or damped more (Levenberg-Marquardt).

use nalgebra::DVector;

use super::acceleration::Acceleration;
use super::damping::Damping;
use super::iterate::{Iterate, Taken};
use super::step::{Newton, advanced, length};
use crate::estimate::evaluation::evaluator::Evaluator;
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
    damping: Damping,
    acceleration: Acceleration,
    /// The last search went on beyond its first trial; so may this one.
    careful: bool,
}

impl<'p> Search<'p> {
    pub(crate) fn new(problem: &'p Problem, method: Method) -> Self {
        Self {
            problem,
            method,
            damping: Damping::start(method),
            acceleration: Acceleration::default(),
            careful: false,
        }
    }

    /// The next iterate, and how it was reached.
    pub(crate) fn onward(
        &mut self,
        evaluator: &mut Evaluator<'_>,
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
            let promised = newton.promised(&moved(current, next), self.damping.value());
            let costs = (current.weighting.cost, next.weighting.cost);
            self.damping.ease(gain(costs, promised));
        }
        Ok(found)
    }

    /// By what earlier steps tell.
    fn accelerated(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        current: &Iterate,
        newton: &Newton,
    ) -> Option<Box<(Iterate, Taken)>> {
        if self.damping.value() >= DAMPING_SLIGHT {
            return None;
        }
        let full = newton.step(0.0);
        let step = (self.acceleration).propose(&current.theta, full, &current.information)?;
        let theta = advanced(&self.problem.unknowns, &current.theta, &step, 1.0);
        let next = Iterate::at(self.problem, evaluator, theta).ok();
        let found = next.and_then(|next| lower(current, next, self.damping.value(), 0));
        if found.is_none() {
            self.acceleration.forget();
        }
        found
    }

    /// Along the step, as short or as much damped as it must be.
    fn along(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        current: &Iterate,
        newton: &Newton,
    ) -> Result<Box<(Iterate, Taken)>, Nothing> {
        let problem = self.problem;
        let mut share = 1.0;
        let mut in_range = false;
        for trial in 0..MOST_TRIALS {
            let step = newton.step(self.damping.value());
            let theta = advanced(&problem.unknowns, &current.theta, &step, share);
            // the first trial is nearly always taken: its sensitivities are then not worked out twice
            let worth_it = (trial == 0 && !self.careful)
                || evaluator.residuals(&theta).is_ok_and(|residuals| {
                    in_range = true;
                    let weighting = Weighting::at(problem, &theta, &residuals);
                    weighting.is_ok_and(|weighting| is_lower(&weighting, current))
                });
            if worth_it && let Ok(next) = Iterate::at(problem, evaluator, theta) {
                in_range = true;
                if let Some(found) = lower(current, next, self.damping.value(), trial) {
                    return Ok(found);
                }
            }
            match self.method {
                Method::GaussNewton => share *= 0.5,
                Method::LevenbergMarquardt => self.damping.raise(),
            }
        }
        Err(Nothing { in_range })
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
    damping: f64,
    halvings: usize,
) -> Option<Box<(Iterate, Taken)>> {
    if !is_lower(&next.weighting, current) {
        return None;
    }
    let taken = Taken {
        length: length(&moved(current, &next), &current.information),
        damping,
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
