//! A model fitted to the case, with the likelihood that counts.

use std::ops::ControlFlow;

use nalgebra::DMatrix;

use super::case::{Case, Unfit, Values, values};
use super::colour::Colour;
use super::stack::Layout;
use crate::estimate::{Bound, ErrorBoundsKind, Estimate, Outcome, Problem, Solution, output_error};
use crate::model::{Added, ModelDocument};

/// A model and its fit to the estimation flights.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub document: ModelDocument,
    pub problem: Problem,
    /// SI.
    pub theta: Vec<f64>,
    /// By place of θ: the bound at which it stands.
    pub bounds: Vec<Option<Bound>>,
    /// R.
    pub covariance: DMatrix<f64>,
    /// The report of the estimation; θ may have moved since, see [`Self::polished`].
    pub estimate: Estimate,
    /// Over [`Layout::of`] the problem, at θ.
    pub residual: Vec<f64>,
    /// How far from its minimum the estimation ended, standard errors.
    distance: Option<f64>,
}

/// Trials are stopped at this many standard errors from their minimum: 1e-6 of a unit of the likelihood ratio.
const TRIAL_TOLERANCE: f64 = 1e-3;
const TRIAL_ITERATIONS: usize = 30;

/// A fit that is to be reported goes on until it has converged, or this often.
const SETTLING_ITERATIONS: usize = 100;

/// A fit that stalls within so many standard errors of its minimum is there: 2 ln L would grow by less than 1.
const NEAR: f64 = 1.0;

impl Fitted {
    /// A quick fit from given values.
    ///
    /// # Errors
    /// The model does not fit the recordings, or the fit came to nothing.
    pub(super) fn trial(
        case: &Case,
        document: ModelDocument,
        start: &Values,
    ) -> Result<Self, Unfit> {
        Self::within(
            case,
            document,
            start,
            TRIAL_ITERATIONS,
            ErrorBoundsKind::Conventional,
        )
    }

    /// No fit at all: the model at given values.
    ///
    /// # Errors
    /// The model does not fit the recordings, or leaves the range of numbers.
    pub(super) fn at(case: &Case, document: ModelDocument, values: &Values) -> Result<Self, Unfit> {
        Self::within(case, document, values, 0, ErrorBoundsKind::Conventional)
    }

    /// The fit by output error that is decided on and reported: converged, with bounds corrected for colour.
    ///
    /// # Errors
    /// As [`Self::trial`].
    pub(super) fn settled(
        case: &Case,
        document: ModelDocument,
        start: &Values,
    ) -> Result<Self, Unfit> {
        let bounds = ErrorBoundsKind::Corrected;
        Self::within(case, document, start, SETTLING_ITERATIONS, bounds)
    }

    fn within(
        case: &Case,
        document: ModelDocument,
        start: &Values,
        iterations: usize,
        bounds: ErrorBoundsKind,
    ) -> Result<Self, Unfit> {
        let mut problem = case.problem(&document, start)?;
        problem.options.error_bounds = bounds;
        problem.options.tolerance = problem.options.tolerance.max(TRIAL_TOLERANCE);
        problem.options.max_iterations = iterations;
        let solution = output_error(&problem, &mut |_| ControlFlow::Continue(()))
            .map_err(|why| Unfit(why.to_string()))?;
        if solution.estimate.outcome == Outcome::Diverged {
            return Err(Unfit(solution.estimate.reason));
        }
        Ok(Self::of(document, problem, &solution))
    }

    pub(super) fn of(document: ModelDocument, problem: Problem, solution: &Solution) -> Self {
        let unknowns = &problem.unknowns;
        let at_bound = |place: usize| solution.row(unknowns, place).at_bound;
        Self {
            bounds: (0..unknowns.len()).map(at_bound).collect(),
            residual: Layout::of(&problem).residual(&solution.histories),
            theta: solution.theta.clone(),
            covariance: solution.covariance.clone(),
            estimate: solution.estimate.clone(),
            distance: solution.distance,
            document,
            problem,
        }
    }

    /// Whether it is at a minimum, or so near that the way to it changes nothing: a limit or a play makes corners in the cost, where
    /// no derivative vanishes.
    pub(super) fn is_settled(&self) -> bool {
        let outcome = self.estimate.outcome;
        let is_near = self.distance.is_some_and(|distance| distance < NEAR);
        outcome.is_minimum() || (outcome == Outcome::Stalled && is_near)
    }

    /// The values of its parameters, for another fit to start from.
    pub(super) fn values(&self) -> Values {
        values(&self.problem, &self.theta)
    }

    /// Its values, others put beside or in place of them.
    pub(super) fn values_with(&self, others: &Values) -> Values {
        let mut values = self.values();
        values.extend(others.iter().map(|(key, value)| (key.clone(), *value)));
        values
    }

    /// Those of the parameters added that stand at a bound of their range, with the bound.
    pub(super) fn at_bound<'a>(&self, added: &'a [Added]) -> Vec<(&'a Added, Bound)> {
        let bound = |added: &'a Added| {
            let names = (0..self.theta.len()).map(|place| &self.problem.parameter(place).name);
            let mut bounds = names.zip(&self.bounds);
            let (_, bound) =
                bounds.find(|(name, bound)| **name == added.name && bound.is_some())?;
            Some((added, (*bound)?))
        };
        added.iter().filter_map(bound).collect()
    }

    /// ln L of its residuals with the noise that suits them, its orders paid for.
    pub(super) fn ln_evidence(&self) -> f64 {
        Colour::ln_evidence(&Layout::of(&self.problem), &self.residual)
    }

    /// The orders of the noise that suits its residuals.
    pub(super) fn orders(&self) -> Vec<usize> {
        Colour::of_best_order(&Layout::of(&self.problem), &self.residual).orders()
    }

    pub(super) fn is_coloured(&self) -> bool {
        self.orders().iter().any(|&order| order > 0)
    }

    /// Moved to where the likelihood with the noise that suits it is greatest. A filter has its own: it stays.
    pub(super) fn likeliest(self) -> Self {
        if self.estimate.filter.is_some() {
            return self;
        }
        let orders = self.orders();
        self.polished(&orders)
    }
}
