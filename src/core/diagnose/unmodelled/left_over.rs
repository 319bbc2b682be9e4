//! Whether something is left: a force in one equation that explains more of the residual than coloured noise would.

use rayon::prelude::*;

use super::equations::{self, Equation};
use super::explained::{Explained, Noise};
use super::flown::Flown;
use super::report::{ForceElsewhere, ForceIn};
use super::responses::Responses;
use super::shapes::{Knots, Shapes};
use super::smoothness::Smoothness;
use crate::diagnose::candidates::Ingredients;
use crate::diagnose::case::Case;
use crate::diagnose::fitted::Fitted;
use crate::diagnose::screen::critical;
use crate::stop;

/// Noise alone seems to be more once in so many diagnoses.
const FALSE_ALARM: f64 = 1e-3;

/// Short periods are some seconds long.
const KNOTS: Knots = Knots {
    spacing: 0.5,
    most: 60,
};

/// Equations in which the noise is asked for beside the force, the best at first sight.
const LOOKED_AT_CLOSELY: usize = 4;

/// A force's size and smoothness are asked of the data.
const FREEDOM: usize = 2;

/// What is left of a residual, by the equation that a force explains it best in.
#[derive(Clone, PartialEq, Debug)]
pub(in crate::diagnose) struct LeftOver {
    /// A state, a definition or an output.
    pub equation: String,
    pub force_in: ForceIn,
    /// Twice the gain of the marginal likelihood over noise alone.
    pub likelihood_ratio: f64,
    /// Independent numbers that the force is worth.
    pub freedom: f64,
    /// What noise alone exceeds once in a thousand diagnoses.
    pub threshold: f64,
    /// The other equations, the best first.
    pub elsewhere: Vec<ForceElsewhere>,
}

impl LeftOver {
    pub(in crate::diagnose) fn is_significant(&self) -> bool {
        self.likelihood_ratio > self.threshold
    }
}

/// What a model fitted by output error leaves of its flights. `None` where the simulation leaves the range of numbers, or
/// the model has no room for a force.
pub(in crate::diagnose) fn left_over(case: &Case, fitted: &Fitted) -> Option<LeftOver> {
    let flown = Flown::fitted(fitted)?;
    let ingredients = Ingredients::new(case, &fitted.document);
    let equations = equations::of(&ingredients, &fitted.document);
    let outputs = flown.problem.model.outputs.len();
    let shapes = Shapes::along(&flown.problem.segments, outputs, KNOTS)?;
    let counts: Vec<usize> = shapes.iter().map(|shapes| shapes.count).collect();
    let smoothness = Smoothness::all(&counts)?;
    let responses = Responses::new(&flown, &shapes, &equations)?;
    let noise = Noise::of(&flown.samples)?;
    let force = |equation: &Equation, explained: Explained<'_>| ForceElsewhere {
        equation: equation.name.clone(),
        force_in: equation.force_in,
        likelihood_ratio: 2.0 * (explained.ln_evidence - noise.ln_evidence),
        freedom: explained.posterior.freedom,
    };
    let of = |equation: &Equation, closely: bool| {
        let responses = responses.to(equation)?;
        let responses: Vec<_> = responses.iter().collect();
        let explain = if closely {
            Explained::by
        } else {
            Explained::at_first_sight
        };
        let explained = explain(&flown.samples, &noise, &responses, &smoothness)?;
        Some(force(equation, explained))
    };
    let mut all: Vec<(&Equation, ForceElsewhere)> = (equations.par_iter())
        .filter_map(stop::shared(|equation| {
            Some((equation, of(equation, false)?))
        }))
        .collect();
    let best_first = |a: &(&Equation, ForceElsewhere), b: &(&Equation, ForceElsewhere)| {
        b.1.likelihood_ratio.total_cmp(&a.1.likelihood_ratio)
    };
    all.sort_by(best_first);
    all.par_iter_mut()
        .take(LOOKED_AT_CLOSELY)
        .for_each(stop::shared(
            |(equation, found): &mut (&Equation, ForceElsewhere)| {
                if let Some(closer) = of(equation, true) {
                    *found = closer;
                }
            },
        ));
    all.sort_by(best_first);
    let mut all = all.into_iter().map(|(_, force)| force);
    let best = all.next()?;
    Some(LeftOver {
        equation: best.equation,
        force_in: best.force_in,
        likelihood_ratio: best.likelihood_ratio,
        freedom: best.freedom,
        threshold: critical(FALSE_ALARM, equations.len() as f64, FREEDOM),
        elsewhere: all.collect(),
    })
}
