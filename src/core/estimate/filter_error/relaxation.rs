//! R in the gain follows the innovations.

use nalgebra::DMatrix;

use super::evaluation::FilterEvaluator;
use super::iterate::{GainNoise, Iterate};
use super::limit::restore;
use super::search::Trial;
use crate::estimate::options::Noise;
use crate::estimate::problem::unusable::Unusable;

/// Shares of the way that R is taken, the largest first; less where it leads out of the range of numbers.
const SHARES: [f64; 3] = [1.0, 0.5, 0.25];

/// The iterate behind a step: R in the gain is that of the step's innovations, and F is corrected for it.
///
/// # Errors
/// No R on the way gives predictions in the range of numbers.
pub(super) fn relaxed(
    evaluator: &mut FilterEvaluator<'_>,
    before: &Iterate,
    lower: Trial,
) -> Result<Iterate, Unusable> {
    if let Noise::Given { .. } = evaluator.problem.options.noise {
        return Iterate::at(evaluator, lower.xi, before.gain_noise.clone());
    }
    let mut why = Unusable::NotFinite;
    for share in SHARES {
        let mean = |a: &DMatrix<f64>, b: &DMatrix<f64>| a * (1.0 - share) + b * share;
        let covariance = mean(&before.gain_noise.covariance, &lower.weighting.covariance);
        let Some(inverse) = inverse(&covariance) else {
            continue;
        };
        let gain_noise = GainNoise {
            covariance,
            inverse,
        };
        let mut xi = corrected(evaluator, before, &gain_noise, &lower.xi)?;
        let next = restore(
            evaluator,
            &mut xi,
            &gain_noise.inverse,
            &before.limit.places,
        )
        .and_then(|()| Iterate::at(evaluator, xi, gain_noise));
        match next {
            Ok(next) => return Ok(next),
            Err(error) => why = error,
        }
    }
    Err(why)
}

/// Scaled to unit diagonal first: units must not decide about rounding.
fn inverse(covariance: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = covariance.diagonal().map(|v| v.sqrt().recip());
    let scale = DMatrix::from_diagonal(&scale);
    let inverse = (&scale * covariance * &scale).cholesky()?.inverse();
    Some(&scale * inverse * &scale)
}

/// The F-correction, which keeps the gain about what it was while R changes:
/// f_i ← f_i [Σ_j C_ji²/r_j √(r_j'/r_j)] / [Σ_j C_ji²/r_j] (Maine and Iliff 1981).
fn corrected(
    evaluator: &mut FilterEvaluator<'_>,
    before: &Iterate,
    after: &GainNoise,
    xi: &[f64],
) -> Result<Vec<f64>, Unusable> {
    let (old, new) = (
        before.gain_noise.covariance.diagonal(),
        after.covariance.diagonal(),
    );
    let free = evaluator.layout.free.clone();
    let mut sums = vec![(0.0, 0.0); free.len()];
    evaluator.gains(xi, &before.gain_noise.inverse, |gain| {
        for (&state, (changed, own)) in free.iter().zip(&mut sums) {
            for j in 0..old.len() {
                let information = gain.c[(j, state)].powi(2) / old[j];
                *changed += information * (new[j] / old[j]).sqrt();
                *own += information;
            }
        }
    })?;
    let mut xi = xi.to_vec();
    for (value, (changed, own)) in xi[evaluator.layout.parameters..].iter_mut().zip(sums) {
        if own > 0.0 {
            *value *= changed / own;
        }
    }
    for (place, value) in xi.iter_mut().enumerate() {
        let (lower, upper) = evaluator.layout.limits(evaluator.problem, place);
        *value = value.clamp(lower, upper);
    }
    Ok(xi)
}
