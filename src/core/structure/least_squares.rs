//! A least-squares fit of some terms, and what is said of it.

use nalgebra::{DMatrix, DVector};

use super::candidates::{Candidates, DEPENDENT};
use super::report::Term;
use crate::stop::check;

/// ŷ = Xθ̂ by QR decomposition.
pub(super) struct Fit {
    /// θ̂ of the constant, if there is one, then of the terms.
    pub estimates: DVector<f64>,
    /// Diagonal of (XᵀX)⁻¹.
    pub inverse: DVector<f64>,
    /// z - ŷ
    pub residual: DVector<f64>,
    /// (z - ŷ)ᵀ(z - ŷ)
    pub squares: f64,
    /// Of X: orthonormal columns that span it.
    basis: DMatrix<f64>,
}

impl Fit {
    /// `None` where the terms are not independent, or there are no more samples than terms.
    pub(super) fn of(candidates: &Candidates, terms: &[usize]) -> Option<Self> {
        let design = candidates.design(terms);
        let (rows, columns) = design.shape();
        if rows <= columns {
            return None;
        }
        if columns == 0 {
            let residual = candidates.response.clone();
            return Some(Self {
                estimates: DVector::zeros(0),
                inverse: DVector::zeros(0),
                squares: residual.norm_squared(),
                residual,
                basis: DMatrix::zeros(rows, 0),
            });
        }
        let scale = DVector::from_iterator(columns, design.column_iter().map(|c| c.norm()));
        if scale
            .iter()
            .any(|length| *length == 0.0 || !length.is_finite())
        {
            return None;
        }
        let mut scaled = design;
        for (mut column, length) in scaled.column_iter_mut().zip(scale.iter()) {
            column /= *length;
        }
        let (basis, upper) = decomposed(scaled);
        if upper
            .diagonal()
            .iter()
            .any(|pivot| pivot.powi(2) < DEPENDENT)
        {
            return None;
        }
        let inverse = upper.clone().try_inverse()?;
        check();
        let projected = basis.tr_mul(&candidates.response);
        let residual = &candidates.response - &basis * &projected;
        let diagonal = |i: usize| inverse.row(i).norm_squared() / scale[i].powi(2);
        Some(Self {
            estimates: (&inverse * projected).component_div(&scale),
            inverse: DVector::from_fn(columns, |i, _| diagonal(i)),
            squares: residual.norm_squared(),
            residual,
            basis,
        })
    }

    fn parameters(&self) -> usize {
        self.estimates.len()
    }

    /// s² = Σe²/(N - p)
    pub(super) fn variance(&self) -> f64 {
        self.squares / (self.residual.len() - self.parameters()) as f64
    }

    /// F = θ̂²/(s² (XᵀX)⁻¹_ii) of the parameter at a place.
    pub(super) fn partial_f(&self, place: usize) -> f64 {
        self.estimates[place].powi(2) / (self.variance() * self.inverse[place])
    }

    /// PRESS = Σ (e_i/(1 - h_i))², the squares of the errors with which each sample is predicted from all others.
    pub(super) fn press(&self) -> f64 {
        let rows = self.basis.row_iter().zip(self.residual.iter());
        rows.map(|(row, e)| (e / (1.0 - row.norm_squared())).powi(2))
            .sum()
    }

    /// Σe²/N + σ²_max p/N
    pub(super) fn pse(&self, variation: f64) -> f64 {
        let samples = self.residual.len() as f64;
        self.squares / samples + variation / samples * self.parameters() as f64 / samples
    }

    /// 1 - Σe²/Σ(z - z̄)²
    pub(super) fn r_squared(&self, variation: f64) -> f64 {
        if variation > 0.0 {
            1.0 - self.squares / variation
        } else {
            0.0
        }
    }

    /// What of a column the terms do not explain already.
    pub(super) fn left_of(&self, column: &DVector<f64>) -> DVector<f64> {
        check();
        column - &self.basis * self.basis.tr_mul(column)
    }

    /// Terms beside the `chosen` that these and the constant are another name for: a search never has them in question.
    pub(super) fn explained(&self, candidates: &Candidates, chosen: &[usize]) -> Vec<String> {
        let others = (0..candidates.names.len()).filter(|term| !chosen.contains(term));
        let explained = others.filter(|&term| {
            let column = candidates.columns.column(term).into_owned();
            self.left_of(&column).norm_squared() <= DEPENDENT * column.norm_squared()
        });
        explained
            .map(|term| candidates.names[term].clone())
            .collect()
    }

    /// The terms with their estimates, the constant first.
    pub(super) fn terms(&self, candidates: &Candidates, chosen: &[usize]) -> Vec<Term> {
        let constant = candidates.constant.then(|| "1".to_string());
        let names = chosen.iter().map(|&term| candidates.names[term].clone());
        let deviation = self.variance().sqrt();
        let rows = constant.into_iter().chain(names).enumerate();
        rows.map(|(place, name)| Term {
            term: name,
            estimate: self.estimates[place],
            standard_error: deviation * self.inverse[place].sqrt(),
            partial_f: self.partial_f(place),
        })
        .collect()
    }
}

/// X = QR by the process of Gram and Schmidt, taken twice for each column, which leaves no more than rounding (Giraud, Langou
/// and Rozložník, Computers and Mathematics with Applications 50, 2005): Q and R. A column of which nothing is left stays 0.
fn decomposed(mut columns: DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let count = columns.ncols();
    let mut upper = DMatrix::zeros(count, count);
    for j in 0..count {
        check();
        let (before, mut others) = columns.columns_range_pair_mut(..j, j..);
        let mut column = others.column_mut(0);
        for _ in 0..2 {
            let shares = before.tr_mul(&column);
            column.gemv(-1.0, &before, &shares, 1.0);
            let mut above = upper.view_mut((0, j), (j, 1));
            above += shares;
        }
        let length = column.norm();
        upper[(j, j)] = length;
        if length > 0.0 {
            column /= length;
        }
    }
    (columns, upper)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against reflections, of columns that are nearly dependent: powers of one variable.
    #[test]
    fn a_decomposition_is_that_by_reflections() {
        let columns =
            DMatrix::from_fn(200, 9, |row, power| (row as f64 / 200.0).powi(power as i32));
        let (basis, upper) = decomposed(columns.clone());
        let off = (basis.tr_mul(&basis) - DMatrix::identity(9, 9)).abs().max();
        assert!(off < 1e-14, "{off:e}");
        let off = (&basis * &upper - &columns).abs().max();
        assert!(off < 1e-13, "{off:e}");
        let reflected = columns.qr().r();
        for (own, other) in upper.diagonal().iter().zip(reflected.diagonal().iter()) {
            assert!((own - other.abs()).abs() < 1e-10 * own, "{own} {other}");
        }
    }
}
