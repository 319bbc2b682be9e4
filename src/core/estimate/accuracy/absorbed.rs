//! The part of the noise that a fit absorbs: how much it takes off the autocovariances of its residuals.
//!
//! Residuals are ê_k = e_k − S_k δ, with noise e and the error δ of the estimate, Cov its covariance. E e_k δᵀ is
//! S_k Cov: exactly for white noise, nearly where sensitivities are smooth against the noise's correlation. So
//! E ê_k ê_(k+l)ᵀ = Γ(l) − S_k Cov S_(k+l)ᵀ: to be unbiased, autocovariances need the last term added, summed over k.

use multiversion::multiversion;
use nalgebra::DMatrix;

use super::autoregression::most_lags;
use crate::estimate::evaluation::evaluate::Evaluate;
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::linear::products::add_combination;
use crate::estimate::problem::unusable::Unusable;
use crate::simulate::{PACK, Pack, multiply_add, packs};

/// Σ_k S_k Cov S_(k+l)ᵀ at θ, by output, then lag, over all segments; `covariance` is that of θ. Missing samples do
/// not count.
pub(crate) fn absorbed(
    evaluator: &mut Evaluator<'_>,
    theta: &[f64],
    covariance: &DMatrix<f64>,
) -> Result<Vec<Vec<f64>>, Unusable> {
    let problem = evaluator.problem();
    let lags = || problem.counts.iter().map(|&count| most_lags(count) + 1);
    let mut sums: Vec<Vec<Pack>> = lags().map(zeros).collect();
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
            .map(|(output, sums)| LaggedSquares::new(&own(output), sums))
            .collect();
        evaluator.sweep(theta, index, |block| {
            for (i, output) in outputs.iter_mut().enumerate() {
                for k in 0..block.len {
                    let is_there = segment.measured[i][block.first + k].is_finite();
                    output.add(is_there.then(|| block.row(i, k)));
                }
            }
        })?;
    }
    let by_lag = |(sums, lags): (Vec<Pack>, usize)| sums.as_flattened()[..lags].to_vec();
    Ok(sums.into_iter().zip(lags()).map(by_lag).collect())
}

/// Whole packs for so many numbers.
fn zeros(count: usize) -> Vec<Pack> {
    vec![Pack::default(); packs(count)]
}

/// Samples that come before those remembered are moved.
const ROOM: usize = 256;

/// Sums up s_k Cov s_(k+l)ᵀ for one output along one segment, lags side by side.
struct LaggedSquares<'s> {
    /// Of what the columns of s belong to: row by row, in packs.
    covariance: Vec<Pack>,
    /// Cov s_kᵀ of the last samples, by column of s: what is `first` is of the latest one, behind it those before it.
    recent: Vec<f64>,
    first: usize,
    /// Cov s_kᵀ of the latest.
    latest: Vec<Pack>,
    /// By lag, in packs.
    sums: &'s mut [Pack],
}

impl<'s> LaggedSquares<'s> {
    fn new(covariance: &DMatrix<f64>, sums: &'s mut [Pack]) -> Self {
        let width = covariance.nrows();
        let mut rows = Vec::new();
        for row in covariance.row_iter() {
            let mut packs = zeros(width);
            for (to, value) in packs.as_flattened_mut().iter_mut().zip(row.iter()) {
                *to = *value;
            }
            rows.extend(packs);
        }
        Self {
            covariance: rows,
            recent: vec![0.0; width * (ROOM + sums.len() * PACK)],
            first: ROOM,
            latest: zeros(width),
            sums,
        }
    }

    /// The row of the sample after the last; `None` where it is missing.
    fn add(&mut self, row: Option<&[f64]>) {
        if self.first == 0 {
            let kept = self.sums.len() * PACK;
            for history in self.recent.chunks_exact_mut(ROOM + kept) {
                history.copy_within(..kept, ROOM);
            }
            self.first = ROOM;
        }
        self.first -= 1;
        self.latest.fill(Pack::default());
        if let Some(row) = row {
            add_combination(&mut self.latest, &self.covariance, row);
        }
        let stride = ROOM + self.sums.len() * PACK;
        let latest = self.latest.as_flattened();
        for (history, value) in self.recent.chunks_exact_mut(stride).zip(latest) {
            history[self.first] = *value;
        }
        if let Some(row) = row {
            add_lagged(self.sums, row, &self.recent, self.first);
        }
    }
}

/// sums_l += Σ_a factor_a recent_(a, first + l).
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn add_lagged(sums: &mut [Pack], factors: &[f64], recent: &[f64], first: usize) {
    let stride = ROOM + sums.len() * PACK;
    for (pack, to) in sums.iter_mut().enumerate() {
        let mut sum = *to;
        for (&factor, history) in factors.iter().zip(recent.chunks_exact(stride)) {
            let (values, _) = history[first + pack * PACK..].as_chunks();
            sum = multiply_add(factor, values[0], sum);
        }
        *to = sum;
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::*;

    /// Against the double sum; numbers are small integers and their sums exact.
    #[test]
    fn lagged_squares_are_those_of_the_definition() {
        let covariance = DMatrix::from_row_slice(2, 2, &[2.0, -1.0, -1.0, 3.0]);
        let row = |k: usize| [(k % 5) as f64 - 2.0, (k * k % 7) as f64];
        let is_there = |k: usize| k % 4 != 3;
        // more samples than are remembered without moving
        let samples = ROOM + 50;
        let mut sums = zeros(10);
        let mut squares = LaggedSquares::new(&covariance, &mut sums);
        (0..samples).for_each(|k| squares.add(is_there(k).then_some(&row(k)[..])));
        for (lag, &sum) in sums.as_flattened().iter().enumerate() {
            let pairs = (0..samples - lag).filter(|&k| is_there(k) && is_there(k + lag));
            let product = |k: usize| {
                let (a, b) = (DVector::from_row_slice(&row(k)), row(k + lag));
                a.dot(&(&covariance * DVector::from_row_slice(&b)))
            };
            assert_eq!(sum, pairs.map(product).sum::<f64>(), "lag {lag}");
        }
    }
}
