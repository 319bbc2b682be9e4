//! Sums over the data that a step is made of, by output and unweighted: R is known only when all residuals are.

use nalgebra::{DMatrix, DVector};

use super::evaluation::Unusable;

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

impl Sums {
    /// Nothing yet; `full` where all pairs of outputs count.
    pub fn zeros(outputs: usize, unknowns: usize, full: bool) -> Self {
        let pairs = if full {
            outputs * (outputs + 1) / 2
        } else {
            outputs
        };
        let columns = if full { outputs } else { 1 };
        Self {
            residuals: DMatrix::zeros(outputs, outputs),
            products: vec![DMatrix::zeros(unknowns, unknowns); pairs],
            gradients: vec![vec![DVector::zeros(unknowns); columns]; outputs],
        }
    }

    /// # Errors
    /// A residual or a derivative is not a finite number.
    pub fn finite(self) -> Result<Self, Unusable> {
        let mut products = self.products.iter().flat_map(|product| product.iter());
        if self.residuals.iter().all(|v| v.is_finite()) && products.all(|v| v.is_finite()) {
            Ok(self)
        } else {
            Err(Unusable::NotFinite)
        }
    }
}

/// Where the pair of outputs (i, j), j ≤ i, is kept.
pub(super) fn pair(i: usize, j: usize, full: bool) -> usize {
    if full { i * (i + 1) / 2 + j } else { i }
}

/// The upper triangle from the lower one.
pub(super) fn mirror(sums: &mut DMatrix<f64>) {
    for i in 0..sums.nrows() {
        for j in 0..i {
            sums[(j, i)] = sums[(i, j)];
        }
    }
}
