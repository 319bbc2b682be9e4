//! Knowledge from before the data: normal priors of some unknowns, p(θ) ∝ exp(-½ Σ ((θ - m)/s)²).
//!
//! The estimate is then the θ of greatest posterior density. Each prior is one more measured value, of the
//! unknown itself: it adds to the cost, the gradient and the information matrix.

use nalgebra::{DMatrix, DVector};

use crate::estimate::problem::unknowns::Unknowns;
use crate::model::Prior;

/// Priors by place of θ, SI.
pub(crate) fn places(unknowns: &Unknowns) -> impl Iterator<Item = (usize, Prior)> + '_ {
    (0..unknowns.len()).filter_map(|place| Some((place, unknowns.at(place).prior?)))
}

/// ½ Σ ((θ - m)/s)²
pub(crate) fn cost(unknowns: &Unknowns, theta: &[f64]) -> f64 {
    let distance = |(place, prior): (usize, Prior)| (theta[place] - prior.mean) / prior.sd;
    0.5 * places(unknowns).map(|at| distance(at).powi(2)).sum::<f64>()
}

/// Adds what the priors say to the information matrix and the descent direction.
pub(crate) fn add(
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
pub(crate) fn add_gradient(unknowns: &Unknowns, theta: &[f64], gradient: &mut DVector<f64>) {
    for (place, prior) in places(unknowns) {
        gradient[place] += (theta[place] - prior.mean) / prior.sd.powi(2);
    }
}

/// Adds what the priors know to an information matrix.
pub(crate) fn add_information(unknowns: &Unknowns, information: &mut DMatrix<f64>) {
    for (place, prior) in places(unknowns) {
        information[(place, place)] += prior.sd.powi(-2);
    }
}
