//! The negative log-likelihood, its gradient and its Hessian, from sums over the data.
//!
//! Where R is estimated it is the R of greatest likelihood for each θ (relaxation), and the cost is the
//! likelihood concentrated in R: J(θ) = (N/2) ln|R(θ)| + const; where outputs have values at N_i samples each,
//! r_i = Σ e_i²/N_i and J = Σ (N_i/2) ln r_i + const. Its Hessian is the information matrix less
//! a term for the change of R with θ; with that term the step converges faster than R merely held fixed.

use std::f64::consts::{SQRT_2, TAU};

use nalgebra::{DMatrix, DVector};

use super::priors;
use super::sums::{ResidualSums, Sums, pair};
use crate::estimate::options::{Noise, NoiseStructure};
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;

/// R and what follows from it.
#[derive(Clone, Debug)]
pub(crate) struct Weighting {
    pub covariance: DMatrix<f64>,
    pub inverse: DMatrix<f64>,
    diagonal: bool,
    pub ln_det: f64,
    /// -ln L, and what the priors add to it.
    pub cost: f64,
}

/// The least variance, SI units squared: a perfect fit would have an infinite likelihood.
const SMALLEST_VARIANCE: f64 = 1e-280;

/// A pivot of the residuals' correlation matrix below this is rounding: the outputs are not independent.
const SMALLEST_PIVOT: f64 = 1e-10;

impl Weighting {
    /// From the residuals' sums at θ.
    ///
    /// # Errors
    /// R is singular, or the cost is not finite.
    pub(crate) fn at(
        problem: &Problem,
        theta: &[f64],
        residuals: &ResidualSums,
    ) -> Result<Self, Unusable> {
        let mut weighting = Self::new(&problem.options.noise, residuals, &problem.counts)?;
        weighting.cost += priors::cost(&problem.unknowns, theta);
        if weighting.cost.is_finite() {
            Ok(weighting)
        } else {
            Err(Unusable::NotFinite)
        }
    }

    /// `counts` are the samples of each output. Where R is full they are all the same: a sample then has values
    /// of all outputs, or does not count.
    pub(crate) fn new(
        noise: &Noise,
        residuals: &ResidualSums,
        counts: &[usize],
    ) -> Result<Self, Unusable> {
        let n = DVector::from_iterator(counts.len(), counts.iter().map(|&n| n as f64));
        let (covariance, inverse, ln_det) = match noise {
            Noise::Given { variance } => independent(DVector::from_column_slice(variance)),
            Noise::Estimated {
                structure: NoiseStructure::Diagonal,
            } => independent(
                residuals
                    .diagonal()
                    .zip_map(&n, |sum, n| (sum / n).max(SMALLEST_VARIANCE)),
            ),
            Noise::Estimated {
                structure: NoiseStructure::Full,
            } => correlated(residuals / n[0])?,
        };
        let quadratic = inverse.component_mul(residuals).sum();
        let normalisation = match noise {
            Noise::Estimated {
                structure: NoiseStructure::Full,
            } => n[0] * ln_det,
            _ => n.dot(&covariance.diagonal().map(f64::ln)),
        };
        Ok(Self {
            covariance,
            inverse,
            diagonal: !noise.is_full(),
            ln_det,
            cost: 0.5 * (quadratic + normalisation + n.sum() * TAU.ln()),
        })
    }

    pub(crate) fn det(&self) -> f64 {
        self.ln_det.exp()
    }

    /// R⁻¹ e
    pub(crate) fn weighted(&self, residual: &[f64], to: &mut [f64]) {
        if self.diagonal {
            for (i, (to, e)) in to.iter_mut().zip(residual).enumerate() {
                *to = self.inverse[(i, i)] * e;
            }
            return;
        }
        for (to, row) in to.iter_mut().zip(self.inverse.row_iter()) {
            *to = row.iter().zip(residual).map(|(r, e)| r * e).sum();
        }
    }

    /// The information matrix F = Σ Sᵀ R⁻¹ S.
    pub(crate) fn information(&self, sums: &Sums) -> DMatrix<f64> {
        sums.weighted(&self.inverse)
    }

