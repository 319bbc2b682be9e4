//! The sums of one segment, in the columns of its own sensitivities.

use nalgebra::DMatrix;

use super::missing::Missing;
use crate::estimate::likelihood::sums::{Product, Sums, pair, pairs};
use crate::estimate::linear::products::{add_combination, add_cross_products, add_products, dot};
use crate::estimate::problem::Problem;
use crate::simulate::{Block, PACK, Pack, Segment, packs};
use crate::stop;

/// Columns beyond which the products of one output alone take long.
const WIDE: usize = 64;

pub(crate) struct LocalSums {
    full: bool,
    /// By output: columns of its sensitivities.
    widths: Vec<usize>,
    residuals: DMatrix<f64>,
    /// By pair of outputs (i, j): a row of packs over the columns of j for each column of i.
    /// Where i = j only packs up to the diagonal are summed.
    products: Vec<Vec<Pack>>,
    /// By output i, then j: Σ S_iᵀ e_j.
    gradients: Vec<Vec<Vec<Pack>>>,
    /// By output: the residuals of the block.
    block_residuals: Vec<Vec<f64>>,
    missing: Missing,
}

impl LocalSums {
    /// `full`: the noise of the outputs is correlated, so that all pairs of outputs count.
    pub(crate) fn new(problem: &Problem, full: bool) -> Self {
        let outputs = problem.model.outputs.len();
        let widths: Vec<usize> = (0..outputs)
            .map(|i| problem.columns.of_output(i).len())
            .collect();
        let products = pairs(outputs, full)
            .map(|(i, j)| vec![Pack::default(); widths[i] * packs(widths[j])])
            .collect();
        let columns = if full { outputs } else { 1 };
        let gradients = widths
            .iter()
            .map(|&width| vec![vec![Pack::default(); packs(width)]; columns])
            .collect();
        let block_residuals = vec![Vec::new(); outputs];
        Self {
            full,
            widths,
            residuals: DMatrix::zeros(outputs, outputs),
            products,
            gradients,
            block_residuals,
            missing: Missing::new(problem),
        }
    }

    pub(crate) fn add(&mut self, block: &Block<'_>, segment: &Segment) {
        let outputs = self.widths.len();
        for (i, residuals) in self.block_residuals.iter_mut().enumerate() {
            let measured = &segment.measured[i][block.first..block.first + block.len];
            residuals.clear();
            residuals.extend(measured.iter().zip(block.output(i)).map(|(z, y)| z - y));
        }
        self.missing
            .leave_out(block, segment, &mut self.block_residuals);
        let residuals = &self.block_residuals;
        for i in 0..outputs {
            let rows = self.missing.rows(block, i);
            let is_wide = self.widths[i] > WIDE;
            for j in if self.full { 0..i } else { i..i } {
                if is_wide {
                    stop::check();
                }
                self.residuals[(i, j)] += dot(&residuals[i], &residuals[j]);
                let to = &mut self.products[pair(i, j, true)];
                add_cross_products(
                    to,
                    rows,
                    self.widths[i],
                    self.missing.rows(block, j),
                    self.widths[j],
                );
            }
            if is_wide {
                stop::check();
            }
            self.residuals[(i, i)] += dot(&residuals[i], &residuals[i]);
            add_products(
                &mut self.products[pair(i, i, self.full)],
                rows,
                self.widths[i],
            );
            for (j, gradient) in self.gradients[i].iter_mut().enumerate() {
                add_combination(gradient, rows, &residuals[if self.full { j } else { i }]);
            }
        }
    }

    /// Adds to the sums of all segments.
    pub(crate) fn add_to(self, problem: &Problem, segment: usize, total: &mut Sums) {
        let places = |output: usize| -> Vec<Option<usize>> {
            let parameters = problem.columns.of_output(output).iter();
            parameters
                .map(|&parameter| problem.unknowns.place(segment, parameter))
                .collect()
        };
        let places: Vec<_> = (0..self.widths.len()).map(places).collect();
        total.residuals += &self.residuals;
        let gradients = self.gradients.iter();
        let gradients = gradients.map(|of_output| of_output.iter().map(|sum| sum.as_flattened()));
        let across = pairs(self.widths.len(), self.full).map(|(_, j)| packs(self.widths[j]));
        let product = |(sums, across): (Vec<Pack>, usize)| Product {
            values: sums.as_flattened().to_vec(),
            width: across * PACK,
        };
        let products = self.products.into_iter().zip(across).map(product);
        total.add(places, gradients, products);
    }
}
