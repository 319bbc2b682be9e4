//! One look at the data for a θ: residuals, and with sensitivities the sums that a step is made of.
//!
//! Sums are kept by output and unweighted, since R is known only when all residuals are.

use nalgebra::{DMatrix, DVector};

use super::options::{Noise, NoiseStructure};
use super::problem::Problem;
use crate::simulate::{Block, Segment, Sensitivities, simulate};

/// The simulation left the range of numbers: where, as far as it is known.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct LeftRange {
    pub segment: usize,
    pub sample: Option<usize>,
}

/// Σ e eᵀ over all samples, outputs by outputs; only the diagonal unless R is full.
pub(super) type ResidualSums = DMatrix<f64>;

/// For each pair of outputs (i, j), j ≤ i: Σ S_iᵀ S_j and Σ S_iᵀ e_j over all samples, in θ's places.
#[derive(Clone, Debug)]
pub(super) struct Sums {
    pub residuals: ResidualSums,
    /// By pair; see [`pair`].
    pub products: Vec<DMatrix<f64>>,
    /// By output i, then j: Σ S_iᵀ e_j.
    pub gradients: Vec<Vec<DVector<f64>>>,
}

/// Evaluates a problem at any θ; buffers are kept.
pub struct Evaluator<'p> {
    problem: &'p Problem,
    machinery: Sensitivities<'p>,
    parameters: Vec<f64>,
    residuals: Vec<Vec<f64>>,
    full: bool,
    /// Simulations with sensitivities, and without, so far.
    pub evaluations: usize,
    pub simulations: usize,
}

impl<'p> Evaluator<'p> {
    pub fn new(problem: &'p Problem) -> Self {
        let options = &problem.options;
        let machinery = Sensitivities::new(
            &problem.model,
            &problem.columns,
            options.integrator,
            options.input_interpolation,
        );
        let full = matches!(
            options.noise,
            Noise::Estimated {
                structure: NoiseStructure::Full
            }
        );
        Self {
            problem,
            machinery,
            parameters: Vec::new(),
            residuals: vec![Vec::new(); problem.model.outputs.len()],
            full,
            evaluations: 0,
            simulations: 0,
        }
    }

    pub(super) fn problem(&self) -> &'p Problem {
        self.problem
    }

    /// Residuals alone.
    pub(super) fn residuals(&mut self, theta: &[f64]) -> Result<ResidualSums, LeftRange> {
        self.simulations += 1;
        let problem = self.problem;
        let options = &problem.options;
        let outputs = problem.model.outputs.len();
        let mut sums = DMatrix::zeros(outputs, outputs);
        let mut residual = vec![0.0; outputs];
        for (index, segment) in problem.segments.iter().enumerate() {
            problem
                .unknowns
                .parameters(index, theta, &mut self.parameters);
            let (model, integrator) = (&problem.model, options.integrator);
            simulate(
                model,
                integrator,
                options.input_interpolation,
                segment,
                &self.parameters,
                |k, y: &[f64]| {
                    for i in 0..outputs {
                        residual[i] = segment.measured[i][k] - y[i];
                        for j in if self.full { 0..i } else { i..i } {
                            sums[(i, j)] += residual[i] * residual[j];
                        }
                        sums[(i, i)] += residual[i] * residual[i];
                    }
                },
            );
        }
        mirror(&mut sums);
        if sums.iter().all(|v| v.is_finite()) {
            Ok(sums)
        } else {
            Err(LeftRange::default())
        }
    }

    /// Residuals and the sums of their sensitivities.
    pub(super) fn sums(&mut self, theta: &[f64]) -> Result<Sums, LeftRange> {
        self.evaluations += 1;
        let problem = self.problem;
        let outputs = problem.model.outputs.len();
        let unknowns = problem.unknowns.len();
        let pairs = if self.full {
            outputs * (outputs + 1) / 2
        } else {
            outputs
        };
        let mut total = Sums {
            residuals: DMatrix::zeros(outputs, outputs),
            products: vec![DMatrix::zeros(unknowns, unknowns); pairs],
            gradients: vec![
                vec![DVector::zeros(unknowns); if self.full { outputs } else { 1 }];
                outputs
            ],
        };
        for (index, segment) in problem.segments.iter().enumerate() {
            problem
                .unknowns
                .parameters(index, theta, &mut self.parameters);
            let mut local = LocalSums::new(problem, self.full);
            let residuals = &mut self.residuals;
            self.machinery
                .run(segment, &self.parameters, |block| {
                    local.add(block, segment, residuals)
                })
                .map_err(|diverged| LeftRange {
                    segment: index,
                    sample: Some(diverged.sample),
                })?;
            local.scatter(problem, index, &mut total);
        }
        mirror(&mut total.residuals);
        let finite = total.residuals.iter().all(|v| v.is_finite())
            && total
                .products
                .iter()
                .all(|product| product.iter().all(|v| v.is_finite()));
        if finite {
            Ok(total)
        } else {
            Err(LeftRange::default())
        }
    }
}

/// Where the pair of outputs (i, j), j ≤ i, is kept.
pub(super) fn pair(i: usize, j: usize, full: bool) -> usize {
    if full { i * (i + 1) / 2 + j } else { i }
}

fn mirror(sums: &mut DMatrix<f64>) {
    for i in 0..sums.nrows() {
        for j in 0..i {
            sums[(j, i)] = sums[(i, j)];
        }
    }
}

