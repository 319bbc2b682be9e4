//! A Hessian in which the data plainly see every direction: solved with by Cholesky's factors, many times cheaper than
//! by eigenvectors and to the same numbers but for rounding. What each maneuver has of its own costs what it would alone.

use nalgebra::{DMatrix, DVector};

use super::elimination::{Order, order};
use super::skyline::{Factor, Skyline};

/// The least eigenvalue of the scaled matrix that is allowed: far above what counts as zero (see
/// [`super::spectrum`]), so that no direction would be left out.
const LEAST_EIGENVALUE: f64 = 1e-10;

/// A positive definite matrix, scaled by the diagonal of another.
#[derive(Clone, Debug)]
pub(crate) struct Definite {
    /// 1/√diagonal.
    scale: DVector<f64>,
    /// Places in the order of elimination.
    places: Vec<usize>,
    /// Scaled, in that order.
    matrix: Skyline,
    factor: Factor,
}

impl Definite {
    /// `None` where some direction might not be seen.
    pub(crate) fn of(matrix: &DMatrix<f64>, diagonal: &DVector<f64>) -> Option<Self> {
        let none = DMatrix::zeros(matrix.nrows(), 0);
        Self::bordered(matrix, &none, diagonal, order(matrix))
    }

    /// M − U Uᵀ; where M has few numbers, it stays so: x of
    ///
    /// ```text
    /// | M   U | |x|   |v|
    /// | Uᵀ  I | |y| = |0|
    /// ```
    ///
    /// is (M − U Uᵀ)⁻¹ v, and the bordered matrix is positive definite where M − U Uᵀ is.
    pub(crate) fn less(
        matrix: &DMatrix<f64>,
        columns: &DMatrix<f64>,
        diagonal: &DVector<f64>,
    ) -> Option<Self> {
        let order = order(matrix);
        if order.own == 0 {
            return Self::of(&(matrix - columns * columns.transpose()), diagonal);
        }
        Self::bordered(matrix, columns, diagonal, order)
    }

    fn bordered(
        matrix: &DMatrix<f64>,
        columns: &DMatrix<f64>,
        diagonal: &DVector<f64>,
        Order { places, .. }: Order,
    ) -> Option<Self> {
        if !diagonal.iter().all(|&d| d > 0.0 && d.is_finite()) {
            return None;
        }
        let scale = diagonal.map(|d| d.sqrt().recip());
        let n = places.len();
        let scaled = Skyline::new(n + columns.ncols(), |i, j| {
            match (places.get(i), places.get(j)) {
                (Some(&i), Some(&j)) => scale[i] * matrix[(i, j)] * scale[j],
                (None, Some(&j)) => columns[(j, i - n)] * scale[j],
                _ => f64::from(u8::from(i == j)),
            }
        });
        let factor = scaled.clone().factor()?;
        // the largest eigenvalue of the inverse is at most its trace
        let trace = factor.trace_of_inverse(n);
        (trace.is_finite() && trace * LEAST_EIGENVALUE < 1.0).then_some(Self {
            scale,
            places,
            matrix: scaled,
            factor,
        })
    }

    /// 1/√diagonal.
    pub(crate) fn scale(&self) -> &DVector<f64> {
        &self.scale
    }

    /// M⁻¹
    pub(crate) fn inverse(&self) -> DMatrix<f64> {
        let n = self.places.len();
        let mut inverse = DMatrix::zeros(n, n);
        for (place, mut column) in inverse.column_iter_mut().enumerate() {
            let mut unit = DVector::zeros(n);
            unit[place] = 1.0;
            column.copy_from(&self.solve_with(&self.factor, &unit));
        }
        inverse
    }

    /// (M + λ diag)⁻¹ v
    pub(crate) fn solve(&self, v: &DVector<f64>, damping: f64) -> DVector<f64> {
        if damping > 0.0 {
            let mut damped = self.matrix.clone();
            damped.add_to_diagonal(self.places.len(), damping);
            // definite as it was, and more so
            if let Some(factor) = damped.factor() {
                return self.solve_with(&factor, v);
            }
        }
        self.solve_with(&self.factor, v)
    }

