//! The answer of an estimation, put together once, at its last iterate.

pub(super) mod table;

use nalgebra::DMatrix;

use crate::estimate::accuracy::coloured_residuals::Colour;
use crate::estimate::accuracy::error_bounds::ErrorBounds;
use crate::estimate::accuracy::fit::{fits, histories};
use crate::estimate::accuracy::identifiability::data_information;
use crate::estimate::accuracy::modes::modes;
use crate::estimate::descent::Descent;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unknowns::Unknowns;
use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::history::TimeHistory;
use crate::estimate::report::identifiability::Identifiability;
use crate::estimate::report::parameter::ParameterEstimate;
use table::{Accuracy, table};

/// Where an estimation ended.
#[derive(Clone, PartialEq, Debug)]
pub struct Solution {
    /// The free unknowns, SI.
    pub theta: Vec<f64>,
    /// R, outputs by outputs, SI units squared.
    pub covariance: DMatrix<f64>,
    /// The report of it.
    pub estimate: Estimate,
    /// Measured and modelled outputs of each segment.
    pub histories: Vec<TimeHistory>,
}

impl Solution {
    /// The row of the parameter table that belongs to a place of θ.
    pub fn row(&self, unknowns: &Unknowns, place: usize) -> &ParameterEstimate {
        &self.estimate.parameters[unknowns.free[place]]
    }
}

/// Whose parameters an answer is about, where one problem was solved in the place of another.
pub(crate) struct Asked<'a> {
    pub problem: &'a Problem,
    pub theta: Vec<f64>,
    /// By place of this θ: the place in that of the problem that was solved; none where it is not among those.
    pub solved: &'a dyn Fn(usize) -> Option<usize>,
}

/// At the end of a descent.
pub(crate) fn answer(problem: &Problem, descent: Descent<'_>) -> Solution {
    let asked = Asked {
        problem,
        theta: descent.last.theta.clone(),
        solved: &Some,
    };
    answer_to(asked, problem, descent)
}

/// At the end of a descent in a problem that was made of the one that was asked about.
pub(crate) fn answer_to(asked: Asked<'_>, problem: &Problem, descent: Descent<'_>) -> Solution {
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
    let estimates = problem.options.max_iterations > 0;
    let identifiability = before.map(|before| Identifiability {
        before,
        after: (estimates.then(|| data_information(problem, &at.information))).flatten(),
    });
    let accuracy = Accuracy::new(&problem.unknowns, &at.information, &at.held, &bounds);
    let accuracy = accuracy.seen_from(asked.theta.len(), asked.solved);
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
        parameters: table(asked.problem, &asked.theta, &accuracy),
        error_bounds: bounds.kind,
        correlation: asked.correlation(problem, &bounds),
        collinear,
        identifiability,
        prediction: Vec::new(),
        filter: None,
        samples: problem.samples(),
        modes: modes(problem, &at.theta, &bounds),
    };
    Solution {
        theta: asked.theta,
        covariance: at.weighting.covariance,
        estimate,
        histories,
    }
}

impl Asked<'_> {
    /// Errors of unknowns that were not solved for are correlated with no others.
    fn correlation(&self, solved: &Problem, bounds: &ErrorBounds) -> Vec<Vec<f64>> {
        if bounds.correlation.is_empty() && !solved.unknowns.is_empty() {
            return Vec::new();
        }
        let correlation = |a: usize, b: usize| match ((self.solved)(a), (self.solved)(b)) {
            (Some(a), Some(b)) => bounds.correlation[a][b],
            _ => f64::from(u8::from(a == b)),
        };
        let places = 0..self.theta.len();
        places
            .clone()
            .map(|a| places.clone().map(|b| correlation(a, b)).collect())
            .collect()
    }
}

pub(crate) fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect()
}
