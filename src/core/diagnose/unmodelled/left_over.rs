//! Whether something is left: a force in one equation that explains more of the residual than coloured noise would.

use rayon::prelude::*;

use super::equations::{self, Equation};
use super::explained::{Explained, Noise};
use super::flown::Flown;
use super::responses::Responses;
use super::shapes::Shapes;
use super::smoothness::Smoothness;
use crate::diagnose::candidates::Ingredients;
use crate::diagnose::case::Case;
use crate::diagnose::fitted::Fitted;
use crate::diagnose::screen::critical;

/// Noise alone seems to be more once in so many diagnoses.
const FALSE_ALARM: f64 = 1e-3;

/// Knots of the force, s: short periods are some seconds long.
const SPACING: f64 = 0.5;
const MOST_INTERVALS: usize = 60;

/// A force's size and smoothness are asked of the data.
const FREEDOM: usize = 2;

/// What is left of a residual, by the equation that a force explains it best in.
#[derive(Clone, PartialEq, Debug)]
pub(in crate::diagnose) struct LeftOver {
    /// A state, a definition or an output.
    pub equation: String,
    /// `the equation of q`
    pub words: String,
    pub is_output: bool,
    /// Twice the gain of the marginal likelihood over noise alone.
    pub likelihood_ratio: f64,
    /// Parameters that the force is worth.
    pub freedom: f64,
    /// What noise alone exceeds once in a thousand diagnoses.
    pub threshold: f64,
}

impl LeftOver {
    pub(in crate::diagnose) fn is_significant(&self) -> bool {
        self.likelihood_ratio > self.threshold
    }
}

/// What a model fitted by output error leaves of its flights: the equation in which a force explains most of it. `None`
/// where the simulation leaves the range of numbers, or the model has no room for a force.
pub(in crate::diagnose) fn left_over(case: &Case, fitted: &Fitted) -> Option<LeftOver> {
    all(case, fitted)?
        .into_iter()
        .max_by(|a, b| a.likelihood_ratio.total_cmp(&b.likelihood_ratio))
}

/// By equation.
pub(in crate::diagnose) fn all(case: &Case, fitted: &Fitted) -> Option<Vec<LeftOver>> {
    let flown = Flown::fitted(fitted)?;
    let equations = equations::of(&Ingredients::new(case, &fitted.document), &fitted.document);
    let shapes: Vec<Shapes> = (flown.problem.segments.iter())
        .map(|segment| Shapes::over(segment.elapsed(), SPACING, MOST_INTERVALS))
        .collect();
    let counts: Vec<usize> = shapes.iter().map(|shapes| shapes.count).collect();
    let smoothness = Smoothness::all(&counts)?;
    let responses = Responses::new(&flown, &shapes, &equations)?;
    let noise = Noise::of(&flown.samples)?;
    let threshold = critical(FALSE_ALARM, equations.len() as f64, FREEDOM);
    let of = |equation: &Equation| {
        let responses = responses.to(equation)?;
        let explained = Explained::by(&flown.samples, &noise, &responses, &smoothness)?;
        Some(LeftOver {
            equation: equation.name.clone(),
            words: equation.words(),
            is_output: equation.gives == equations::Gives::Output,
            likelihood_ratio: 2.0 * (explained.ln_evidence - noise.ln_evidence),
            freedom: explained.posterior.freedom,
            threshold,
        })
    };
    Some(equations.par_iter().filter_map(of).collect())
}