    fn solve_with(&self, factor: &Factor, v: &DVector<f64>) -> DVector<f64> {
        let scaled = |&place: &usize| v[place] * self.scale[place];
        let mut x: Vec<f64> = self.places.iter().map(scaled).collect();
        x.resize(factor.len(), 0.0);
        factor.solve(&mut x);
        let mut result = DVector::zeros(v.len());
        for (&place, x) in self.places.iter().zip(x) {
            result[place] = x * self.scale[place];
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::super::spectrum::Spectrum;
    use super::*;

    /// Two nearly equal columns: `apart` is how far they are.
    fn matrix(apart: f64) -> DMatrix<f64> {
        let rows = DMatrix::from_fn(40, 4, |k, i| {
            let k = k as f64;
            let own = [
                1.0,
                (0.3 * k).sin(),
                1e3 * k,
                (0.3 * k).sin() + apart * (0.7 * k).cos(),
            ];
            own[i]
        });
        rows.tr_mul(&rows)
    }

    /// Rounding of 1e-16, magnified by a condition number of some hundred.
    #[test]
    fn solves_as_the_spectrum_does() {
        let matrix = matrix(0.1);
        let v = DVector::from_column_slice(&[1.0, -2.0, 300.0, 0.5]);
        let definite = Definite::of(&matrix, &matrix.diagonal()).expect("definite");
        let spectrum = Spectrum::of(&matrix, &matrix.diagonal()).expect("finite");
        for damping in [0.0, 1e-3, 10.0] {
            let (x, y) = (definite.solve(&v, damping), spectrum.solve(&v, damping));
            assert!((&x - &y).norm() < 1e-11 * y.norm(), "{x} {y}");
        }
        let (x, y) = (definite.inverse(), spectrum.inverse());
        assert!((&x - &y).norm() < 1e-11 * y.norm(), "{x} {y}");
    }

    /// Twenty maneuvers with three unknowns of their own, interleaved, and four that they share. Rounding of 1e-16 is
    /// magnified by a condition number of 150.
    #[test]
    fn what_maneuvers_have_of_their_own_and_what_is_taken_off_change_no_number() {
        let (maneuvers, own, shared) = (20, 3, 4);
        let n = maneuvers * own + shared;
        let mut information = DMatrix::zeros(n, n);
        let mut gradients = DMatrix::zeros(n, 2);
        for maneuver in 0..maneuvers {
            let place = |i: usize| match i {
                0..4 => i,
                _ => shared + (i - 4) * maneuvers + maneuver,
            };
            let rows = DMatrix::from_fn(40, own + shared, |k, i| {
                (0.1 * (k * (i + 1) + 7 * maneuver) as f64 + i as f64).sin()
            });
            let product = rows.tr_mul(&rows);
            for i in 0..own + shared {
                for j in 0..own + shared {
                    information[(place(i), place(j))] += product[(i, j)];
                }
                gradients[(place(i), 0)] += 0.1 * rows[(3, i)];
                gradients[(place(i), 1)] += 0.1 * rows[(8, i)];
            }
        }
        let diagonal = information.diagonal();
        let v = DVector::from_fn(n, |i, _| (i as f64).cos());
        let whole = &information - &gradients * gradients.transpose();
        let definite = Definite::less(&information, &gradients, &diagonal).expect("definite");
        let spectrum = Spectrum::of(&whole, &diagonal).expect("finite");
        assert_eq!(order(&information).own, maneuvers * own);
        for damping in [0.0, 1e-3, 10.0] {
            let (x, y) = (definite.solve(&v, damping), spectrum.solve(&v, damping));
            assert!((&x - &y).norm() < 1e-11 * y.norm(), "{damping}: {x} {y}");
        }
        let (x, y) = (
            Definite::of(&information, &diagonal).expect("definite"),
            Spectrum::of(&information, &diagonal).expect("finite"),
        );
        let (x, y) = (x.inverse(), y.inverse());
        assert!((&x - &y).norm() < 1e-11 * y.norm());
        // as much as there is, and the rest is not definite
        assert!(Definite::less(&information, &(gradients * 100.0), &diagonal).is_none());
    }

    #[test]
    fn what_might_not_be_seen_is_left_to_the_spectrum() {
        assert!(Definite::of(&matrix(1e-3), &matrix(1e-3).diagonal()).is_some());
        for apart in [1e-5, 1e-8, 0.0] {
            let matrix = matrix(apart);
            assert!(
                Definite::of(&matrix, &matrix.diagonal()).is_none(),
                "{apart}"
            );
        }
        let unseen = DMatrix::from_diagonal(&DVector::from_column_slice(&[1.0, 0.0]));
        assert!(Definite::of(&unseen, &unseen.diagonal()).is_none());
    }
}
