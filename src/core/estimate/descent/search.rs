//! The way from one iterate to the next: the first θ of lower cost among some that are worth a try.
//!
//! First what earlier steps tell of this one ([`super::acceleration`]), then the step itself, then the step halved
//! (Gauss-Newton) or damped more (Levenberg-Marquardt).

use nalgebra::DVector;

use super::acceleration::Acceleration;
use super::iterate::{Iterate, Taken};
use super::step::{Newton, advanced, length};
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::options::Method;
use crate::estimate::problem::Problem;

/// Damping: where it starts, what success and failure make of it, and below what it is none.
pub(crate) const DAMPING_START: f64 = 1e-3;
pub(crate) const DAMPING_EASED: f64 = 1e-2;
pub(crate) const DAMPING_RAISED: f64 = 10.0;
pub(crate) const DAMPING_NONE: f64 = 1e-10;

/// Steps damped by less than this are full ones, as far as the next can learn from them.
const DAMPING_SLIGHT: f64 = 1e-6;

/// How often a step may be shortened, or the damping raised, within one iteration.
pub(crate) const MOST_TRIALS: usize = 16;

/// The cost is a sum over all samples: differences below this share of it are rounding.
pub(crate) const ROUNDING: f64 = 1e-13;

/// No θ of lower cost was found; was there any that could be simulated?
pub(crate) struct Nothing {
    pub in_range: bool,
}

/// The memory that one search hands on to the next.
pub(crate) struct Search<'p> {
    problem: &'p Problem,
    damping: f64,
    acceleration: Acceleration,
    /// The last search went on beyond its first trial; so may this one.
    careful: bool,
}

impl<'p> Search<'p> {
    pub(crate) fn new(problem: &'p Problem) -> Self {
        Self {
            problem,
            damping: match problem.options.method {
                Method::LevenbergMarquardt => DAMPING_START,
                Method::GaussNewton => 0.0,
            },
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
        let found = match accelerated {
            Some(found) => found,
            None => self.along(evaluator, current, newton)?,
        };
        let (next, taken) = &*found;
        if taken.halvings > 0 || next.held != current.held {
            self.acceleration.forget();
        }
        self.careful = taken.halvings > 0;
        let eased = taken.damping * DAMPING_EASED;
        self.damping = if eased < DAMPING_NONE { 0.0 } else { eased };
        Ok(found)
    }

    /// By what earlier steps tell.
    fn accelerated(
        &mut self,
        evaluator: &mut Evaluator<'_>,
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
        let found = next.and_then(|next| lower(current, next, self.damping, 0));
        if found.is_none() {
            self.acceleration.forget();
        }
        found
    }

    /// Along the step, as short or as much damped as it must be.
    fn along(
        &self,
        evaluator: &mut Evaluator<'_>,
        current: &Iterate,
        newton: &Newton,
    ) -> Result<Box<(Iterate, Taken)>, Nothing> {
        let problem = self.problem;
        let (mut damping, mut share) = (self.damping, 1.0);
        let mut in_range = false;
        for trial in 0..MOST_TRIALS {
            let step = newton.step(damping);
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
                if let Some(found) = lower(current, next, damping, trial) {
                    return Ok(found);
                }
            }
            match problem.options.method {
                Method::GaussNewton => share *= 0.5,
                Method::LevenbergMarquardt => {
                    damping = (damping * DAMPING_RAISED).max(DAMPING_START);
                }
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
    let moved = next.theta.iter().zip(&current.theta).map(|(a, b)| a - b);
    let moved = DVector::from_iterator(current.theta.len(), moved);
    let taken = Taken {
        length: length(&moved, &current.information),
        damping,
        halvings,
    };
    Some(Box::new((next, taken)))
}
