//! The negative log-likelihood, its gradient and its Hessian, from sums over the data.
//!
//! Where R is estimated it is the R of greatest likelihood for each θ (relaxation), and the cost is the
//! likelihood concentrated in R: J(θ) = (N/2) ln|R(θ)| + const; where outputs have values at N_i samples each,
//! r_i = Σ e_i²/N_i and J = Σ (N_i/2) ln r_i + const. Its Hessian is the information matrix less
//! a term for the change of R with θ; with that term the step converges faster than R merely held fixed.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::evaluation::{Evaluator, Unusable};
use super::options::{Noise, NoiseStructure};
use super::priors;
use super::problem::Problem;
use super::sums::{ResidualSums, Sums, pair};

/// All that an iteration needs to know at a θ, but for the small solve.
#[derive(Clone, Debug)]
pub struct NormalEquations {
    pub(super) weighting: Weighting,
    /// The information matrix F.
    pub information: DMatrix<f64>,
    /// -∂J/∂θ
    pub descent: DVector<f64>,
    /// What the change of R with θ takes off the information matrix; where R is estimated.
    pub(super) relaxation: Option<DMatrix<f64>>,
}

impl NormalEquations {
    /// Simulates with sensitivities and sums up. θ holds the free unknowns, SI.
    ///
    /// # Errors
    /// The simulation leaves the range of numbers.
    pub fn at(evaluator: &mut Evaluator<'_>, theta: &[f64]) -> Result<Self, Unusable> {
        let sums = evaluator.sums(theta)?;
        let problem = evaluator.problem();
        let noise = &problem.options.noise;
        let weighting = Weighting::at(problem, theta, &sums.residuals)?;
        let mut information = weighting.information(&sums);
        let mut descent = weighting.descent(&sums);
        priors::add(&problem.unknowns, theta, &mut information, &mut descent);
        Ok(Self {
            information,
            descent,
            relaxation: match noise {
                Noise::Estimated { .. } => Some(weighting.relaxation(&sums, &problem.counts)),
                Noise::Given { .. } => None,
            },
            weighting,
        })
    }

    pub fn det_r(&self) -> f64 {
        self.weighting.det()
    }

    /// J: -ln L, and what the priors add to it.
    pub fn cost(&self) -> f64 {
        self.weighting.cost
    }
}

/// R and what follows from it.
#[derive(Clone, Debug)]
pub(super) struct Weighting {
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
    pub fn at(
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
    pub fn new(
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

    pub fn det(&self) -> f64 {
        self.ln_det.exp()
    }

    /// R⁻¹ e
    pub fn weighted(&self, residual: &[f64], to: &mut [f64]) {
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
    pub fn information(&self, sums: &Sums) -> DMatrix<f64> {
        let full = sums.gradients[0].len() > 1;
        let unknowns = sums.products[0].nrows();
        let mut information = DMatrix::zeros(unknowns, unknowns);
        for i in 0..self.inverse.nrows() {
            for j in if full { 0..i } else { i..i } {
                let product = &sums.products[pair(i, j, full)];
                information += (product + product.transpose()) * self.inverse[(i, j)];
            }
            // in place: with many unknowns these matrices are large
            let weight = self.inverse[(i, i)];
            let own = &sums.products[pair(i, i, full)];
            information.zip_apply(own, |sum, product| *sum += product * weight);
        }
        information
    }

    /// The descent direction -∂J/∂θ = Σ Sᵀ R⁻¹ e.
    pub fn descent(&self, sums: &Sums) -> DVector<f64> {
        let mut descent = DVector::zeros(sums.products[0].nrows());
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

    /// What the change of R with θ takes off the information matrix:
    /// (N/2) tr(R⁻¹ ∂R/∂θ_a R⁻¹ ∂R/∂θ_b), with ∂R/∂θ_a = -(1/N) Σ (S_a eᵀ + e S_aᵀ); output by output, with
    /// its own N, where R is diagonal.
    pub fn relaxation(&self, sums: &Sums, counts: &[usize]) -> DMatrix<f64> {
        let unknowns = sums.products[0].nrows();
        let outputs = self.inverse.nrows();
        let mut term = DMatrix::zeros(unknowns, unknowns);
        if sums.gradients[0].len() == 1 {
            for (i, gradients) in sums.gradients.iter().enumerate() {
                let scaled = &gradients[0] * self.inverse[(i, i)];
                term.ger(2.0 / counts[i] as f64, &scaled, &scaled, 1.0);
            }
            return term;
        }
        let n = counts[0] as f64;
        let change = |a: usize| {
            let moment = DMatrix::from_fn(outputs, outputs, |i, j| sums.gradients[i][j][a]);
            &self.inverse * (&moment + moment.transpose())
        };
        let changes: Vec<DMatrix<f64>> = (0..unknowns).map(change).collect();
        for a in 0..unknowns {
            for b in 0..=a {
                let trace = changes[a].component_mul(&changes[b].transpose()).sum();
                term[(a, b)] = 0.5 * trace / n;
                term[(b, a)] = term[(a, b)];
            }
        }
        term
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
