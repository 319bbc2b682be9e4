//! Weighted least squares of several equations from their sums: θ, the variance of each equation, and standard errors.
//!
//! ```text
//! M = Σ_i M_i/s_i²,  M θ = Σ_i b_i/s_i²,  s_i² = Σ w e²/Σ w
//! cov θ = M⁻¹ (Σ_i Σ_l r_il (S_il + S_ilᵀ)/s_i⁴) M⁻¹
//! ```
//!
//! The second is that of weighted least squares with residuals that are correlated over some lags, r_il their covariance (Morelli
//! and Klein, Aircraft System Identification, sec. 5.3), with a taper to zero; where they are white, it is M⁻¹.

use super::sums::{Sums, of_residuals};

/// What is left of a column after those before it, as a share of its own sum of squares, at which it is no longer told from them.
const INDEPENDENT: f64 = 1e-10;

/// A share of a column, both of length 1, that is nothing to rounding.
const NO_PART: f64 = 1e-4;

/// Rounds of weights, where equations share parameters. They go on with the next sample.
const MOST_ROUNDS: usize = 5;

/// Change of a variance, as a share, at which weights stand.
const SETTLED: f64 = 1e-10;

/// The machinery, made once.
pub(super) struct Solver {
    columns: usize,
    /// The first columns are constants and the like, which nobody asks for. They are eliminated first, and those that are not told from
    /// one another are left out.
    nuisances: usize,
    /// Of a column that is not told from those before it: what share of each it is made of.
    shares: Vec<f64>,
    /// Whether a column is in several equations.
    shared: bool,
    matrix: Vec<f64>,
    /// M⁻¹.
    inverse: Vec<f64>,
    middle: Vec<f64>,
    product: Vec<f64>,
    right: Vec<f64>,
    scale: Vec<f64>,
    undetermined: Vec<bool>,
    /// By equation: s².
    variances: Vec<f64>,
    theta: Vec<f64>,
    /// By column that is asked for.
    estimates: Vec<f64>,
    standard_errors: Vec<f64>,
}

impl Solver {
    /// Of columns `nuisances`, and behind them `asked`.
    pub(super) fn new(nuisances: usize, asked: usize, rows: &[Sums]) -> Self {
        let columns = nuisances + asked;
        let square = vec![0.0; columns * columns];
        let uses = |column: usize| {
            rows.iter()
                .filter(|row| row.columns.contains(&column))
                .count()
        };
        Self {
            columns,
            nuisances,
            shares: vec![0.0; columns],
            shared: (0..columns).any(|column| uses(column) > 1),
            matrix: square.clone(),
            inverse: square.clone(),
            middle: square.clone(),
            product: square,
            right: vec![0.0; columns],
            scale: vec![0.0; columns],
            undetermined: vec![false; columns],
            variances: vec![1.0; rows.len()],
            theta: vec![0.0; columns],
            estimates: vec![f64::NAN; asked],
            standard_errors: vec![f64::NAN; asked],
        }
    }

    /// What was found of the columns that are asked for, and its standard errors.
    pub(super) fn found(&self, values: &mut [f64], standard_errors: &mut [f64]) {
        values.copy_from_slice(&self.estimates);
        standard_errors.copy_from_slice(&self.standard_errors);
    }

    /// Solves the equations. What they do not determine is NaN.
    pub(super) fn solve(&mut self, rows: &[Sums]) {
        for _ in 0..MOST_ROUNDS {
            self.assemble(rows);
            self.factor();
            self.back_substitute();
            let settled = self.weigh(rows);
            if settled || !self.shared {
                break;
            }
        }
        // with the weights that stand now
        self.assemble(rows);
        self.factor();
        self.invert();
        self.accumulate(rows);
        self.bound(rows);
    }

    fn assemble(&mut self, rows: &[Sums]) {
        self.matrix.fill(0.0);
        self.right.fill(0.0);
        for (row, variance) in rows.iter().zip(&self.variances) {
            let width = row.width();
            for (i, &a) in row.columns.iter().enumerate() {
                let products = &row.products[i * width..(i + 1) * width];
                for (&b, value) in row.columns.iter().zip(products) {
                    self.matrix[a * self.columns + b] += value / variance;
                }
                self.right[a] += products[width - 1] / variance;
            }
        }
        for (column, scale) in self.scale.iter_mut().enumerate() {
            let own = self.matrix[column * self.columns + column];
            *scale = if own > 0.0 { 1.0 / own.sqrt() } else { 0.0 };
        }
    }

    /// L Lᵀ of the matrix with ones on its diagonal, below and on the diagonal of `matrix`. A column that is not told from those before
    /// it is left out, and those are not determined that it is made of.
    fn factor(&mut self) {
        let n = self.columns;
        self.undetermined.fill(false);
        for i in 0..n {
            for j in 0..i {
                let product = self.matrix[i * n + j] * self.scale[i] * self.scale[j];
                let value = product - self.sum_of_products(i, j);
                self.matrix[i * n + j] = value / self.matrix[j * n + j];
            }
            let own = self.matrix[i * n + i] * self.scale[i] * self.scale[i];
            let left = own - self.sum_of_products(i, i);
            self.matrix[i * n + i] = left.max(INDEPENDENT).sqrt();
            if left > INDEPENDENT {
                continue;
            }
            self.give_up(i);
            self.matrix[i * n..i * n + i].fill(0.0);
            self.matrix[i * n + i] = 1.0;
            self.scale[i] = 0.0;
        }
    }

