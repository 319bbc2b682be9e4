//! The answer of an estimation, put together once, at its last iterate.

pub(super) mod table;

use nalgebra::DMatrix;

use crate::estimate::accuracy::coloured_residuals::Colour;
use crate::estimate::accuracy::error_bounds::ErrorBounds;
use crate::estimate::accuracy::fit::{fits, histories};
use crate::estimate::accuracy::halved_steps::integration;
use crate::estimate::accuracy::identifiability::data_information;
use crate::estimate::accuracy::modes::modes;
use crate::estimate::descent::Descent;
use crate::estimate::descent::stopped::Stopped;
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unknowns::Unknowns;
use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::history::TimeHistory;
use crate::estimate::report::identifiability::Identifiability;
use crate::estimate::report::iteration::Outcome;
use crate::estimate::report::parameter::{Bound, ParameterEstimate};
use table::{Accuracy, table};

/// Where an estimation ended.
#[derive(Clone, PartialEq, Debug)]
pub struct Solution {
    /// The free unknowns, SI.
    pub theta: Vec<f64>,
    /// R, outputs by outputs, SI units squared.
    pub covariance: DMatrix<f64>,
    /// How far a further step would move the estimate, standard errors; none where there is no such step.
    pub distance: Option<f64>,
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

    /// Whether it may take the place of one with longer integration steps: that was no minimum either, or this is one.
    pub(crate) fn may_follow(&self, before: &Self) -> bool {
        let outcome = self.estimate.outcome;
        !before.estimate.outcome.is_minimum()
            || outcome.is_minimum()
            || outcome == Outcome::Cancelled
    }

    /// The same, for somebody who asked to stop `during` what was to better it.
    pub(crate) fn stopped(mut self, during: &str) -> Self {
        let found = &mut self.estimate;
        if found.outcome != Outcome::Cancelled {
            found.reason = format!(
                "stopped on request while {during}; the first try is kept: {}",
                found.reason
            );
            found.outcome = Outcome::Cancelled;
        }
        self
    }

    /// The same, as the end of a way whose beginning was another solution.
    pub(crate) fn following(mut self, before: Self) -> Self {
        let (first, last) = (before.estimate, &mut self.estimate);
        last.findings.splice(0..0, first.findings);
        last.evaluations += first.evaluations;
        last.simulations += first.simulations;
        if let (Some(first), Some(last)) = (first.identifiability, &mut last.identifiability) {
            last.before = first.before;
        }
        self
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
pub(crate) fn answer(problem: &Problem, descent: Descent<Evaluator<'_>>) -> Solution {
    let asked = Asked {
        problem,
        theta: descent.last.theta.clone(),
        solved: &Some,
    };
    answer_to(asked, problem, descent)
}

/// At the end of a descent in a problem that was made of the one that was asked about.
pub(crate) fn answer_to(
    asked: Asked<'_>,
    problem: &Problem,
    descent: Descent<Evaluator<'_>>,
) -> Solution {
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
    let has_states = !problem.model.states.is_empty();
    let integration =
        has_states.then(|| integration(problem, &mut evaluator, &at, &bounds, &histories));
    let before = first_information.and_then(|first| data_information(problem, &first));
    let estimates = problem.options.max_iterations > 0;
    let identifiability = before.map(|before| Identifiability {
        before,
        after: (estimates.then(|| data_information(problem, &at.information))).flatten(),
    });
    let accuracy = Accuracy::new(&problem.unknowns, &at.information, &at.held, &bounds);
    let accuracy = accuracy.seen_from(asked.theta.len(), asked.solved);
    let distance = stopped.distance();
    let ending = Ending {
        problem,
        theta: &at.theta,
        stopped,
        iterations,
        evaluations: evaluator.evaluations,
        simulations: evaluator.simulations,
        weighting: &at.weighting,
        held: &at.held,
        bounds: &bounds,
        histories: &histories,
        colour: &colour,
    };
    let estimate = Estimate {
        integration,
        parameters: table(asked.problem, &asked.theta, &accuracy),
        correlation: asked.correlation(problem, &bounds),
        identifiability,
        ..ending.estimate(|place| problem.name_and_scale(place))
    };
    Solution {
        theta: asked.theta,
        covariance: at.weighting.covariance,
        distance,
        estimate,
        histories,
    }
}

/// How an estimation ended, by whatever method.
pub(crate) struct Ending<'a> {
    pub problem: &'a Problem,
    pub theta: &'a [f64],
    pub stopped: Stopped,
    pub iterations: usize,
    pub evaluations: usize,
    pub simulations: usize,
    pub weighting: &'a Weighting,
    /// By place of all unknowns.
    pub held: &'a [Option<Bound>],
    pub bounds: &'a ErrorBounds,
    pub histories: &'a [TimeHistory],
    pub colour: &'a Colour,
}

impl Ending<'_> {
    /// Everything but the parameter table and what a method has of its own; `name` gives what the unknown at a place is
    /// called, and the SI value of its unit.
    pub(crate) fn estimate(&self, name: impl Fn(usize) -> (String, f64)) -> Estimate {
        let problem = self.problem;
        let held: Vec<String> = (0..self.held.len())
            .filter(|&place| self.held[place].is_some())
            .map(|place| name(place).0)
            .collect();
        let collinear = self.bounds.collinear(name);
        let (outcome, reason) = self.stopped.say(self.iterations, &held, &collinear);
        Estimate {
            outcome,
            reason,
            iterations: self.iterations,
            evaluations: self.evaluations,
            simulations: self.simulations,
            cost: self.weighting.cost,
            det_r: self.weighting.det(),
            noise_covariance: rows(&self.weighting.covariance),
            outputs: fits(problem, self.histories, self.colour),
            parameters: Vec::new(),
            error_bounds: self.bounds.kind,
            correlation: self.bounds.correlation.clone(),
            collinear,
            identifiability: None,
            prediction: Vec::new(),
            samples: problem.samples(),
            integration: None,
            findings: Vec::new(),
            filter: None,
            frequency: None,
            confidence_intervals: None,
            modes: modes(problem, self.theta, self.bounds),
        }
    }
}

impl Asked<'_> {
    /// Errors of unknowns that were not solved for are correlated with no others.
    pub(crate) fn correlation(&self, solved: &Problem, bounds: &ErrorBounds) -> Vec<Vec<f64>> {
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
