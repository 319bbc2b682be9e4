//! One step of the iteration: from gradient and Hessian to a change of θ that respects bounds.

use nalgebra::{DMatrix, DVector};

use super::information::Spectrum;
use super::report::Bound;
use super::unknowns::Unknowns;

/// Gradient and Hessian at an iterate, and what bounds leave of them.
pub(super) struct Newton {
    spectrum: Spectrum,
    /// Places of θ that are not held at a bound; the spectrum is over these.
    moving: Vec<usize>,
    descent: DVector<f64>,
    unknowns: usize,
}

impl Newton {
    /// `held` are the places held at a bound. The Hessian less `relaxation` is used where that is positive
    /// definite, else the information matrix alone.
    pub fn new(
        information: &DMatrix<f64>,
        relaxation: Option<&DMatrix<f64>>,
        descent: &DVector<f64>,
        held: &[Option<Bound>],
    ) -> Option<Self> {
        let moving: Vec<usize> = (0..held.len()).filter(|&i| held[i].is_none()).collect();
        let part = |m: &DMatrix<f64>| m.select_rows(&moving).select_columns(&moving);
        let own = part(information);
        let diagonal = own.diagonal();
        let spectrum = Spectrum::of(&own, &diagonal)?;
        let seen = |spectrum: &Spectrum| (0..moving.len()).filter(|&i| spectrum.is_seen(i)).count();
        let sharper = relaxation
            .and_then(|relaxation| Spectrum::of(&(&own - part(relaxation)), &diagonal))
            .filter(|sharper| seen(sharper) == seen(&spectrum));
        let descent = descent.select_rows(&moving);
        Some(Self {
            spectrum: sharper.unwrap_or(spectrum),
            moving,
            descent,
            unknowns: held.len(),
        })
    }

    /// The change of θ for a damping λ.
    pub fn step(&self, damping: f64) -> DVector<f64> {
        let step = self.spectrum.solve(&self.descent, damping);
        let mut whole = DVector::zeros(self.unknowns);
        self.moving
            .iter()
            .zip(step.iter())
            .for_each(|(&place, &value)| whole[place] = value);
        whole
    }

    /// Length of the undamped step in standard errors: √(gᵀ H⁻¹ g).
    pub fn distance(&self) -> f64 {
        self.spectrum
            .solve(&self.descent, 0.0)
            .dot(&self.descent)
            .max(0.0)
            .sqrt()
    }

    /// Length of the gradient, each component times the standard error that its unknown alone would have.
    pub fn gradient_norm(&self) -> f64 {
        self.descent.component_mul(&self.spectrum.scale).norm()
    }
}

/// Which places of θ are at a bound that the descent direction pushes against.
pub(super) fn held(
    unknowns: &Unknowns,
    theta: &[f64],
    descent: &DVector<f64>,
) -> Vec<Option<Bound>> {
    let bound = |(place, &value): (usize, &f64)| {
        let unknown = unknowns.at(place);
        if value <= unknown.lower && descent[place] < 0.0 {
            Some(Bound::Lower)
        } else if value >= unknown.upper && descent[place] > 0.0 {
            Some(Bound::Upper)
        } else {
            None
        }
    };
    theta.iter().enumerate().map(bound).collect()
}

/// θ + share * step, brought back into the bounds.
pub(super) fn advanced(
    unknowns: &Unknowns,
    theta: &[f64],
    step: &DVector<f64>,
    share: f64,
) -> Vec<f64> {
    let moved = |(place, &value): (usize, &f64)| {
        let unknown = unknowns.at(place);
        (value + share * step[place]).clamp(unknown.lower, unknown.upper)
    };
    theta.iter().enumerate().map(moved).collect()
}
