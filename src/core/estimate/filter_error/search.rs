//! The way from some unknowns to others of lower cost, with R in the gain held.

use nalgebra::DVector;

use super::evaluation::FilterEvaluator;
use super::iterate::Iterate;
use super::limit::restore;
use crate::estimate::descent::damping;
use crate::estimate::descent::iterate::Taken;
use crate::estimate::descent::search::{MOST_TRIALS, Nothing, ROUNDING, Way, gain};
use crate::estimate::descent::step::length;
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::options::Method;
use crate::estimate::problem::unusable::Unusable;

/// Unknowns of lower cost with the same R in the gain.
pub(super) struct Trial {
    pub xi: Vec<f64>,
    pub weighting: Weighting,
}

/// Looks for unknowns of lower cost, in the ways of output error ([`Way`]). The damping becomes what the next step is to
/// begin with.
pub(super) fn search(
    evaluator: &mut FilterEvaluator<'_>,
    current: &Iterate,
    (method, damping): (Method, &mut f64),
) -> Result<(Trial, Taken), Nothing> {
    let Some(newton) = &current.newton else {
        return Err(Nothing { in_range: true });
    };
    let most = current.weighting.cost + ROUNDING * (1.0 + current.weighting.cost.abs());
    let mut in_range = false;
    for halvings in 0..MOST_TRIALS {
        let ways = Way::of_trial(method, *damping, halvings);
        let tried = ways.into_iter().filter_map(|way| {
            let step = current.step(evaluator, newton, way.damping) * way.share;
            let trial = trial(evaluator, current, &step).ok()?;
            in_range = true;
            (trial.weighting.cost <= most).then_some((trial, way))
        });
        let best = tried.min_by(|a, b| a.0.weighting.cost.total_cmp(&b.0.weighting.cost));
        if let Some((trial, way)) = best {
            let moved = trial.xi.iter().zip(&current.xi).map(|(a, b)| a - b);
            let mut moved = DVector::from_iterator(trial.xi.len(), moved);
            // these follow from the others, and count with them
            current.limit.places.iter().for_each(|&i| moved[i] = 0.0);
            let taken = Taken {
                length: length(&moved, &current.information),
                damping: way.damping,
                share: way.share,
                halvings,
            };
            let promised = newton.promised(&moved, way.damping, way.share);
            let costs = (current.weighting.cost, trial.weighting.cost);
            *damping = damping::eased(way.damping, gain(costs, promised));
            return Ok((trial, taken));
        }
    }
    Err(Nothing { in_range })
}

/// The cost behind a step, brought back into the bounds and to the limit of the gain.
fn trial(
    evaluator: &mut FilterEvaluator<'_>,
    current: &Iterate,
    step: &DVector<f64>,
) -> Result<Trial, Unusable> {
    let problem = evaluator.problem;
    let moved = |(place, &value): (usize, &f64)| {
        let (lower, upper) = evaluator.layout.limits(problem, place);
        (value + step[place]).clamp(lower, upper)
    };
    let mut xi: Vec<f64> = current.xi.iter().enumerate().map(moved).collect();
    let weight = &current.gain_noise.inverse;
    restore(evaluator, &mut xi, weight, &current.limit.places)?;
    let innovations = evaluator.innovations(&xi, weight, |_, _, _| {})?;
    let weighting = Weighting::at(problem, &xi, &innovations)?;
    Ok(Trial { xi, weighting })
}