    /// Σ_k L_ik L_jk over the columns before j.
    fn sum_of_products(&self, i: usize, j: usize) -> f64 {
        let n = self.columns;
        let both = self.matrix[i * n..i * n + j]
            .iter()
            .zip(&self.matrix[j * n..j * n + j]);
        both.map(|(a, b)| a * b).sum()
    }

    /// Of a column that has just been found to be a sum of those before it.
    fn give_up(&mut self, column: usize) {
        let n = self.columns;
        self.undetermined[column] = true;
        for k in (0..column).rev() {
            let later = (k + 1..column).map(|m| self.matrix[m * n + k] * self.shares[m]);
            let sum: f64 = later.sum();
            self.shares[k] = (self.matrix[column * n + k] - sum) / self.matrix[k * n + k];
            // those that nobody asks for may stand for one another
            let is_part = self.shares[k].abs() > NO_PART && column >= self.nuisances;
            self.undetermined[k] |= is_part;
        }
    }

    fn back_substitute(&mut self) {
        let n = self.columns;
        for (theta, (right, scale)) in self
            .theta
            .iter_mut()
            .zip(self.right.iter().zip(&self.scale))
        {
            *theta = right * scale;
        }
        solve_factored(&self.matrix, n, &mut self.theta);
        for (theta, scale) in self.theta.iter_mut().zip(&self.scale) {
            *theta *= scale;
        }
    }

    /// The variance of each equation at θ; whether they stand.
    fn weigh(&mut self, rows: &[Sums]) -> bool {
        let mut settled = true;
        for (variance, row) in self.variances.iter_mut().zip(rows) {
            let sum = of_residuals(&row.products, &row.columns, &self.theta);
            let now = (sum / row.weight).max(f64::MIN_POSITIVE);
            settled &= (now - *variance).abs() <= SETTLED * now;
            *variance = if now.is_finite() { now } else { 1.0 };
        }
        settled
    }

    /// M⁻¹, scaled back.
    fn invert(&mut self) {
        let n = self.columns;
        for column in 0..n {
            let to = &mut self.inverse[column * n..(column + 1) * n];
            to.fill(0.0);
            to[column] = self.scale[column];
            solve_factored(&self.matrix, n, to);
            to.iter_mut()
                .zip(&self.scale)
                .for_each(|(value, scale)| *value *= scale);
        }
    }

    /// What stands between M⁻¹ and M⁻¹.
    fn accumulate(&mut self, rows: &[Sums]) {
        self.middle.fill(0.0);
        for (row, variance) in rows.iter().zip(&self.variances) {
            let width = row.width();
            let mut add = |products: &[f64], factor: f64| {
                for (i, &a) in row.columns.iter().enumerate() {
                    for (j, &b) in row.columns.iter().enumerate() {
                        self.middle[a * self.columns + b] += factor * products[i * width + j];
                        self.middle[b * self.columns + a] += factor * products[i * width + j];
                    }
                }
            };
            if row.lagged.is_empty() {
                add(&row.products, 0.5 / variance);
            }
            for (lag, products) in row.lagged.iter().enumerate() {
                let covariance = of_residuals(products, &row.columns, &self.theta) / row.squares;
                let taper = 1.0 - lag as f64 / row.lagged.len() as f64;
                let taper = if lag == 0 { 0.5 } else { taper };
                add(products, taper * covariance / (variance * variance));
            }
        }
    }

    fn bound(&mut self, rows: &[Sums]) {
        let n = self.columns;
        for (to, left) in self
            .product
            .chunks_exact_mut(n)
            .zip(self.inverse.chunks_exact(n))
        {
            to.fill(0.0);
            for (value, middle) in left.iter().zip(self.middle.chunks_exact(n)) {
                to.iter_mut()
                    .zip(middle)
                    .for_each(|(to, m)| *to += value * m);
            }
        }
        let numbers: f64 = rows.iter().map(Sums::numbers).sum();
        let used = self.scale.iter().filter(|scale| **scale > 0.0).count() as f64;
        // what the unknowns have absorbed of the noise
        let absorbed = numbers / (numbers - used);
        for place in 0..self.estimates.len() {
            let column = self.nuisances + place;
            let row = column * n..(column + 1) * n;
            let both = self.product[row.clone()].iter().zip(&self.inverse[row]);
            let variance: f64 = both.map(|(a, b)| a * b).sum();
            let known = !self.undetermined[column] && numbers > used && variance >= 0.0;
            let (value, error) = match known {
                true => (self.theta[column], (absorbed * variance).sqrt()),
                false => (f64::NAN, f64::NAN),
            };
            self.estimates[place] = value;
            self.standard_errors[place] = error;
        }
    }
}

/// L Lᵀ x = b in place, L below and on the diagonal.
fn solve_factored(factor: &[f64], n: usize, x: &mut [f64]) {
    for i in 0..n {
        let row = &factor[i * n..i * n + i];
        let sum: f64 = row.iter().zip(&*x).map(|(l, x)| l * x).sum();
        x[i] = (x[i] - sum) / factor[i * n + i];
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|k| factor[k * n + i] * x[k]).sum();
        x[i] = (x[i] - sum) / factor[i * n + i];
    }
}
