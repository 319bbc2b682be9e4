//! Cramér-Rao bounds from an information matrix: the least standard errors that an unbiased estimate can have.

use nalgebra::{Cholesky, DMatrix};

/// Eigenvalues of the scaled information matrix below this, times its size, are rounding: nothing is told along them.
const SMALLEST: f64 = 1e-12;

/// What parts of directions that nothing is told along take part in.
const PART: f64 = 1e-3;

/// Bounds by place of θ, SI.
pub(super) struct Bounds {
    /// None where the maneuver does not tell it, or not from others.
    pub errors: Vec<Option<f64>>,
    /// P, without what is not told.
    pub covariance: DMatrix<f64>,
}

impl Bounds {
    /// From F.
    pub(super) fn of(information: &DMatrix<f64>) -> Self {
        let n = information.nrows();
        // of nothing there is no decomposition, and none of what is no number
        if n == 0 || !information.iter().all(|entry| entry.is_finite()) {
            return Self {
                errors: vec![None; n],
                covariance: DMatrix::zeros(n, n),
            };
        }
        let size: Vec<f64> = (0..n)
            .map(|i| information[(i, i)].max(0.0).sqrt())
            .collect();
        let scaled = scaled(information, &size);
        let spectrum = scaled.symmetric_eigen();
        let is_told = |k: usize| spectrum.eigenvalues[k] > SMALLEST * n as f64;
        let mut covariance = DMatrix::zeros(n, n);
        let mut lost = vec![false; n];
        for k in 0..n {
            let direction = spectrum.eigenvectors.column(k);
            if is_told(k) {
                covariance += direction * direction.transpose() / spectrum.eigenvalues[k];
            } else {
                (lost.iter_mut().zip(direction.iter()))
                    .for_each(|(lost, part)| *lost |= part.abs() > PART);
            }
        }
        for i in 0..n {
            for j in 0..n {
                let both = size[i] * size[j];
                covariance[(i, j)] = match both > 0.0 {
                    true => covariance[(i, j)] / both,
                    false => 0.0,
                };
            }
        }
        let error = |i: usize| {
            let error = covariance[(i, i)].max(0.0).sqrt();
            (!lost[i] && size[i] > 0.0 && error.is_finite()).then_some(error)
        };
        Self {
            errors: (0..n).map(error).collect(),
            covariance,
        }
    }

    /// Correlation of the errors of two unknowns.
    pub(super) fn correlation(&self, i: usize, j: usize) -> f64 {
        let size = (self.covariance[(i, i)] * self.covariance[(j, j)]).sqrt();
        match size > 0.0 {
            true => (self.covariance[(i, j)] / size).clamp(-1.0, 1.0),
            false => 0.0,
        }
    }
}

fn scaled(information: &DMatrix<f64>, size: &[f64]) -> DMatrix<f64> {
    let n = size.len();
    DMatrix::from_fn(n, n, |i, j| match size[i] * size[j] {
        0.0 => 0.0,
        both => information[(i, j)] / both,
    })
}

/// ln det of the covariance of some unknowns, the others estimated as well; none where the maneuver does not tell all.
pub(super) fn ln_det_covariance(information: &DMatrix<f64>, of: &[usize]) -> Option<f64> {
    let n = information.nrows();
    let size: Vec<f64> = (0..n)
        .map(|i| information[(i, i)].max(0.0).sqrt())
        .collect();
    if of.is_empty() || size.contains(&0.0) {
        return None;
    }
    let inverse = Cholesky::new(scaled(information, &size))?.inverse();
    let among = inverse.select_rows(of).select_columns(of);
    let factor = Cholesky::new(among)?;
    let half: f64 = (0..of.len()).map(|i| factor.l_dirty()[(i, i)].ln()).sum();
    let scales: f64 = of.iter().map(|&place| size[place].ln()).sum();
    Some(2.0 * (half - scales)).filter(|value| value.is_finite())
}

/// What is told of some unknowns where the others are estimated as well: the Schur complement F_ss − F_so F_oo⁻¹ F_os.
pub(super) fn among(information: &DMatrix<f64>, some: &[usize]) -> DMatrix<f64> {
    let others: Vec<usize> = (0..information.nrows())
        .filter(|i| !some.contains(i))
        .collect();
    let of =
        |rows: &[usize], columns: &[usize]| information.select_rows(rows).select_columns(columns);
    let (own, cross) = (of(some, some), of(some, &others));
    if others.is_empty() {
        return own;
    }
    let inner = of(&others, &others);
    let inverse = Bounds::of(&inner).covariance;
    own - &cross * inverse * cross.transpose()
}
