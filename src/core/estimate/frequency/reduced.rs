//! What is known of the parameters alone: ends and trends are estimated along with them, and taken out of the information.
//!
//! With F in blocks of the parameters (p) and the others (e), the information on the parameters is F_pp - F_pe F_ee⁻¹ F_ep. Its
//! inverse is their block of F⁻¹.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::columns::Columns;
use super::evaluator::FrequencyEvaluator;
use super::power::Power;
use super::transformed::Transformed;
use crate::estimate::accuracy::error_bounds::ErrorBounds;
use crate::estimate::descent::iterate::Iterate;
use crate::estimate::likelihood::priors;
use crate::estimate::linear::spectrum::Spectrum;
use crate::estimate::options::Noise;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::parameter::Bound;
use crate::stop;

/// A share of the information that is rounding.
const ROUNDING: f64 = 1e-12;

/// What takes the others out: information and gradients of all, to those of the parameters alone.
struct Reduction {
    /// Parameters by unknowns: [1, -F_pe F_ee⁻¹].
    matrix: DMatrix<f64>,
}

impl Reduction {
    /// `None` where the information matrix cannot be decomposed.
    fn of(information: &DMatrix<f64>, parameters: usize) -> Option<Self> {
        let others = information.nrows() - parameters;
        let mut matrix = DMatrix::identity(parameters, parameters + others);
        if others > 0 {
            let own = information.view((parameters, parameters), (others, others));
            let own = own.into_owned();
            let spectrum = Spectrum::of(&own, &own.diagonal())?;
            let across = information.view((0, parameters), (parameters, others));
            let share = -(across * spectrum.inverse());
            matrix.columns_mut(parameters, others).copy_from(&share);
        }
        Some(Self { matrix })
    }

    /// The information on the parameters: none on those of which the others take all of it, but for rounding.
    fn information(&self, of_all: &DMatrix<f64>) -> DMatrix<f64> {
        let mut reduced = self.apply(of_all);
        for i in 0..reduced.nrows() {
            if reduced[(i, i)] <= ROUNDING * of_all[(i, i)] {
                reduced.row_mut(i).fill(0.0);
                reduced.column_mut(i).fill(0.0);
            }
        }
        reduced
    }

    /// M F Mᵀ, of an information matrix or the covariance of a gradient.
    fn apply(&self, of_all: &DMatrix<f64>) -> DMatrix<f64> {
        let reduced = &self.matrix * of_all * self.matrix.transpose();
        (&reduced + reduced.transpose()) * 0.5
    }
}

/// How much larger the power of noise is than that of the residuals that it left to a fit: N/(N - p) for p unknowns, those of
/// ends and trends with them, of N numbers. A band has few numbers, so that this shows.
fn absorbed(problem: &Problem) -> f64 {
    let values: usize = problem.counts.iter().sum();
    let left = values.saturating_sub(problem.unknowns.len()).max(1);
    values as f64 / left as f64
}

/// A larger leverage is taken for this: what it leaves of a residual is next to nothing.
const MOST_LEVERAGE: f64 = 0.9;

/// Of a residual of the variance `variance`, real and imaginary part each: which share of its square the fit absorbs, the diagonal
/// of the hat matrix ½ Re(s F⁻¹ sᴴ)/R. It differs much over a band: most of it is where the motion is.
fn leverage(row: &[Complex64], inverse: &DMatrix<f64>, variance: f64) -> f64 {
    let square = |part: fn(&Complex64) -> f64| {
        let part = DVector::from_iterator(row.len(), row.iter().map(part));
        part.dot(&(inverse * &part))
    };
    let leverage = 0.5 * (square(|s| s.re) + square(|s| s.im)) / variance;
    // an output that is reproduced exactly has no variance
    if leverage.is_finite() {
        leverage.clamp(0.0, MOST_LEVERAGE)
    } else {
        0.0
    }
}

