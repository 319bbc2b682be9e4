//! What a fit takes off the autocovariances of its residuals.
//!
//! Residuals are ê_k = e_k − S_k δ, with noise e and the error δ of the estimate, Cov its covariance. E e_k δᵀ is
//! S_k Cov: exactly for white noise, nearly where sensitivities are smooth against the noise's correlation. So
//! E ê_k ê_(k+l)ᵀ = Γ(l) − S_k Cov S_(k+l)ᵀ: to be unbiased, autocovariances need the last term added, summed over k.

use nalgebra::{DMatrix, DVector, DVectorView};

use super::autoregression::most_lags;
use super::evaluation::{Evaluator, Unusable};

/// Σ_k S_k Cov S_(k+l)ᵀ at θ, by output, then lag, over all segments; `covariance` is that of θ. Missing samples do
/// not count.
pub(super) fn absorbed(
    evaluator: &mut Evaluator<'_>,
    theta: &[f64],
    covariance: &DMatrix<f64>,
) -> Result<Vec<Vec<f64>>, Unusable> {
    let problem = evaluator.problem();
    let lags = problem.counts.iter().map(|&count| most_lags(count));
    let mut sums: Vec<Vec<f64>> = lags.map(|most| vec![0.0; most + 1]).collect();
    evaluator.evaluations += 1;
    for (index, segment) in problem.segments.iter().enumerate() {
        let own = |output: usize| {
            let parameters = problem.columns.of_output(output);
            let place = |a: usize| problem.unknowns.place(index, parameters[a]);
            let width = parameters.len();
            DMatrix::from_fn(width, width, |a, b| match (place(a), place(b)) {
                (Some(a), Some(b)) => covariance[(a, b)],
                _ => 0.0,
            })
        };
        let mut outputs: Vec<LaggedSquares<'_>> = (sums.iter_mut().enumerate())
            .map(|(output, sums)| LaggedSquares::new(own(output), sums))
            .collect();
        evaluator.sweep(theta, index, |block| {
            for (i, output) in outputs.iter_mut().enumerate() {
                for k in 0..block.len {
                    let sample = block.first + k;
                    let is_there = segment.measured[i][sample].is_finite();
                    output.add(sample, is_there.then(|| block.row(i, k)));
                }
            }
        })?;
    }
    Ok(sums)
}

/// Sums up s_k Cov s_(k+l)ᵀ for one output along one segment, in a memory of as many rows as there are lags.
struct LaggedSquares<'s> {
    /// Of what the columns of s belong to.
    covariance: DMatrix<f64>,
    /// Cov s_kᵀ at column k modulo the number of lags; zero where there is none.
    recent: DMatrix<f64>,
    products: DVector<f64>,
    /// By lag.
    sums: &'s mut [f64],
}

impl<'s> LaggedSquares<'s> {
    fn new(covariance: DMatrix<f64>, sums: &'s mut [f64]) -> Self {
        Self {
            recent: DMatrix::zeros(covariance.nrows(), sums.len()),
            products: DVector::zeros(sums.len()),
            covariance,
            sums,
        }
    }

    /// The row of sample `k`, the one after the last; `None` where it is missing.
    fn add(&mut self, k: usize, row: Option<&[f64]>) {
        let lags = self.sums.len();
        let mut latest = self.recent.column_mut(k % lags);
        let Some(row) = row else {
            latest.fill(0.0);
            return;
        };
        let row = DVectorView::from_slice(row, row.len());
        latest.gemv(1.0, &self.covariance, &row, 0.0);
        self.products.gemv_tr(1.0, &self.recent, &row, 0.0);
        for (lag, sum) in self.sums.iter_mut().enumerate() {
            *sum += self.products[(k + lags - lag) % lags];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the double sum; numbers are small integers and their sums exact.
    #[test]
    fn lagged_squares_are_those_of_the_definition() {
        let covariance = DMatrix::from_row_slice(2, 2, &[2.0, -1.0, -1.0, 3.0]);
        let row = |k: usize| [(k % 5) as f64 - 2.0, (k * k % 7) as f64];
        let is_there = |k: usize| k % 4 != 3;
        let mut sums = [0.0; 6];
        let mut squares = LaggedSquares::new(covariance.clone(), &mut sums);
        (0..50).for_each(|k| squares.add(k, is_there(k).then_some(&row(k)[..])));
        for (lag, sum) in sums.into_iter().enumerate() {
            let pairs = (0..50 - lag).filter(|&k| is_there(k) && is_there(k + lag));
            let product = |k: usize| {
                let (a, b) = (DVector::from_row_slice(&row(k)), row(k + lag));
                a.dot(&(&covariance * DVector::from_row_slice(&b)))
            };
            assert_eq!(sum, pairs.map(product).sum::<f64>(), "lag {lag}");
        }
    }
}
