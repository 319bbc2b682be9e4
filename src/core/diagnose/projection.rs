//! Projecting columns onto what a declared model can move, and off it.

use crate::stop;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// An orthonormal basis of the span of some columns.
#[derive(Clone, Debug, Default)]
pub(super) struct Basis(Vec<Vec<f64>>);

/// A column of which less than this is left by those before it is one of them.
const DEPENDENT: f64 = 1e-7;

impl Basis {
    pub(super) fn of(columns: impl IntoIterator<Item = Vec<f64>>) -> Self {
        let mut basis = Self::default();
        for column in columns {
            basis.add(column);
        }
        basis
    }

    /// Adds what a column brings that is new; how long that is, over the length of the column.
    pub(super) fn add(&mut self, mut column: Vec<f64>) -> f64 {
        let before = norm(&column);
        if !(before > 0.0 && before.is_finite()) {
            return 0.0;
        }
        self.remove_from(&mut column);
        let left = norm(&column);
        if left <= DEPENDENT * before {
            return 0.0;
        }
        column.iter_mut().for_each(|value| *value /= left);
        self.0.push(column);
        left / before
    }

    /// Takes the span's part off a column. Twice, since once leaves rounding errors where little is left.
    pub(super) fn remove_from(&self, column: &mut [f64]) {
        for _ in 0..2 {
            for unit in &self.0 {
                stop::check();
                let share = dot(unit, column);
                column
                    .iter_mut()
                    .zip(unit)
                    .for_each(|(to, from)| *to -= share * from);
            }
        }
    }
}

/// x of least length with G x = m, G symmetric and not negative; directions weaker than `weakest` of the strongest are
/// left out. `None` where G is not finite: an unbounded decomposition would never end.
pub(super) fn least_squares(
    gram: DMatrix<f64>,
    moment: &DVector<f64>,
    weakest: f64,
) -> Option<DVector<f64>> {
    if !gram
        .iter()
        .chain(moment.iter())
        .all(|value| value.is_finite())
    {
        return None;
    }
    let eigen = SymmetricEigen::try_new(gram, f64::EPSILON, 10_000)?;
    let least = weakest * eigen.eigenvalues.max();
    let inverse = eigen
        .eigenvalues
        .map(|value| if value > least { value.recip() } else { 0.0 });
    Some(&eigen.eigenvectors * inverse.component_mul(&(eigen.eigenvectors.transpose() * moment)))
}

/// Rows that are multiplied between two looks at whether to go on.
const ROWS: usize = 16_384;

/// Aᵀ B of long columns.
pub(super) fn products(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let mut sums = DMatrix::zeros(a.ncols(), b.ncols());
    for first in (0..a.nrows()).step_by(ROWS) {
        stop::check();
        let count = ROWS.min(a.nrows() - first);
        sums.gemm_tr(1.0, &a.rows(first, count), &b.rows(first, count), 1.0);
    }
    sums
}

/// Sums beside each other: one sum waits for each of its additions.
const SUMS: usize = 8;

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, rest_of_a) = a.as_chunks::<SUMS>();
    let (b, rest_of_b) = b.as_chunks::<SUMS>();
    let mut sums = [0.0; SUMS];
    for (a, b) in a.iter().zip(b) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    let rest = rest_of_a.iter().zip(rest_of_b).map(|(a, b)| a * b);
    sums.iter().sum::<f64>() + rest.sum::<f64>()
}

pub(super) fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_in_parts_are_those_of_the_whole() {
        let rows = 2 * ROWS + 37;
        let of = |speed: f64| move |k: usize, j: usize| (speed * (k * (j + 2)) as f64).sin();
        let (a, b) = (
            DMatrix::from_fn(rows, 7, of(0.013)),
            DMatrix::from_fn(rows, 5, of(0.41)),
        );
        let off = (products(&a, &b) - a.transpose() * &b).abs().max();
        assert!(off < 1e-9, "{off:e}");
    }

    #[test]
    fn what_is_in_the_span_is_no_news() {
        let mut basis = Basis::of([
            vec![1.0, 1.0, 0.0],
            vec![1.0, -1.0, 0.0],
            vec![3.0, 1.0, 0.0],
        ]);
        assert_eq!(basis.0.len(), 2);
        let mut column = vec![5.0, 7.0, 2.0];
        basis.remove_from(&mut column);
        assert!(column[0].abs() < 1e-15 && column[1].abs() < 1e-15 && column[2] == 2.0);
        let share = basis.add(vec![0.0, 3.0, 4.0]);
        assert!((share - 0.8).abs() < 1e-15);
    }
}
