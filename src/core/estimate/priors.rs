//! What was known before the data: normal priors of some unknowns, p(θ) ∝ exp(-½ Σ ((θ - m)/s)²).
//!
//! The estimate is then the θ of greatest posterior density. Each prior is one more measured value, of the
//! unknown itself: it adds to the cost, the gradient and the information matrix.

use nalgebra::{DMatrix, DVector};

use super::information::Spectrum;
use super::report::Bound;
use super::unknowns::Unknowns;
use crate::model::Prior;

/// Priors by place of θ, SI.
fn places(unknowns: &Unknowns) -> impl Iterator<Item = (usize, Prior)> + '_ {
    (0..unknowns.len()).filter_map(|place| Some((place, unknowns.at(place).prior?)))
}

/// ½ Σ ((θ - m)/s)²
pub(super) fn cost(unknowns: &Unknowns, theta: &[f64]) -> f64 {
    let distance = |(place, prior): (usize, Prior)| (theta[place] - prior.mean) / prior.sd;
    0.5 * places(unknowns).map(|at| distance(at).powi(2)).sum::<f64>()
}

/// Adds what the priors say to the information matrix and the descent direction.
pub(super) fn add(
    unknowns: &Unknowns,
    theta: &[f64],
    information: &mut DMatrix<f64>,
    descent: &mut DVector<f64>,
) {
    add_information(unknowns, information);
    let mut gradient = DVector::zeros(descent.len());
    add_gradient(unknowns, theta, &mut gradient);
    *descent -= gradient;
}

/// Adds ∂/∂θ of the priors' part of the cost.
pub(super) fn add_gradient(unknowns: &Unknowns, theta: &[f64], gradient: &mut DVector<f64>) {
    for (place, prior) in places(unknowns) {
        gradient[place] += (theta[place] - prior.mean) / prior.sd.powi(2);
    }
}

/// Adds what the priors know to an information matrix.
pub(super) fn add_information(unknowns: &Unknowns, information: &mut DMatrix<f64>) {
    for (place, prior) in places(unknowns) {
        information[(place, place)] += prior.sd.powi(-2);
    }
}

/// By place of θ: the share of the squared error bound that stems from the priors. With F = F_data + P the
/// covariance is F⁻¹ = F⁻¹ F_data F⁻¹ + F⁻¹ P F⁻¹; the last term over the whole is the share. None where there
/// is no prior at all, and for what is held at a bound.
pub(super) fn shares(
    unknowns: &Unknowns,
    information: &DMatrix<f64>,
    held: &[Option<Bound>],
) -> Vec<Option<f64>> {
    let mut shares = vec![None; unknowns.len()];
    if places(unknowns).next().is_none() {
        return shares;
    }
    let moving: Vec<usize> = (0..held.len()).filter(|&i| held[i].is_none()).collect();
    let own = information.select_rows(&moving).select_columns(&moving);
    let Some(spectrum) = Spectrum::of(&own, &own.diagonal()) else {
        return shares;
    };
    let covariance = spectrum.inverse();
    for (i, &place) in moving.iter().enumerate() {
        let from_prior = |(k, &place): (usize, &usize)| {
            let prior = unknowns.at(place).prior?;
            Some((covariance[(i, k)] / prior.sd).powi(2))
        };
        let prior: f64 = moving.iter().enumerate().filter_map(from_prior).sum();
        shares[place] = Some(prior / covariance[(i, i)]).filter(|share| share.is_finite());
    }
    shares
}
