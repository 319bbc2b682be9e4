//! The answer of an estimation, put together at its last iterate.

use nalgebra::DMatrix;

use crate::estimate::accuracy::coloured_residuals::Colour;
use crate::estimate::accuracy::error_bounds::ErrorBounds;
use crate::estimate::accuracy::fit::{fits, histories};
use crate::estimate::accuracy::identifiability::data_information;
use crate::estimate::accuracy::modes::modes;
use crate::estimate::accuracy::prior_shares::shares;
use crate::estimate::descent::Descent;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unknowns::Unknown;
use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::history::TimeHistory;
use crate::estimate::report::identifiability::Identifiability;
use crate::estimate::report::parameter::{Bound, ParameterEstimate};

/// The estimate, and the time histories that go with it.
pub struct Solution {
    pub estimate: Estimate,
    pub histories: Vec<TimeHistory>,
}

/// At the end of a descent.
pub(crate) fn answer(problem: &Problem, descent: Descent<'_>) -> Solution {
    let Descent {
        mut evaluator,
        first_information,
        last: at,
        iterations,
        stopped,
    } = descent;
    let histories = histories(problem, &at.theta);
    let colour = Colour::of(&histories);
    let bounds = ErrorBounds::at(problem, &mut evaluator, &at, &colour, &histories);
    let held: Vec<String> = (0..at.held.len())
        .filter(|&place| at.held[place].is_some())
        .map(|place| problem.name(place))
        .collect();
    let collinear = bounds.collinear(|place| problem.name_and_scale(place));
    let (outcome, reason) = stopped.say(problem.options.method, iterations, &held, &collinear);
    let before = first_information.and_then(|first| data_information(problem, &first));
    let asked = problem.options.max_iterations > 0;
    let identifiability = before.map(|before| Identifiability {
        before,
        after: (asked.then(|| data_information(problem, &at.information))).flatten(),
    });
    let estimate = Estimate {
        outcome,
        reason,
        iterations,
        evaluations: evaluator.evaluations,
        simulations: evaluator.simulations,
        cost: at.weighting.cost,
        det_r: at.weighting.det(),
        noise_covariance: rows(&at.weighting.covariance),
        outputs: fits(problem, &histories, &colour),
        parameters: table(problem, &at.theta, (&at.information, &at.held), &bounds),
        error_bounds: bounds.kind,
        correlation: bounds.correlation.clone(),
        collinear,
        identifiability,
        prediction: Vec::new(),
        filter: None,
        samples: problem.samples(),
        modes: modes(problem, &at.theta, &bounds),
    };
    Solution {
        estimate,
        histories,
    }
}

pub(crate) fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect()
}

/// All parameters, fixed ones too, in the order of the document.
pub(crate) fn table(
    problem: &Problem,
    theta: &[f64],
    (information, held): (&DMatrix<f64>, &[Option<Bound>]),
    bounds: &ErrorBounds,
) -> Vec<ParameterEstimate> {
    let unknowns = &problem.unknowns;
    let prior_shares = shares(unknowns, information, held);
    let row = |(index, unknown): (usize, &Unknown)| {
        let info = &problem.model.parameters[unknown.parameter];
        let place = unknowns.free.iter().position(|&i| i == index);
        let in_own_unit = |errors: &[Option<f64>]| {
            let error = place.and_then(|place| errors[place]);
            error.map(|error| error / info.unit.scale)
        };
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
            standard_error: in_own_unit(&bounds.standard_errors),
            conventional_standard_error: in_own_unit(&bounds.conventional),
            prior_share: place
                .filter(|&place| bounds.standard_errors[place].is_some())
                .and_then(|place| prior_shares[place]),
            fixed: unknown.fixed,
            at_bound: place.and_then(|place| held[place]),
        }
    };
    unknowns.all.iter().enumerate().map(row).collect()
}
