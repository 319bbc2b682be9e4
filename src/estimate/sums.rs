//! Sums over the data that a step is made of, by output and unweighted: R is known only when all residuals are.

use nalgebra::{DMatrix, DVector};

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
