//! The answer of an estimation, put together at its last iterate.

use super::error_bounds::ErrorBounds;
use super::evaluation::Evaluator;
use super::fit::{fits, histories};
use super::iterate::Iterate;
use super::priors;
use super::problem::Problem;
use super::report::{Estimate, Outcome, ParameterEstimate, TimeHistory};
use super::unknowns::Unknown;

/// The estimate, and the time histories that go with it.
pub struct Solution {
    pub estimate: Estimate,
    pub histories: Vec<TimeHistory>,
}

pub(super) fn answer(
    problem: &Problem,
    at: &Iterate,
    bounds: &ErrorBounds,
    evaluator: &Evaluator<'_>,
    iterations: usize,
    (outcome, reason): (Outcome, String),
) -> Solution {
    let histories = histories(problem, &at.theta);
    let covariance = &at.weighting.covariance;
    let estimate = Estimate {
        outcome,
        reason,
        iterations,
        evaluations: evaluator.evaluations,
        simulations: evaluator.simulations,
        cost: at.weighting.cost,
        det_r: at.weighting.det(),
        noise_covariance: covariance
            .row_iter()
            .map(|row| row.iter().copied().collect())
            .collect(),
        outputs: fits(problem, &histories),
        parameters: table(problem, at, bounds),
        correlation: bounds.correlation.clone(),
        collinear: bounds.collinear(problem),
        samples: problem.samples(),
    };
    Solution {
        estimate,
        histories,
    }
}

/// All parameters, fixed ones too, in the order of the document.
fn table(problem: &Problem, at: &Iterate, bounds: &ErrorBounds) -> Vec<ParameterEstimate> {
    let unknowns = &problem.unknowns;
    let prior_shares = priors::shares(unknowns, &at.information, &at.held);
    let row = |(index, unknown): (usize, &Unknown)| {
        let info = &problem.model.parameters[unknown.parameter];
        let place = unknowns.free.iter().position(|&i| i == index);
        let standard_error = place.and_then(|place| bounds.standard_errors[place]);
        ParameterEstimate {
            name: info.name.clone(),
            unit: info.document.unit.clone(),
            segment: unknown
                .segment
                .map(|segment| problem.segments[segment].label.clone()),
            start: info.unit.from_si(unknown.start),
            estimate: info
                .unit
                .from_si(place.map_or(unknown.start, |place| at.theta[place])),
            standard_error: standard_error.map(|error| error / info.unit.scale),
            prior_share: place
                .filter(|_| standard_error.is_some())
                .and_then(|place| prior_shares[place]),
            fixed: unknown.fixed,
            at_bound: place.and_then(|place| at.held[place]),
        }
    };
    unknowns.all.iter().enumerate().map(row).collect()
}