/// The sums of one segment, in the columns of its own sensitivities.
struct LocalSums {
    full: bool,
    widths: Vec<usize>,
    residuals: DMatrix<f64>,
    /// By pair: row-major, width of i by width of j; the lower triangle where i = j.
    products: Vec<Vec<f64>>,
    /// By output i, then j: Σ S_iᵀ e_j.
    gradients: Vec<Vec<Vec<f64>>>,
}

impl LocalSums {
    fn new(problem: &Problem, full: bool) -> Self {
        let outputs = problem.model.outputs.len();
        let widths: Vec<usize> = (0..outputs)
            .map(|i| problem.columns.of_output(i).len())
            .collect();
        let pairs = (0..outputs).flat_map(|i| (if full { 0 } else { i }..=i).map(move |j| (i, j)));
        let products = pairs
            .map(|(i, j)| vec![0.0; widths[i] * widths[j]])
            .collect();
        let columns = if full { outputs } else { 1 };
        let gradients = widths
            .iter()
            .map(|&width| vec![vec![0.0; width]; columns])
            .collect();
        Self {
            full,
            widths,
            residuals: DMatrix::zeros(outputs, outputs),
            products,
            gradients,
        }
    }

    fn add(&mut self, block: &Block<'_>, segment: &Segment, residuals: &mut [Vec<f64>]) {
        let outputs = self.widths.len();
        for (i, residual) in residuals.iter_mut().enumerate() {
            let measured = &segment.measured[i][block.first..block.first + block.len];
            residual.clear();
            residual.extend(measured.iter().zip(block.output(i)).map(|(z, y)| z - y));
        }
        for i in 0..outputs {
            let width = self.widths[i];
            let rows = block.sensitivity(i);
            for j in if self.full { 0..i } else { i..i } {
                self.residuals[(i, j)] += dot(&residuals[i], &residuals[j]);
                let other = block.sensitivity(j);
                let to = &mut self.products[pair(i, j, true)];
                add_cross_products(to, rows, width, other, self.widths[j], block.len);
            }
            self.residuals[(i, i)] += dot(&residuals[i], &residuals[i]);
            add_products(
                &mut self.products[pair(i, i, self.full)],
                rows,
                width,
                block.len,
            );
            for (j, gradient) in self.gradients[i].iter_mut().enumerate() {
                let residual = &residuals[if self.full { j } else { i }];
                for (k, &e) in residual.iter().enumerate() {
                    for (to, &s) in gradient.iter_mut().zip(&rows[k * width..(k + 1) * width]) {
                        *to += s * e;
                    }
                }
            }
        }
    }

    fn scatter(&self, problem: &Problem, segment: usize, total: &mut Sums) {
        let outputs = self.widths.len();
        let places = |output: usize| -> Vec<Option<usize>> {
            let parameters = problem.columns.of_output(output).iter();
            parameters
                .map(|&parameter| problem.unknowns.place(segment, parameter))
                .collect()
        };
        total.residuals += &self.residuals;
        for i in 0..outputs {
            let rows = places(i);
            for j in if self.full { 0..=i } else { i..=i } {
                let columns = places(j);
                let from = &self.products[pair(i, j, self.full)];
                let to = &mut total.products[pair(i, j, self.full)];
                for (a, row) in rows.iter().enumerate() {
                    for (b, column) in columns.iter().enumerate() {
                        let (Some(row), Some(column)) = (*row, *column) else {
                            continue;
                        };
                        // only the lower triangle is summed where both are the same
                        let value = if i == j && b > a {
                            from[b * columns.len() + a]
                        } else {
                            from[a * columns.len() + b]
                        };
                        to[(row, column)] += value;
                    }
                }
            }
            for (gradient, to) in self.gradients[i].iter().zip(&mut total.gradients[i]) {
                for (&value, place) in gradient.iter().zip(&rows) {
                    if let Some(place) = *place {
                        to[place] += value;
                    }
                }
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// to += Σ_k row_k row_kᵀ, the lower triangle; four samples at a time, so that sums stay in registers longer.
fn add_products(to: &mut [f64], rows: &[f64], width: usize, count: usize) {
    let mut quads = rows[..count * width].chunks_exact(4 * width);
    for quad in &mut quads {
        let (r0, rest) = quad.split_at(width);
        let (r1, rest) = rest.split_at(width);
        let (r2, r3) = rest.split_at(width);
        for a in 0..width {
            let (s0, s1, s2, s3) = (r0[a], r1[a], r2[a], r3[a]);
            let line = &mut to[a * width..a * width + a + 1];
            for ((((to, v0), v1), v2), v3) in line.iter_mut().zip(r0).zip(r1).zip(r2).zip(r3) {
                *to += s0 * v0 + s1 * v1 + (s2 * v2 + s3 * v3);
            }
        }
    }
    for row in quads.remainder().chunks_exact(width.max(1)) {
        for a in 0..width {
            let line = &mut to[a * width..a * width + a + 1];
            line.iter_mut()
                .zip(row)
                .for_each(|(to, value)| *to += row[a] * value);
        }
    }
}

/// to += Σ_k left_k right_kᵀ
fn add_cross_products(
    to: &mut [f64],
    left: &[f64],
    width: usize,
    right: &[f64],
    across: usize,
    count: usize,
) {
    for k in 0..count {
        let right = &right[k * across..(k + 1) * across];
        for a in 0..width {
            let factor = left[k * width + a];
            let line = &mut to[a * across..(a + 1) * across];
            line.iter_mut()
                .zip(right)
                .for_each(|(to, value)| *to += factor * value);
        }
    }
}