    /// The descent direction -∂J/∂θ = Σ Sᵀ R⁻¹ e.
    pub(crate) fn descent(&self, sums: &Sums) -> DVector<f64> {
        let mut descent = DVector::zeros(sums.gradients[0][0].len());
        for (i, gradients) in sums.gradients.iter().enumerate() {
            if let [own] = gradients.as_slice() {
                descent += own * self.inverse[(i, i)];
            } else {
                for (j, gradient) in gradients.iter().enumerate() {
                    descent += gradient * self.inverse[(i, j)];
                }
            }
        }
        descent
    }

    /// The change of R with θ takes U Uᵀ off the information matrix: U, unknowns by a few columns:
    /// (N/2) tr(R⁻¹ ∂R/∂θ_a R⁻¹ ∂R/∂θ_b), with ∂R/∂θ_a = -(1/N) Σ (S_a eᵀ + e S_aᵀ); output by output, with
    /// its own N, where R is diagonal. With R = L Lᵀ the trace is a scalar product of L⁻¹ ∂R/∂θ L⁻ᵀ.
    ///
    /// # Errors
    /// R is singular.
    pub(crate) fn relaxation(
        &self,
        sums: &Sums,
        counts: &[usize],
    ) -> Result<DMatrix<f64>, Unusable> {
        let unknowns = sums.gradients[0][0].len();
        let outputs = self.inverse.nrows();
        if self.diagonal {
            let column = |i: usize| {
                let share = (2.0 / counts[i] as f64).sqrt() * self.inverse[(i, i)];
                &sums.gradients[i][0] * share
            };
            let columns: Vec<DVector<f64>> = (0..outputs).map(column).collect();
            return Ok(DMatrix::from_columns(&columns));
        }
        let factor = self.covariance.clone().cholesky();
        let inverse =
            (factor.and_then(|factor| factor.l().try_inverse())).ok_or(Unusable::SingularNoise)?;
        let share = (0.5 / counts[0] as f64).sqrt();
        let mut columns = DMatrix::zeros(unknowns, outputs * (outputs + 1) / 2);
        for a in 0..unknowns {
            let moment = DMatrix::from_fn(outputs, outputs, |i, j| sums.gradients[i][j][a]);
            let change = &inverse * (&moment + moment.transpose()) * inverse.transpose();
            for i in 0..outputs {
                for j in 0..=i {
                    // one for both of the triangles
                    let both = if i == j { 1.0 } else { SQRT_2 };
                    columns[(a, pair(i, j, true))] = both * share * change[(i, j)];
                }
            }
        }
        Ok(columns)
    }
}

type Factored = (DMatrix<f64>, DMatrix<f64>, f64);

/// R, R⁻¹ and ln|R| of outputs whose noises are independent.
fn independent(variance: DVector<f64>) -> Factored {
    let inverse = DMatrix::from_diagonal(&variance.map(f64::recip));
    let ln_det = variance.map(f64::ln).sum();
    (DMatrix::from_diagonal(&variance), inverse, ln_det)
}

/// R, R⁻¹ and ln|R| of correlated outputs, by way of the correlation matrix: units must not decide what is singular.
fn correlated(covariance: DMatrix<f64>) -> Result<Factored, Unusable> {
    if covariance.iter().any(|v| !v.is_finite()) {
        return Err(Unusable::NotFinite);
    }
    let deviation = covariance.diagonal().map(f64::sqrt);
    let scale = DMatrix::from_diagonal(&deviation.map(f64::recip));
    let factor = (&scale * &covariance * &scale)
        .cholesky()
        .ok_or(Unusable::SingularNoise)?;
    let pivots = factor.l_dirty().diagonal();
    if pivots.iter().any(|pivot| pivot * pivot < SMALLEST_PIVOT) {
        return Err(Unusable::SingularNoise);
    }
    let ln_det = 2.0 * (pivots.map(f64::ln).sum() + deviation.map(f64::ln).sum());
    Ok((covariance, &scale * factor.inverse() * &scale, ln_det))
}
