//! How much of an error bound stems from what was known before the data.

use nalgebra::DMatrix;

use crate::estimate::likelihood::priors::places;
use crate::estimate::linear::spectrum::Spectrum;
use crate::estimate::problem::unknowns::Unknowns;
use crate::estimate::report::parameter::Bound;

/// By place of θ: the share of the squared error bound that stems from the priors. With F = F_data + P the
/// covariance is F⁻¹ = F⁻¹ F_data F⁻¹ + F⁻¹ P F⁻¹; the last term over the whole is the share. None where there
/// is no prior at all, and for unknowns that are held at a bound.
///
/// Unknowns of the method's own, which have no prior, may follow those of θ in `information` and `held`.
pub(crate) fn shares(
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
    let of_theta = || {
        let places = moving.iter().copied().enumerate();
        places.filter(|&(_, place)| place < unknowns.len())
    };
    for (i, place) in of_theta() {
        let from_prior = |(k, place): (usize, usize)| {
            let prior = unknowns.at(place).prior?;
            Some((covariance[(i, k)] / prior.sd).powi(2))
        };
        let prior: f64 = of_theta().filter_map(from_prior).sum();
        shares[place] = Some(prior / covariance[(i, i)]).filter(|share| share.is_finite());
    }
    shares
}
