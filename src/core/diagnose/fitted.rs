//! A model fitted to the case, with the likelihood that counts.

use std::ops::ControlFlow;

use nalgebra::DMatrix;

use super::case::{Case, Unfit, Values, values};
use super::colour::Colour;
use super::stack::Layout;
use crate::estimate::{
    Bound, ErrorBoundsKind, Estimate, Outcome, Problem, Role, Solution, output_error, predict,
};
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
}

/// Trials are stopped at this many standard errors from their minimum: 1e-6 of a unit of the likelihood ratio.
const TRIAL_TOLERANCE: f64 = 1e-3;
const TRIAL_ITERATIONS: usize = 30;

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
        Self::within(TRIAL_ITERATIONS, case, document, start)
    }

    /// No fit at all: the model at given values.
    ///
    /// # Errors
    /// The model does not fit the recordings, or leaves the range of numbers.
    pub(super) fn at(case: &Case, document: ModelDocument, values: &Values) -> Result<Self, Unfit> {
        Self::within(0, case, document, values)
    }

    fn within(
        iterations: usize,
        case: &Case,
        document: ModelDocument,
        start: &Values,
    ) -> Result<Self, Unfit> {
        let mut problem = case.problem(&document, start)?;
        problem.options.error_bounds = ErrorBoundsKind::Conventional;
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
            document,
            problem,
        }
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

    /// Those of the parameters added that stand at a bound of their range.
    pub(super) fn at_bound<'a>(&self, added: &'a [Added]) -> Vec<&'a Added> {
        let is_at_bound = |added: &&Added| {
            let names = (0..self.theta.len()).map(|place| &self.problem.parameter(place).name);
            (names.zip(&self.bounds)).any(|(name, bound)| *name == added.name && bound.is_some())
        };
        added.iter().filter(is_at_bound).collect()
    }

    /// ln L of its residuals by output, with noise of given orders.
    pub(super) fn ln_likelihood(&self, orders: &[usize]) -> f64 {
        let layout = Layout::of(&self.problem);
        Colour::of_orders(&layout, &self.residual, orders).ln_likelihood(&layout, &self.residual)
    }

    /// Predicts the flights of a role; ln L by output of the prediction's residuals, with noise of given orders.
    ///
    /// # Errors
    /// The prediction leaves the range of numbers.
    pub(super) fn held_out(
        &self,
        case: &Case,
        role: Role,
        orders: &[usize],
    ) -> Result<Vec<f64>, Unfit> {
        let mut problem = self.problem.clone();
        problem.options.error_bounds = ErrorBoundsKind::Conventional;
        let mut histories = Vec::new();
        for validation in case.held_out(role, &self.problem)? {
            let (prediction, history) =
                predict(&problem, &self.theta, &self.covariance, &validation);
            histories.push(history.ok_or(Unfit(prediction.reason))?);
        }
        let lengths: Vec<usize> = histories.iter().map(|history| history.time.len()).collect();
        let layout = Layout::of_lengths(&lengths, self.problem.model.outputs.len());
        let residual = layout.residual(&histories);
        let colour = Colour::of_orders(&layout, &residual, orders);
        let of = |output| colour.ln_likelihood_of(&layout, &residual, output);
        Ok((0..layout.outputs).map(of).collect())
    }
}
