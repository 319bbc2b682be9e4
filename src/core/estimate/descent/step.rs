//! One step of the iteration: from gradient and Hessian to a change of θ that respects bounds.

use nalgebra::{DMatrix, DVector};

use crate::estimate::linear::definite::Definite;
use crate::estimate::linear::spectrum::Spectrum;
use crate::estimate::problem::unknowns::Unknowns;
use crate::estimate::report::parameter::Bound;

/// Gradient and Hessian at an iterate, and what bounds leave of them.
pub(crate) struct Newton {
    hessian: Hessian,
    /// Places of θ that are not held at a bound; the Hessian is over these.
    moving: Vec<usize>,
    descent: DVector<f64>,
    unknowns: usize,
}

impl Newton {
    /// `held` are the places held at a bound. With U the `relaxation`, the Hessian less U Uᵀ is used where that is
    /// positive definite, else the information matrix alone.
    pub(crate) fn new(
        information: &DMatrix<f64>,
        relaxation: Option<&DMatrix<f64>>,
        descent: &DVector<f64>,
        held: &[Option<Bound>],
    ) -> Option<Self> {
        let moving: Vec<usize> = (0..held.len()).filter(|&i| held[i].is_none()).collect();
        let hessian = if moving.len() == held.len() {
            Hessian::of(information, relaxation)?
        } else {
            let own = information.select_rows(&moving).select_columns(&moving);
            let relaxation = relaxation.map(|columns| columns.select_rows(&moving));
            Hessian::of(&own, relaxation.as_ref())?
        };
        Some(Self {
            hessian,
            descent: descent.select_rows(&moving),
            moving,
            unknowns: held.len(),
        })
    }

    /// The change of θ for a damping λ.
    pub(crate) fn step(&self, damping: f64) -> DVector<f64> {
        let step = self.hessian.solve(&self.descent, damping);
        let mut whole = DVector::zeros(self.unknowns);
        self.moving
            .iter()
            .zip(step.iter())
            .for_each(|(&place, &value)| whole[place] = value);
        whole
    }

    /// Length of the undamped step in standard errors: √(gᵀ H⁻¹ g).
    pub(crate) fn distance(&self) -> f64 {
        self.hessian
            .solve(&self.descent, 0.0)
            .dot(&self.descent)
            .max(0.0)
            .sqrt()
    }

    /// Length of the gradient, each component times the standard error that its unknown alone would have.
    pub(crate) fn gradient_norm(&self) -> f64 {
        self.descent.component_mul(self.hessian.scale()).norm()
    }
}

/// Length of a step in standard errors: √(sᵀ F s).
pub(crate) fn length(step: &DVector<f64>, information: &DMatrix<f64>) -> f64 {
    step.dot(&(information * step)).max(0.0).sqrt()
}

/// The Hessian in the form in which a step is solved.
enum Hessian {
    /// All directions are seen.
    Definite(Definite),
    /// Some may not be, and are then left out.
    Split(Spectrum),
}

impl Hessian {
    /// U Uᵀ of the `relaxation` is what the change of R takes off the information matrix.
    fn of(information: &DMatrix<f64>, relaxation: Option<&DMatrix<f64>>) -> Option<Self> {
        let diagonal = information.diagonal();
        // what is taken off is positive: where the rest sees a direction, the whole does
        let definite = relaxation
            .and_then(|columns| Definite::less(information, columns, &diagonal))
            .or_else(|| Definite::of(information, &diagonal));
        if let Some(definite) = definite {
            return Some(Self::Definite(definite));
        }
        let spectrum = Spectrum::of(information, &diagonal)?;
        let seen = |spectrum: &Spectrum| {
            let all = 0..spectrum.values.len();
            all.filter(|&i| spectrum.is_seen(i)).count()
        };
        let sharper = relaxation
            .and_then(|u| Spectrum::of(&(information - u * u.transpose()), &diagonal))
            .filter(|sharper| seen(sharper) == seen(&spectrum));
        Some(Self::Split(sharper.unwrap_or(spectrum)))
    }

    /// (H + λ diag)⁻¹ v over the directions that are seen.
    fn solve(&self, v: &DVector<f64>, damping: f64) -> DVector<f64> {
        match self {
            Self::Definite(definite) => definite.solve(v, damping),
            Self::Split(spectrum) => spectrum.solve(v, damping),
        }
    }

    /// 1/√diagonal of the information matrix.
    fn scale(&self) -> &DVector<f64> {
        match self {
            Self::Definite(definite) => definite.scale(),
            Self::Split(spectrum) => &spectrum.scale,
        }
    }
}

/// Which places of θ are at a bound that the descent direction pushes against.
pub(crate) fn held(
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
pub(crate) fn advanced(
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
