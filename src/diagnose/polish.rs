//! Steps of generalised least squares: output error weighs all samples alike, and where the noise is coloured its
//! estimate is not the likeliest. An effect that is sharp against slow noise (a delay of half a sample) is lost
//! without them.

use nalgebra::{DMatrix, DVector};

use super::colour::Colour;
use super::fitted::Fitted;
use super::projection::{dot, least_squares, norm};
use super::stack::{Layout, sensitivities};
use crate::model::Per;

/// The colour and the step depend on each other: twice is enough.
const STEPS: usize = 2;

/// Directions that are weaker than this, relative to the strongest, stay as they are.
const WEAKEST: f64 = 1e-8;

impl Fitted {
    /// The fit moved to where the likelihood with noise of these orders is greatest, the outputs linear in the
    /// parameters. As it was where all orders are 0, or nothing is gained.
    #[must_use]
    pub fn polished(mut self, orders: &[usize]) -> Self {
        if orders.iter().all(|&order| order == 0) || self.problem.unknowns.is_empty() {
            return self;
        }
        let layout = Layout::of(&self.problem);
        let Some(columns) = self.columns(&layout) else {
            return self;
        };
        let mut best: f64 = self.ln_likelihood(orders);
        for _ in 0..STEPS {
            let colour = Colour::of_orders(&layout, &self.residual, orders);
            let whiten = |column: &Vec<f64>| colour.whiten(&layout, &self.residual, column);
            let whitened: Vec<Vec<f64>> = columns.iter().map(whiten).collect();
            let residual = whiten(&self.residual);
            let scale: Vec<f64> = whitened
                .iter()
                .map(|column| norm(column).max(f64::MIN_POSITIVE))
                .collect();
            let count = columns.len();
            let gram = DMatrix::from_fn(count, count, |i, j| {
                dot(&whitened[i], &whitened[j]) / (scale[i] * scale[j])
            });
            let moment = DVector::from_fn(count, |i, _| dot(&whitened[i], &residual) / scale[i]);
            let Some(step) = least_squares(gram, &moment, WEAKEST) else {
                break;
            };
            let step: Vec<f64> = step
                .iter()
                .zip(&scale)
                .map(|(step, scale)| step / scale)
                .collect();
            let mut moved = self.clone();
            for (column, step) in columns.iter().zip(&step) {
                moved
                    .residual
                    .iter_mut()
                    .zip(column)
                    .for_each(|(e, s)| *e -= step * s);
            }
            let likelihood = moved.ln_likelihood(orders);
            if likelihood.is_nan() || likelihood <= best || !moved.advance(&step) {
                break;
            }
            (best, self) = (likelihood, moved);
        }
        self
    }

    /// Sensitivities by place of θ.
    fn columns(&self, layout: &Layout) -> Option<Vec<Vec<f64>>> {
        let problem = &self.problem;
        let mut free: Vec<usize> = (0..problem.unknowns.len())
            .map(|place| problem.unknowns.at(place).parameter)
            .collect();
        free.dedup();
        // as the unknowns are laid out: parameter by parameter, each followed by its segments
        let of = |parameter: &usize| match problem.model.parameters[*parameter].document.per {
            Per::Job => 1,
            Per::Maneuver => problem.segments.len(),
        };
        let count: usize = free.iter().map(of).sum();
        (count == problem.unknowns.len())
            .then(|| sensitivities(problem, layout, &self.theta(), &free))
            .flatten()
    }

    /// Moves the estimate; `false` where it would leave its bounds.
    fn advance(&mut self, step: &[f64]) -> bool {
        let theta = self.theta();
        for (place, step) in step.iter().enumerate() {
            let unknown = self.problem.unknowns.at(place);
            let value = theta[place] + step;
            if !(unknown.lower..=unknown.upper).contains(&value) {
                return false;
            }
            let info = &self.problem.model.parameters[unknown.parameter];
            let segment = unknown
                .segment
                .map(|s| self.problem.segments[s].label.clone());
            let rows = self.estimate.parameters.iter_mut();
            for row in rows.filter(|row| row.name == info.name && row.segment == segment) {
                row.estimate = info.unit.from_si(value);
            }
            self.values.insert((info.name.clone(), segment), value);
        }
        true
    }
}
