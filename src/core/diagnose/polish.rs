//! Generalised least squares: output error weighs all samples alike, and where the noise is coloured its estimate is not
//! the likeliest. An effect that is sharp against slow noise (a delay of half a sample) is lost
//! without them.

use nalgebra::{DMatrix, DVector};

use super::colour::Colour;
use super::fitted::Fitted;
use super::projection::{least_squares, norm, products};
use super::stack::{Layout, Linearised, linearised};
use crate::estimate::Bound;
use crate::stop;

/// The colour is that of the residual, so that each step has another: some are needed.
const STEPS: usize = 8;

/// A gain of ln L that is not worth a step.
const SETTLED: f64 = 0.01;

/// Shares of a step that are tried.
const SHARES: [f64; 4] = [1.0, 0.5, 0.25, 0.1];

/// Directions that are weaker than this, relative to the strongest, stay as they are.
const WEAKEST: f64 = 1e-8;

impl Fitted {
    /// The fit moved to where the likelihood with noise of these orders is greatest. As it was where all orders are 0, or
    /// nothing is gained.
    #[must_use]
    pub(super) fn polished(mut self, orders: &[usize]) -> Self {
        if orders.iter().all(|&order| order == 0) || self.problem.unknowns.is_empty() {
            return self;
        }
        let layout = Layout::of(&self.problem);
        let mut free: Vec<usize> = (0..self.problem.unknowns.len())
            .map(|place| self.problem.unknowns.at(place).parameter)
            .collect();
        free.dedup();
        let at = |theta: &[f64]| {
            // columns stand as the unknowns do: parameter by parameter, each followed by its segments
            let model = linearised(&self.problem, &layout, theta, &free).ok();
            model.filter(|model| model.sensitivities.len() == theta.len())
        };
        let ln_likelihood = |model: &Linearised| {
            Colour::of_orders(&layout, &model.residual, orders)
                .ln_likelihood(&layout, &model.residual)
        };
        let mut theta = self.theta.clone();
        let Some(mut here) = at(&theta) else {
            return self;
        };
        let before = ln_likelihood(&here);
        let mut best = before;
        for _ in 0..STEPS {
            let Some((step, promise)) = self.step(&layout, orders, &theta, &here) else {
                break;
            };
            if promise < SETTLED {
                break;
            }
            let further = SHARES.iter().find_map(|share| {
                let theta = self.moved(&theta, &step, *share);
                let there = at(&theta)?;
                let likelihood = ln_likelihood(&there);
                (likelihood > best).then_some((theta, there, likelihood))
            });
            let Some(further) = further else { break };
            let gain = further.2 - best;
            (theta, here, best) = further;
            if gain < SETTLED {
                break;
            }
        }
        if best > before {
            self.residual = here.residual;
            self.put(theta);
        }
        self
    }

    /// The step of generalised least squares, and by how much ln L would grow with it if the outputs were linear. What
    /// would leave its bounds stays.
    fn step(
        &self,
        layout: &Layout,
        orders: &[usize],
        theta: &[f64],
        here: &Linearised,
    ) -> Option<(Vec<f64>, f64)> {
        let colour = Colour::of_orders(layout, &here.residual, orders);
        let whiten = |column: &Vec<f64>| colour.whiten(layout, &here.residual, column);
        let residual = whiten(&here.residual);
        let whitened: Vec<Vec<f64>> = here.sensitivities.iter().map(whiten).collect();
        let lengths: Vec<f64> = (whitened.iter())
            .map(|column| norm(column).max(f64::MIN_POSITIVE))
            .collect();
        // a product of matrices is far quicker than products of columns
        let columns = DMatrix::from_fn(residual.len(), theta.len(), |row, place| {
            stop::check_sometimes(row);
            whitened[place][row] / lengths[place]
        });
        let whole = products(&columns, &columns);
        let all = columns.tr_mul(&DVector::from_vec(residual));
        let mut held = vec![false; theta.len()];
        loop {
            let places: Vec<usize> = (0..theta.len()).filter(|&place| !held[place]).collect();
            let count = places.len();
            let gram = DMatrix::from_fn(count, count, |i, j| whole[(places[i], places[j])]);
            let moment = DVector::from_fn(count, |i, _| all[places[i]]);
            let solved = least_squares(gram, &moment, WEAKEST)?;
            let mut step = vec![0.0; theta.len()];
            for (i, &place) in places.iter().enumerate() {
                step[place] = solved[i] / lengths[place];
            }
            let leaves = |place: &usize| {
                let unknown = self.problem.unknowns.at(*place);
                (theta[*place] <= unknown.lower && step[*place] < 0.0)
                    || (theta[*place] >= unknown.upper && step[*place] > 0.0)
            };
            let leaving: Vec<usize> = places.iter().copied().filter(leaves).collect();
            if leaving.is_empty() {
                return Some((step, 0.5 * solved.dot(&moment)));
            }
            leaving.iter().for_each(|&place| held[place] = true);
        }
    }

    /// A share of a step from `theta`, within the bounds.
    fn moved(&self, theta: &[f64], step: &[f64], share: f64) -> Vec<f64> {
        let of = |place: usize| {
            let unknown = self.problem.unknowns.at(place);
            (theta[place] + share * step[place]).clamp(unknown.lower, unknown.upper)
        };
        (0..theta.len()).map(of).collect()
    }

    /// Makes `theta` the estimate.
    fn put(&mut self, theta: Vec<f64>) {
        let bound = |(place, &value): (usize, &f64)| {
            let unknown = self.problem.unknowns.at(place);
            if value <= unknown.lower {
                Some(Bound::Lower)
            } else if value >= unknown.upper {
                Some(Bound::Upper)
            } else {
                None
            }
        };
        self.bounds = theta.iter().enumerate().map(bound).collect();
        self.theta = theta;
    }
}
