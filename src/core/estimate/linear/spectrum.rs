//! The spectrum of an information matrix: directions that the data see, its inverse over these, collinear sets.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Eigenvalues of the scaled information matrix below this count as zero: with unit diagonal, rounding of
/// the sums leaves about 1e-15.
const SMALLEST_EIGENVALUE: f64 = 1e-13;

/// Components of a null direction smaller than this (of 1) are rounding.
const SMALLEST_COMPONENT: f64 = 1e-3;

/// A symmetric matrix, scaled to unit diagonal and split into eigenvectors.
#[derive(Clone, Debug)]
pub(crate) struct Spectrum {
    /// 1/√diagonal; 0 for unknowns that nothing depends on.
    pub scale: DVector<f64>,
    pub values: DVector<f64>,
    pub vectors: DMatrix<f64>,
}

impl Spectrum {
    /// `None` where the decomposition fails: entries that are not finite, or no convergence.
    pub(crate) fn of(matrix: &DMatrix<f64>, diagonal: &DVector<f64>) -> Option<Self> {
        let scale = diagonal.map(|d| if d > 0.0 { d.sqrt().recip() } else { 0.0 });
        let scaled = scaled(matrix, &scale);
        if scaled.iter().any(|v| !v.is_finite()) {
            return None;
        }
        if scaled.is_empty() {
            return Some(Self {
                scale,
                values: DVector::zeros(0),
                vectors: scaled,
            });
        }
        let eigen = SymmetricEigen::try_new(scaled, f64::EPSILON, 10_000)?;
        Some(Self {
            scale,
            values: eigen.eigenvalues,
            vectors: eigen.eigenvectors,
        })
    }

    pub(crate) fn is_seen(&self, i: usize) -> bool {
        self.values[i] > SMALLEST_EIGENVALUE
    }

    /// (M + λ diag)⁻¹ v over the directions that are seen.
    pub(crate) fn solve(&self, v: &DVector<f64>, damping: f64) -> DVector<f64> {
        let scaled = v.component_mul(&self.scale);
        let mut components = self.vectors.tr_mul(&scaled);
        for i in 0..components.len() {
            components[i] = if self.is_seen(i) {
                components[i] / (self.values[i] + damping)
            } else {
                0.0
            };
        }
        (&self.vectors * components).component_mul(&self.scale)
    }

    /// M⁻¹ over the directions that are seen.
    pub(crate) fn inverse(&self) -> DMatrix<f64> {
        let n = self.values.len();
        let reciprocal = DVector::from_fn(n, |i, _| {
            if self.is_seen(i) {
                self.values[i].recip()
            } else {
                0.0
            }
        });
        let inverse =
            &self.vectors * DMatrix::from_diagonal(&reciprocal) * self.vectors.transpose();
        scaled(&inverse, &self.scale)
    }

    /// Sets of unknowns of which the data see only some combinations: members, and a direction in θ along
    /// which nothing changes.
    ///
    /// The null space is brought to row echelon form, so that each set has as few members as can be told.
    pub(crate) fn collinear(&self) -> Vec<Vec<(usize, f64)>> {
        let n = self.values.len();
        let unseen = (0..n)
            .filter(|&i| self.scale[i] == 0.0)
            .map(|i| vec![(i, 1.0)]);
        let null: Vec<usize> = (0..n)
            .filter(|&i| !self.is_seen(i))
            .filter(|&i| {
                (0..n)
                    .any(|k| self.scale[k] > 0.0 && self.vectors[(k, i)].abs() > SMALLEST_COMPONENT)
            })
            .collect();
        let mut rows: Vec<DVector<f64>> = null
            .iter()
            .map(|&i| self.vectors.column(i).into_owned())
            .collect();
        for row in &mut rows {
            // unknowns that nothing depends on are sets of their own
            (0..n)
                .filter(|&k| self.scale[k] == 0.0)
                .for_each(|k| row[k] = 0.0);
        }
        echelon(&mut rows);
        let sets = rows.into_iter().filter_map(|row| {
            let direction = row.component_mul(&self.scale);
            let largest = row.amax();
            let members: Vec<(usize, f64)> = (0..n)
                .filter(|&k| row[k].abs() > SMALLEST_COMPONENT * largest)
                .map(|k| (k, direction[k]))
                .collect();
            (!members.is_empty() && largest > 0.0).then_some(members)
        });
        unseen.chain(sets).collect()
    }
}

/// Row and column i times `scale[i]`.
pub(crate) fn scaled(matrix: &DMatrix<f64>, scale: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
        scale[i] * matrix[(i, j)] * scale[j]
    })
}

/// Reduced row echelon form with complete pivoting.
fn echelon(rows: &mut [DVector<f64>]) {
    for done in 0..rows.len() {
        let largest = (done..rows.len())
            .flat_map(|r| (0..rows[r].len()).map(move |c| (r, c)))
            .max_by(|&(r, c), &(s, d)| rows[r][c].abs().total_cmp(&rows[s][d].abs()));
        let Some((row, column)) = largest.filter(|&(r, c)| rows[r][c].abs() > 1e-9) else {
            return;
        };
        rows.swap(done, row);
        let pivot = rows[done].clone() / rows[done][column];
        for (r, other) in rows.iter_mut().enumerate() {
            if r != done {
                let factor = other[column];
                *other -= &pivot * factor;
            }
        }
        rows[done] = pivot;
    }
}
