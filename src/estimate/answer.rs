//! The answer of an estimation, put together at its last iterate.

use nalgebra::DMatrix;

use super::error_bounds::ErrorBounds;
use super::evaluation::Evaluator;
use super::fit::{fits, histories};
use super::iterate::Iterate;
use super::problem::Problem;
use super::report::{Bound, Estimate, Outcome, ParameterEstimate, TimeHistory};
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
    let estimate = Estimate {
        outcome,
        reason,
        iterations,
        evaluations: evaluator.evaluations,
        simulations: evaluator.simulations,
        cost: at.weighting.cost,
        det_r: at.weighting.det(),
        noise_covariance: rows(&at.weighting.covariance),
        outputs: fits(problem, &histories),
        parameters: table(problem, &at.theta, &at.held, bounds),
        correlation: bounds.correlation.clone(),
        collinear: bounds.collinear(|place| problem.name_and_scale(place)),
        filter: None,
        samples: problem.samples(),
    };
    Solution {
        estimate,
        histories,
    }
}

pub(super) fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect()
}

/// All parameters, fixed ones too, in the order of the document.
pub(super) fn table(
    problem: &Problem,
    theta: &[f64],
    held: &[Option<Bound>],
    bounds: &ErrorBounds,
) -> Vec<ParameterEstimate> {
    let unknowns = &problem.unknowns;
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
                .from_si(place.map_or(unknown.start, |place| theta[place])),
            standard_error: standard_error.map(|error| error / info.unit.scale),
            fixed: unknown.fixed,
            at_bound: place.and_then(|place| held[place]),
        }
    };
    unknowns.all.iter().enumerate().map(row).collect()
}
