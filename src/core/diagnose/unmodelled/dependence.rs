//! What a force depends on: the share of it that a smooth curve over one quantity, learned in some flights, explains in
//! others.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rayon::prelude::*;

use super::curve::Curve;
use super::normal::Normal;
use super::parts::{Parted, stacked};
use super::quantities::Quantity;
use super::report::ForceCurve;
use super::responses::Response;
use super::shapes::Shapes;
use super::smoothness::{Posterior, Smoothness};
use crate::stop;

/// Directions of a curve that are seen less than this, relative to the best seen, are imitated by the declared model.
const IMITATED: f64 = 1e-3;

/// Points of a curve, between these shares of the samples.
const POINTS: usize = 60;
const EDGES: [f64; 2] = [0.005, 0.995];

/// Two standard deviations to either side: 95 %.
const BAND: f64 = 2.0;

/// A force's flights, and what they say of it.
pub(super) struct Evidence<'e> {
    pub responses: &'e [Response],
    pub shapes: &'e [Shapes],
    /// Of the flights that were fitted, together.
    pub normal: &'e Normal,
    pub clear: f64,
    pub samples: f64,
    /// So many flights were fitted, and come first.
    pub fitted: usize,
    pub parts: &'e [Parted],
}

/// How a force depends on one quantity.
pub(super) struct Dependence {
    pub quantity: Quantity,
    /// Of the force in flights that were not fitted; negative where the curve misleads.
    pub share: f64,
    pub curve: ForceCurve,
}

impl Evidence<'_> {
    /// Dependences on all of some quantities, the largest share first.
    pub(super) fn dependences(&self, quantities: &[Quantity]) -> Vec<Dependence> {
        let of = stop::shared(|quantity: &Quantity| self.dependence(quantity));
        let mut found: Vec<Dependence> = quantities.par_iter().filter_map(of).collect();
        found.sort_by(|a, b| b.share.total_cmp(&a.share));
        found
    }

    fn dependence(&self, quantity: &Quantity) -> Option<Dependence> {
        let curve = Curve::over(quantity, self.shapes)?;
        let smoothness = Smoothness::all(&[curve.splines.count])?;
        let learn = |sums: (f64, f64), normal: &Normal| {
            Posterior::likeliest(sums, normal, &smoothness).map(|found| found.sizes)
        };
        let share = self.share(&curve.sizes, learn)?;
        let fitted: Vec<usize> = (0..self.fitted).collect();
        let normal = self.normal.through(&stacked(&curve.sizes, &fitted));
        let posterior = Posterior::likeliest((self.clear, self.samples), &normal, &smoothness)?;
        Some(Dependence {
            curve: shown(quantity, &curve, &normal, &posterior, self.fitted)?,
            quantity: quantity.clone(),
            share,
        })
    }

    /// The share of a force made of a few numbers, where it has to hold.
    pub(super) fn share(
        &self,
        made: &[DMatrix<f64>],
        learn: impl Fn((f64, f64), &Normal) -> Option<DVector<f64>>,
    ) -> Option<f64> {
        let mut gain = 0.0;
        for part in self.parts {
            gain += part.gain(self.responses, made, &learn)?;
        }
        let possible: f64 = self.parts.iter().map(|part| part.possible).sum();
        (possible > 0.0).then(|| gain / possible)
    }
}

/// The curve without what the declared model imitates of it.
fn shown(
    quantity: &Quantity,
    curve: &Curve,
    normal: &Normal,
    posterior: &Posterior,
    fitted: usize,
) -> Option<ForceCurve> {
    let eigen = SymmetricEigen::try_new(normal.gram.clone(), f64::EPSILON, 10_000)?;
    let least = IMITATED * eigen.eigenvalues.max();
    let seen: Vec<DVector<f64>> = (0..eigen.eigenvalues.len())
        .filter(|&i| eigen.eigenvalues[i] > least)
        .map(|i| eigen.eigenvectors.column(i).into_owned())
        .collect();
    if seen.is_empty() {
        return Some(ForceCurve::default());
    }
    let seen = DMatrix::from_columns(&seen);
    let onto = &seen * seen.transpose();
    let sizes = &onto * &posterior.sizes;
    let covariance = &onto * posterior.covariance() * &onto;
    let [from, to] = quantity.quantiles(fitted, EDGES);
    let step = (to - from) / (POINTS - 1) as f64;
    let x: Vec<f64> = (0..POINTS).map(|k| from + k as f64 * step).collect();
    let y = curve.values(&sizes, &x);
    let band: Vec<f64> = (curve.variances(&covariance, &x).iter())
        .map(|variance| BAND * variance.sqrt())
        .collect();
    let side = |sign: f64| {
        y.iter()
            .zip(&band)
            .map(|(y, band)| y + sign * band)
            .collect()
    };
    Some(ForceCurve {
        lower: side(-1.0),
        upper: side(1.0),
        x,
        y,
    })
}
