//! Least squares within limits: Levenberg and Marquardt's steps, over what is not held at a limit.

use nalgebra::{DMatrix, DVector};

use super::conditions::{Conditions, Subject};
use super::equations::{Equations, Rows};

/// Where the search ended.
pub(super) struct Solution {
    /// States, then inputs.
    pub z: Vec<f64>,
    /// By condition.
    pub residual: Vec<f64>,
    pub is_reached: bool,
    /// By unknown: held, or at a limit that it would leave.
    pub is_held: Vec<bool>,
    /// Directions in which nothing changes, each by its unknowns.
    pub undetermined: Vec<Vec<usize>>,
}

impl Solution {
    /// Unknowns that the conditions decide.
    pub(super) fn free(&self) -> Vec<usize> {
        (0..self.z.len()).filter(|&i| !self.is_held[i]).collect()
    }
}

const MOST_STEPS: usize = 500;
/// A condition counts as met to so much of what its terms add up to.
const TOLERANCE: f64 = 1e-9;
/// Singular values below this, of columns of length one, are zero.
const SMALLEST: f64 = 1e-9;

pub(super) fn solve(
    equations: &Equations,
    conditions: &Conditions,
    parameters: &[f64],
) -> Solution {
    let rows = |z: &[f64]| conditions.rows(&equations.at(z, parameters));
    let mut pinned = vec![false; conditions.start.len()];
    let mut z = conditions.start.clone();
    for condition in &conditions.all {
        if let Subject::Unknown(place) = condition.subject {
            pinned[place] = true;
            z[place] = condition.wanted;
        }
    }
    let mut here = rows(&z);
    let mut damping = 1e-3;
    for _ in 0..MOST_STEPS {
        let free = not_at_limit(&here, &z, conditions, &pinned);
        if is_met(&here, &z) || free.is_empty() || !is_finite(&here) {
            break;
        }
        let Some(moved) = step(&here, &z, &free, damping, conditions) else {
            break;
        };
        let there = rows(&moved);
        // written so that no number is no progress
        if cost(&there) < cost(&here) && is_finite(&there) {
            (z, here) = (moved, there);
            damping = (damping / 10.0).max(1e-15);
        } else if damping > 1e12 {
            break;
        } else {
            damping *= 10.0;
        }
    }
    let free = not_at_limit(&here, &z, conditions, &pinned);
    let mut is_held = vec![true; z.len()];
    free.iter().for_each(|&place| is_held[place] = false);
    Solution {
        is_reached: is_met(&here, &z),
        residual: here.values.clone(),
        undetermined: undetermined(&here, &free),
        is_held,
        z,
    }
}

/// A decomposition of what is no number would not end.
fn is_finite(rows: &Rows) -> bool {
    let all = rows.values.iter().chain(rows.by_unknown.iter());
    all.chain(rows.by_parameter.iter())
        .all(|value| value.is_finite())
}

fn cost(rows: &Rows) -> f64 {
    rows.values.iter().map(|r| r * r).sum()
}

/// Each condition to rounding: beside what its terms add up to.
fn is_met(rows: &Rows, z: &[f64]) -> bool {
    rows.values.iter().enumerate().all(|(row, residual)| {
        let terms = z.iter().enumerate();
        let size: f64 = terms
            .map(|(i, z)| (rows.by_unknown[(row, i)] * z).abs())
            .sum();
        residual.abs() <= TOLERANCE * (1e-3 + size)
    })
}

/// Unknowns that are not held, and not at a limit beyond which the conditions would push them.
fn not_at_limit(rows: &Rows, z: &[f64], conditions: &Conditions, pinned: &[bool]) -> Vec<usize> {
    let residual = DVector::from_column_slice(&rows.values);
    let gradient = rows.by_unknown.tr_mul(&residual);
    let is_free = |&place: &usize| {
        let below = z[place] <= conditions.lower[place] && gradient[place] > 0.0;
        let above = z[place] >= conditions.upper[place] && gradient[place] < 0.0;
        !pinned[place] && !below && !above
    };
    (0..z.len()).filter(is_free).collect()
}

