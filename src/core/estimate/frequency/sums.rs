//! The sums of all segments that a step is made of, from transforms: real and imaginary parts count as two samples.

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::columns::Columns;
use super::evaluator::FrequencyEvaluator;
use crate::estimate::evaluation::evaluate::Evaluate;
use crate::estimate::likelihood::sums::{Product, ResidualSums, Sums, mirror, pairs};
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;

/// Re(a* b): the product of the real parts and that of the imaginary parts.
fn product(a: Complex64, b: Complex64) -> f64 {
    a.re * b.re + a.im * b.im
}

fn add_residuals(residuals: &[Complex64], full: bool, sums: &mut ResidualSums) {
    for (i, j) in pairs(residuals.len(), full) {
        sums[(i, j)] += product(residuals[i], residuals[j]);
    }
}

impl<'p> Evaluate<'p> for FrequencyEvaluator<'p> {
    fn problem(&self) -> &'p Problem {
        &self.transformed().problem
    }

    fn residuals(&mut self, theta: &[f64]) -> Result<ResidualSums, Unusable> {
        self.simulations += 1;
        let problem = self.problem();
        let (outputs, full) = (problem.model.outputs.len(), problem.options.noise.is_full());
        let mut sums = DMatrix::zeros(outputs, outputs);
        for segment in 0..problem.segments.len() {
            self.sweep(segment, theta, None, |at| {
                add_residuals(at.residuals, full, &mut sums);
            })?;
        }
        mirror(&mut sums);
        Ok(sums)
    }

    fn sums(&mut self, theta: &[f64]) -> Result<Sums, Unusable> {
        self.evaluations += 1;
        let problem = self.problem();
        let (outputs, full) = (problem.model.outputs.len(), problem.options.noise.is_full());
        let mut total = Sums::zeros(outputs, problem.unknowns.len(), full);
        for segment in 0..problem.segments.len() {
            let columns = Columns::of(problem, segment);
            let mut own = SegmentSums::new(outputs, columns.places.len(), full);
            self.sweep(segment, theta, Some(&columns), |at| {
                add_residuals(at.residuals, full, &mut total.residuals);
                own.add(at.residuals, at.rows);
            })?;
            own.add_to(&columns, &mut total);
        }
        mirror(&mut total.residuals);
        total.finite()
    }
}

/// The sums of one segment, in its own columns.
struct SegmentSums {
    outputs: usize,
    width: usize,
    full: bool,
    /// By output i, then j, then column: Σ S_iᵀ e_j.
    gradients: Vec<Vec<Vec<f64>>>,
    /// By pair of outputs: Σ S_iᵀ S_j, row by row.
    products: Vec<Vec<f64>>,
}

impl SegmentSums {
    fn new(outputs: usize, width: usize, full: bool) -> Self {
        let across = if full { outputs } else { 1 };
        Self {
            outputs,
            width,
            full,
            gradients: vec![vec![vec![0.0; width]; across]; outputs],
            products: vec![vec![0.0; width * width]; pairs(outputs, full).count()],
        }
    }

    fn add(&mut self, residuals: &[Complex64], rows: &[Complex64]) {
        let row = |output: usize| &rows[output * self.width..(output + 1) * self.width];
        for (i, gradients) in self.gradients.iter_mut().enumerate() {
            for (j, gradient) in gradients.iter_mut().enumerate() {
                let residual = residuals[if self.full { j } else { i }];
                for (sum, s) in gradient.iter_mut().zip(row(i)) {
                    *sum += product(*s, residual);
                }
            }
        }
        for (sums, (i, j)) in self.products.iter_mut().zip(pairs(self.outputs, self.full)) {
            for (a, s) in row(i).iter().enumerate() {
                if *s == Complex64::ZERO {
                    continue;
                }
                let until = if i == j { a + 1 } else { self.width };
                let sums = sums[a * self.width..].iter_mut().zip(&row(j)[..until]);
                sums.for_each(|(sum, other)| *sum += product(*s, *other));
            }
        }
    }

    fn add_to(self, columns: &Columns, total: &mut Sums) {
        let places: Vec<Option<usize>> = columns.places.iter().map(|&place| Some(place)).collect();
        let width = self.width;
        let gradients = self.gradients.iter();
        let gradients = gradients.map(|by_other| by_other.iter().map(Vec::as_slice));
        let products = self.products.into_iter();
        let products = products.map(|values| Product { values, width });
        total.add(vec![places; self.outputs], gradients, products);
    }
}
