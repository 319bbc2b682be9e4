//! Poles and zeros as roots of a pencil M − s E with E = diag(1, ..., 1, 0, ..., 0), and their derivatives by θ.
//!
//! Poles are the roots of A − s, zeros those of [A − s, B; C, D] (Rosenbrock's system matrix). With M v = s E v and
//! wᴴ M = s wᴴ E a simple root moves by ds/dθ = wᴴ (dM/dθ) v / (wᴴ E v) (Golub and Van Loan, Matrix Computations, sec.
//! 7.2.2 and 7.7).

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

/// M − s E over balanced states.
pub(super) struct Pencil {
    pub matrix: DMatrix<f64>,
    /// How many ones E has.
    pub states: usize,
    /// dM/dθ by place of θ.
    pub by_place: Vec<Entries>,
}

/// The entries of a matrix that are not zero: most unknowns stand in few places.
pub(super) type Entries = Vec<(usize, usize, f64)>;

/// Those of a matrix.
pub(super) fn entries(matrix: &DMatrix<f64>) -> Entries {
    let places = (0..matrix.ncols()).flat_map(|j| (0..matrix.nrows()).map(move |i| (i, j)));
    let all = places.map(|(i, j)| (i, j, matrix[(i, j)]));
    all.filter(|(_, _, value)| *value != 0.0).collect()
}

/// leftᵀ dM right
pub(super) fn form(
    left: &DVector<Complex64>,
    entries: &Entries,
    right: &DVector<Complex64>,
) -> Complex64 {
    let products = entries
        .iter()
        .map(|&(i, j, value)| left[i] * value * right[j]);
    products.sum()
}

/// A root of a pencil.
#[derive(Clone, Debug)]
pub(super) struct FoundRoot {
    pub value: Complex64,
    /// By place of θ.
    pub derivatives: Vec<Complex64>,
}

impl Pencil {
    /// The part of it over the states alone, whose roots are the poles.
    pub(super) fn of_states(&self) -> Self {
        let n = self.states;
        let part = |entries: &Entries| -> Entries {
            let inside = entries.iter().filter(|(i, j, _)| *i < n && *j < n);
            inside.copied().collect()
        };
        Self {
            matrix: self.matrix.view((0, 0), (n, n)).into_owned(),
            states: n,
            by_place: self.by_place.iter().map(part).collect(),
        }
    }

    /// Roots of which the values are known to some digits, with their derivatives; the last digits are found by Rayleigh's
    /// quotient. Derivatives are missing where a root is not simple.
    pub(super) fn roots(&self, near: &[Complex64]) -> Vec<FoundRoot> {
        near.iter().map(|&value| self.root(value)).collect()
    }

    fn root(&self, near: Complex64) -> FoundRoot {
        let lost = FoundRoot {
            value: near,
            derivatives: Vec::new(),
        };
        let Some((left, right)) = self.vectors(near) else {
            return lost;
        };
        let rows = self.states;
        let normal = left.rows(0, rows).dotc(&right.rows(0, rows));
        // a real root stays on the axis
        let on_axis = |root: Complex64| match near.im == 0.0 {
            true => Complex64::from(root.re),
            false => root,
        };
        let left = left.map(|z| z.conj());
        let whole = (left.transpose() * self.matrix.map(Complex64::from) * &right)[(0, 0)];
        let value = on_axis(whole / normal);
        let derivatives: Vec<Complex64> = (self.by_place.iter())
            .map(|by| on_axis(form(&left, by, &right) / normal))
            .collect();
        let is_good = |z: &Complex64| z.re.is_finite() && z.im.is_finite();
        // of a double root the quotient is no better than what it began from
        let has_moved = (value - near).norm() > 1e-6 * (near.norm() + self.matrix.norm());
        if has_moved || !is_good(&value) || !derivatives.iter().all(is_good) {
            return lost;
        }
        FoundRoot { value, derivatives }
    }

    /// Left and right null vectors of M − s E by inverse iteration.
    fn vectors(&self, s: Complex64) -> Option<(DVector<Complex64>, DVector<Complex64>)> {
        const ITERATIONS: usize = 3;
        let (n, states) = (self.matrix.nrows(), self.states);
        // off the root by rounding, so that the equations can be solved
        let shift = s + Complex64::from(f64::EPSILON * self.matrix.norm());
        let mut shifted = self.matrix.map(Complex64::from);
        (0..states).for_each(|i| shifted[(i, i)] -= shift);
        let vector = |of: DMatrix<Complex64>| {
            let equations = of.lu();
            let start = |k: usize, _| Complex64::new(1.0, 0.37 * (k as f64 + 1.0));
            let mut vector = DVector::from_fn(n, start);
            for _ in 0..ITERATIONS {
                // (M − s E)⁻¹ E
                vector.rows_mut(states, n - states).fill(Complex64::ZERO);
                vector = equations.solve(&vector)?;
                let length = vector.norm();
                vector.unscale_mut(length);
            }
            Some(vector)
        };
        Some((vector(shifted.adjoint())?, vector(shifted)?))
    }
}

/// How far the nearest other root is.
pub(super) fn nearest(roots: &[FoundRoot], index: usize) -> f64 {
    (roots.iter().enumerate())
        .filter(|&(other, _)| other != index)
        .map(|(_, other)| (other.value - roots[index].value).norm())
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// s² + 2ζω s + ω² over s + z: roots and slopes in closed form.
    #[test]
    fn roots_move_as_the_closed_form_says() {
        // A = [0 1; -b -a], B = [0; 1], C = [z 1], D = 0: (s + z)/(s² + a s + b)
        let matrix = |z: f64, a: f64, b: f64| {
            DMatrix::from_row_slice(3, 3, &[0.0, 1.0, 0.0, -b, -a, 1.0, z, 1.0, 0.0])
        };
        let (z, a, b) = (0.7, 1.2, 4.0);
        let by = |dz: f64, da: f64, db: f64| matrix(z + dz, a + da, b + db) - matrix(z, a, b);
        let pencil = Pencil {
            matrix: matrix(z, a, b),
            states: 2,
            by_place: [by(1.0, 0.0, 0.0), by(0.0, 1.0, 0.0), by(0.0, 0.0, 1.0)]
                .iter()
                .map(entries)
                .collect(),
        };
        let zero = &pencil.roots(&[Complex64::new(-0.700_000_1, 0.0)])[0];
        assert!((zero.value + z).norm() < 1e-12, "{}", zero.value);
        for (found, expected) in zero.derivatives.iter().zip([-1.0, 0.0, 0.0]) {
            assert!((found - expected).norm() < 1e-12);
        }
        let pole = Complex64::new(-0.5 * a, (b - 0.25 * a * a).sqrt());
        let found = &pencil.of_states().roots(&[pole + 1e-7])[0];
        assert!((found.value - pole).norm() < 1e-12);
        // (2 s + a) ds + s da + db = 0
        let slope = 2.0 * pole + a;
        for (found, expected) in
            (found.derivatives.iter()).zip([Complex64::ZERO, -pole / slope, -slope.inv()])
        {
            assert!((found - expected).norm() < 1e-12, "{found} {expected}");
        }
    }
}
