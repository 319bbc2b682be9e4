//! The limit on the gain: no sample may take away more than all of a state's prediction error, diag(K C) ≤ 1
//! (Maine and Iliff 1981), since R - C P Cᵀ, the covariance of the measurement noise alone, would be negative.
//!
//! At the limit of a state its intensity is no unknown of its own any more: it follows from the others by K C = 1. The
//! equations of a step are reduced to the others (generalised reduced gradient), and after the step the intensity is
//! brought back to the limit.

use nalgebra::{DMatrix, DVector};

use super::evaluation::{FilterEvaluator, Share};
use super::layout::Layout;
use crate::estimate::problem::unusable::Unusable;

/// A share nearer to 1 than this is at the limit.
const NEAR: f64 = 1e-8;
/// How well a share is brought to the limit, and in how many steps of Newton's method.
const EXACT: f64 = 1e-11;
const MOST_STEPS: usize = 30;

/// The states at their limit, and what that makes of a step.
pub(super) struct Limit {
    /// Places of their intensities.
    pub places: Vec<usize>,
    /// dξ of all unknowns for dξ of those that are free; the identity but for the rows of `places`.
    pub reduction: DMatrix<f64>,
}

impl Limit {
    /// The states that are at their limit and whose intensity the descent direction would raise further.
    pub(super) fn new(layout: &Layout, shares: &[Share], descent: &DVector<f64>) -> Self {
        let mut active: Vec<(usize, usize)> = (0..shares.len())
            .filter(|&state| shares[state].value > 1.0 - NEAR)
            .filter_map(|state| Some((state, layout.place(state)?)))
            .collect();
        while !active.is_empty() {
            let own = own_slopes(&active, shares).transpose().lu();
            let pull = DVector::from_fn(active.len(), |i, _| descent[active[i].1]);
            // how the cost falls with each share; one that falls with less of it is not held
            let Some(multipliers) = own.solve(&pull) else {
                active.clear();
                break;
            };
            let least =
                (0..active.len()).min_by(|&a, &b| multipliers[a].total_cmp(&multipliers[b]));
            match least.filter(|&least| multipliers[least] <= 0.0) {
                Some(least) => active.remove(least),
                None => break,
            };
        }
        let places: Vec<usize> = active.iter().map(|&(_, place)| place).collect();
        let mut reduction = DMatrix::identity(layout.len(), layout.len());
        let mut others = DMatrix::from_fn(active.len(), layout.len(), |i, place| {
            -shares[active[i].0].slope[place]
        });
        places
            .iter()
            .for_each(|&place| others.fill_column(place, 0.0));
        let rows = (!active.is_empty()).then(|| own_slopes(&active, shares).lu().solve(&others));
        if let Some(rows) = rows.flatten() {
            for (i, &place) in places.iter().enumerate() {
                reduction.set_row(place, &rows.row(i));
            }
        }
        Self { places, reduction }
    }
}

/// ∂share/∂f of some states by their own intensities.
fn own_slopes(active: &[(usize, usize)], shares: &[Share]) -> DMatrix<f64> {
    DMatrix::from_fn(active.len(), active.len(), |i, j| {
        shares[active[i].0].slope[active[j].1]
    })
}

/// Brings the intensities at `places` to their limit, and all others that are beyond it.
///
/// # Errors
/// There is no steady gain on the way, or no such intensity.
pub(super) fn restore(
    evaluator: &mut FilterEvaluator<'_>,
    xi: &mut [f64],
    weight: &DMatrix<f64>,
    places: &[usize],
) -> Result<(), Unusable> {
    let mut active: Vec<(usize, usize)> = Vec::new();
    for _ in 0..MOST_STEPS {
        let shares = evaluator.shares(xi, weight)?;
        for (state, share) in shares.iter().enumerate() {
            let Some(place) = evaluator.layout.place(state) else {
                continue;
            };
            let known = active.iter().any(|&(known, _)| known == state);
            if !known && (places.contains(&place) || share.value > 1.0 + EXACT) {
                active.push((state, place));
            }
        }
        let excess = DVector::from_fn(active.len(), |i, _| shares[active[i].0].value - 1.0);
        if excess.amax() <= EXACT {
            return Ok(());
        }
        let change = own_slopes(&active, &shares).lu().solve(&excess);
        let change = change.ok_or(Unusable::NotFinite)?;
        for (&(_, place), &change) in active.iter().zip(&change) {
            // an intensity is positive: half of it is the most that a step takes, twice the most it adds
            xi[place] = (xi[place] - change).clamp(0.5 * xi[place], 2.0 * xi[place]);
        }
    }
    Err(Unusable::NotFinite)
}
