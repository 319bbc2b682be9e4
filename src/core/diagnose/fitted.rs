//! A model fitted to the case, with the likelihood that counts.

use std::ops::ControlFlow;

use super::case::{Case, Unfit, Values, values};
use super::colour::Colour;
use super::stack::Layout;
use crate::estimate::{
    Bound, ErrorBoundsKind, Estimate, Outcome, Problem, Role, TimeHistory, output_error, predict,
};
use crate::model::ModelDocument;

/// A model and its fit to the estimation flights.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub document: ModelDocument,
    pub problem: Problem,
    pub estimate: Estimate,
    pub values: Values,
    /// Over [`Layout::of`] the problem.
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
            .map_err(|_| Unfit("the simulation leaves the range of numbers".into()))?;
        if solution.estimate.outcome == Outcome::Diverged {
            return Err(Unfit(solution.estimate.reason));
        }
        Ok(Self::of(
            document,
            problem,
            solution.estimate,
            &solution.histories,
        ))
    }

    pub(super) fn of(
        document: ModelDocument,
        problem: Problem,
        estimate: Estimate,
        histories: &[TimeHistory],
    ) -> Self {
        Self {
            residual: Layout::of(&problem).residual(histories),
            values: values(&problem, &estimate),
            document,
            problem,
            estimate,
        }
    }

    /// Its values, others put beside or in place of them.
    pub(super) fn values_with(&self, others: &Values) -> Values {
        let mut values = self.values.clone();
        values.extend(others.iter().map(|(key, value)| (key.clone(), *value)));
        values
    }

    /// Names of the parameters added that stand at a bound of their range.
    pub(super) fn at_bound(&self, base: &Self) -> Vec<(String, Bound)> {
        let declared = &base.problem.model.parameters;
        let rows = self.estimate.parameters.iter();
        let was_free = |name: &str| {
            declared
                .iter()
                .any(|info| info.name == name && !info.document.fixed)
        };
        rows.filter(|row| !was_free(&row.name))
            .filter_map(|row| Some((row.name.clone(), row.at_bound?)))
            .collect()
    }

    pub(super) fn theta(&self) -> Vec<f64> {
        let problem = &self.problem;
        let of = |place: usize| {
            let unknown = problem.unknowns.at(place);
            let name = problem.model.parameters[unknown.parameter].name.clone();
            let segment = unknown
                .segment
                .map(|segment| problem.segments[segment].label.clone());
            self.values
                .get(&(name, segment))
                .copied()
                .unwrap_or(unknown.start)
        };
        (0..problem.unknowns.len()).map(of).collect()
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
            let (prediction, history) = predict(&problem, &self.estimate, &validation);
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