/// z after a step, or none where nothing moves.
fn step(
    rows: &Rows,
    z: &[f64],
    free: &[usize],
    damping: f64,
    conditions: &Conditions,
) -> Option<Vec<f64>> {
    let jacobian = rows.by_unknown.select_columns(free);
    let residual = DVector::from_column_slice(&rows.values);
    // unit columns: units of any size do no harm, and D is the unit matrix
    let lengths: Vec<f64> = jacobian.column_iter().map(|c| c.norm()).collect();
    let scaled = with_unit_columns(&jacobian, &lengths);
    let svd = scaled.svd(true, true);
    let (u, v) = (svd.u?, svd.v_t?);
    let mut moved = z.to_vec();
    for (k, value) in svd.singular_values.iter().enumerate() {
        if *value <= SMALLEST {
            continue;
        }
        let along = u.column(k).dot(&residual) * value / (value * value + damping);
        for (column, &place) in free.iter().enumerate() {
            if lengths[column] > 0.0 {
                moved[place] -= along * v[(k, column)] / lengths[column];
            }
        }
    }
    for &place in free {
        let (lower, upper) = (conditions.lower[place], conditions.upper[place]);
        moved[place] = moved[place].max(lower).min(upper);
    }
    (moved != z).then_some(moved)
}

fn with_unit_columns(jacobian: &DMatrix<f64>, lengths: &[f64]) -> DMatrix<f64> {
    let mut scaled = jacobian.clone();
    for (mut column, length) in scaled.column_iter_mut().zip(lengths) {
        if *length > 0.0 {
            column.unscale_mut(*length);
        }
    }
    scaled
}

/// Which of `free` nothing decides: for each direction without effect those that have the largest part in it.
fn undetermined(rows: &Rows, free: &[usize]) -> Vec<Vec<usize>> {
    if free.is_empty() || !is_finite(rows) {
        return Vec::new();
    }
    let is_seen = |&place: &usize| rows.by_unknown.column(place).amax() > 0.0;
    let (free, unseen): (Vec<usize>, Vec<usize>) = free.iter().copied().partition(is_seen);
    let mut all: Vec<Vec<usize>> = unseen.into_iter().map(|place| vec![place]).collect();
    if free.is_empty() {
        return all;
    }
    let jacobian = rows.by_unknown.select_columns(&free);
    let lengths: Vec<f64> = jacobian.column_iter().map(|c| c.norm()).collect();
    let scaled = with_unit_columns(&jacobian, &lengths);
    // square, so that all directions are there
    let gram = scaled.tr_mul(&scaled).symmetric_eigen();
    for (k, value) in gram.eigenvalues.iter().enumerate() {
        if *value > 1e-12 {
            continue;
        }
        let direction = gram.eigenvectors.column(k);
        let most = direction.amax();
        let part = |&column: &usize| direction[column].abs() > 0.3 * most;
        all.push(
            (0..free.len())
                .filter(part)
                .map(|column| free[column])
                .collect(),
        );
    }
    all
}

/// J⁺, by singular values of unit columns; none where it is no number.
pub(super) fn pseudo_inverse(jacobian: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    if jacobian.is_empty() {
        return Some(DMatrix::zeros(jacobian.ncols(), jacobian.nrows()));
    }
    let lengths: Vec<f64> = jacobian.column_iter().map(|c| c.norm()).collect();
    let scaled = with_unit_columns(jacobian, &lengths);
    let mut inverse = scaled.svd(true, true).pseudo_inverse(SMALLEST).ok()?;
    for (mut row, length) in inverse.row_iter_mut().zip(&lengths) {
        if *length > 0.0 {
            row.unscale_mut(*length);
        }
    }
    inverse
        .iter()
        .all(|value| value.is_finite())
        .then_some(inverse)
}