/// How much the gradient scatters where the power of the noise differs from frequency to frequency:
/// Σ_k ½ Re(S_kᴴ R⁻¹ E_k R⁻¹ S_k), E_k the power of residuals, each over √(1 - h) of its leverage h, averaged over the frequencies
/// next to k. Real and imaginary parts of noise have the same power, and different frequencies are independent.
fn gradient_covariance(
    evaluator: &mut FrequencyEvaluator<'_>,
    at: &Iterate,
) -> Result<DMatrix<f64>, Unusable> {
    let transformed = evaluator.transformed();
    let problem = &transformed.problem;
    let (outputs, unknowns) = (problem.model.outputs.len(), at.theta.len());
    let mut covariance = DMatrix::zeros(unknowns, unknowns);
    let inverse = Spectrum::of(&at.information, &at.information.diagonal());
    let inverse = inverse.map_or_else(|| DMatrix::zeros(unknowns, unknowns), |all| all.inverse());
    for segment in 0..problem.segments.len() {
        let columns = Columns::of(problem, segment);
        let width = columns.places.len();
        // residuals are scaled by the root of the share by which their frequency counts
        let spectra = &transformed.spectra[segment];
        let close = spectra.independent as f64 / spectra.omega.len().max(1) as f64;
        let own = DMatrix::from_fn(width, width, |a, b| {
            inverse[(columns.places[a], columns.places[b])]
        });
        let (mut residuals, mut rows) = (Vec::new(), Vec::new());
        evaluator.sweep(segment, &at.theta, Some(&columns), |look| {
            let whole = |(i, e): (usize, &Complex64)| {
                let row = &look.rows[i * width..(i + 1) * width];
                let variance = at.weighting.covariance[(i, i)] * close;
                e / (1.0 - leverage(row, &own, variance)).sqrt()
            };
            residuals.push(look.residuals.iter().enumerate().map(whole).collect());
            rows.push(look.rows.to_vec());
        })?;
        let weight = at.weighting.inverse.map(Complex64::from);
        // closer than independent frequencies, as many of them as are between two of those
        let power = Power::of(&spectra.omega, &residuals, close);
        let whole = Complex64::from(close.recip());
        for (power, rows) in power.each().zip(&rows) {
            stop::check();
            let power = &weight * (power * whole) * &weight;
            let rows = DMatrix::from_row_slice(outputs, width, rows);
            let own = (rows.adjoint() * power * &rows).map(|entry| 0.5 * entry.re);
            for (a, &row) in columns.places.iter().enumerate() {
                for (b, &column) in columns.places.iter().enumerate() {
                    covariance[(row, column)] += own[(a, b)];
                }
            }
        }
    }
    Ok(covariance)
}

/// The accuracy of the parameters alone, and the information on them.
pub(super) struct Known {
    pub information: DMatrix<f64>,
    pub bounds: ErrorBounds,
}

impl Known {
    /// Where the information matrix cannot be decomposed.
    pub(super) fn nothing(parameters: usize, held: &[Option<Bound>]) -> Self {
        let information = DMatrix::zeros(parameters, parameters);
        Self {
            bounds: ErrorBounds::conventional(&information, &held[..parameters]),
            information,
        }
    }
}

/// The information on the parameters alone.
pub(super) fn information(of_all: &DMatrix<f64>, parameters: usize) -> Option<DMatrix<f64>> {
    Some(Reduction::of(of_all, parameters)?.information(of_all))
}

/// At an iterate, corrected where that is asked for.
pub(super) fn known(
    evaluator: &mut FrequencyEvaluator<'_>,
    at: &Iterate,
    corrected: bool,
) -> Option<Known> {
    let transformed: &Transformed = evaluator.transformed();
    let (problem, parameters) = (&transformed.problem, transformed.shared());
    // of noise that was estimated there is more; one that was given says what there is
    let share = match problem.options.noise {
        Noise::Given { .. } => 1.0,
        Noise::Estimated { .. } => absorbed(problem),
    };
    let mut before = DMatrix::zeros(at.theta.len(), at.theta.len());
    priors::add_information(&problem.unknowns, &mut before);
    let whole = (&at.information - &before) / share + &before;
    let reduction = Reduction::of(&whole, parameters)?;
    let information = reduction.information(&whole);
    let mut bounds = ErrorBounds::conventional(&information, &at.held[..parameters]);
    if corrected && let Ok(scatter) = gradient_covariance(evaluator, at) {
        let scatter = scatter / share.powi(2) + before;
        bounds.correct_with(&reduction.apply(&scatter));
    }
    Some(Known {
        information,
        bounds,
    })
}
