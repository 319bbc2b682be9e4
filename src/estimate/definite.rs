//! A Hessian in which the data plainly see every direction: solved with by Cholesky's factors, many times cheaper than
//! by eigenvectors and to the same numbers but for rounding.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::information::scaled;

/// What the least eigenvalue of the scaled matrix must at least be: far above what counts as zero (see
/// [`super::information`]), so that no direction would be left out.
const LEAST_EIGENVALUE: f64 = 1e-10;

/// A positive definite matrix, scaled by the diagonal of another.
#[derive(Clone, Debug)]
pub(super) struct Definite {
    /// 1/√diagonal.
    scale: DVector<f64>,
    scaled: DMatrix<f64>,
    factor: Cholesky<f64, Dyn>,
}

impl Definite {
    /// `None` where some direction might not be seen.
    pub fn of(matrix: &DMatrix<f64>, diagonal: &DVector<f64>) -> Option<Self> {
        if !diagonal.iter().all(|&d| d > 0.0 && d.is_finite()) {
            return None;
        }
        let scale = diagonal.map(|d| d.sqrt().recip());
        let scaled = scaled(matrix, &scale);
        let factor = scaled.clone().cholesky()?;
        // the largest eigenvalue of A⁻¹ = L⁻ᵀL⁻¹ is at most its trace, the sum of squares of L⁻¹, whose columns begin at
        // the diagonal
        let (n, lower) = (scaled.nrows(), factor.l_dirty());
        let squares = (0..n).map(|j| {
            let mut column = DVector::zeros(n - j);
            column[0] = 1.0;
            let corner = lower.view((j, j), (n - j, n - j));
            corner.solve_lower_triangular_mut(&mut column);
            column.norm_squared()
        });
        let trace: f64 = squares.sum();
        (trace.is_finite() && trace * LEAST_EIGENVALUE < 1.0).then_some(Self {
            scale,
            scaled,
            factor,
        })
    }

    /// 1/√diagonal.
    pub fn scale(&self) -> &DVector<f64> {
        &self.scale
    }

    /// M⁻¹
    pub fn inverse(&self) -> DMatrix<f64> {
        scaled(&self.factor.inverse(), &self.scale)
    }

    /// (M + λ diag)⁻¹ v
    pub fn solve(&self, v: &DVector<f64>, damping: f64) -> DVector<f64> {
        let mut x = v.component_mul(&self.scale);
        if damping > 0.0 {
            let mut damped = self.scaled.clone();
            for i in 0..damped.nrows() {
                damped[(i, i)] += damping;
            }
            // definite as it was, and more so
            let factor = damped.cholesky();
            factor.as_ref().unwrap_or(&self.factor).solve_mut(&mut x);
        } else {
            self.factor.solve_mut(&mut x);
        }
        x.component_mul_assign(&self.scale);
        x
    }
}

#[cfg(test)]
mod tests {
    use super::super::information::Spectrum;
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
