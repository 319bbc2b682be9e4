//! A cubic through the neighbours of a sample, by least squares: what of it depends on their times alone.

use nalgebra::{SMatrix, SVector};

const ORDER: usize = 4;

/// The normal equations of a window, solved but for what was measured in it.
pub(crate) struct LocalFit {
    /// Time of the sample that the polynomial is about, s.
    at: f64,
    /// Of the window, s.
    width: f64,
    inverse: SMatrix<f64, ORDER, ORDER>,
}

impl LocalFit {
    /// About the sample at `place` of a window; `counts` says which of its samples do. `None` where these are too few.
    pub(crate) fn of(time: &[f64], place: usize, counts: impl Fn(usize) -> bool) -> Option<Self> {
        let at = time[place];
        let width = (time[time.len() - 1] - time[0]).max(f64::MIN_POSITIVE);
        // the normal matrix of a polynomial has Σ s^(i + j) at (i, j)
        let mut sums = [0.0; 2 * ORDER - 1];
        let mut count = 0;
        for &t in (0..time.len()).filter(|&j| counts(j)).map(|j| &time[j]) {
            let s = scaled(t, at, width);
            let mut power = 1.0;
            for sum in &mut sums {
                *sum += power;
                power *= s;
            }
            count += 1;
        }
        if count < ORDER {
            return None;
        }
        let normal = SMatrix::<f64, ORDER, ORDER>::from_fn(|i, j| sums[i + j]);
        Some(Self {
            at,
            width,
            inverse: normal.cholesky()?.inverse(),
        })
    }

    /// Value and slope of the polynomial at the sample, from times and values of those that count; values that are no
    /// numbers do not.
    pub(crate) fn value_and_slope(&self, near: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
        let mut right = SVector::<f64, ORDER>::zeros();
        for (t, value) in near.filter(|(_, value)| value.is_finite()) {
            right += self.powers(t) * value;
        }
        let fit = self.inverse * right;
        (fit[0], fit[1] * self.per_second())
    }

    /// The weight of the sample's own measurement in the value.
    pub(crate) fn leverage(&self) -> f64 {
        self.inverse[(0, 0)]
    }

    /// The weight of each measurement of the window, if all count.
    pub(crate) fn kernel(&self, time: &[f64]) -> Kernel {
        let scaled: Vec<f64> = (time.iter())
            .map(|&t| scaled(t, self.at, self.width))
            .collect();
        let weights = |row: usize, factor: f64| {
            let row = self.inverse.row(row) * factor;
            let [one, first, second, third] = [row[0], row[1], row[2], row[3]];
            let weight = |&s: &f64| one + first * s + second * (s * s) + third * (s * s * s);
            scaled.iter().map(weight).collect()
        };
        Kernel {
            value: weights(0, 1.0),
            slope: weights(1, self.per_second()),
            leverage: self.leverage(),
        }
    }

    /// s⁰, s¹, ...
    #[inline]
    fn powers(&self, t: f64) -> SVector<f64, ORDER> {
        let s = scaled(t, self.at, self.width);
        SVector::from_column_slice(&[1.0, s, s * s, s * s * s])
    }

    /// ds/dt
    fn per_second(&self) -> f64 {
        2.0 / self.width
    }
}

/// Scaled to the window, so that powers stay of one size.
#[inline]
fn scaled(t: f64, at: f64, width: f64) -> f64 {
    2.0 * (t - at) / width
}

/// Weights of the measurements in a window: their sums are the smoothed value and the derivative (Savitzky and Golay,
/// Anal. Chem. 36, 1964).
pub(crate) struct Kernel {
    pub value: Vec<f64>,
    pub slope: Vec<f64>,
    /// The weight of the sample's own measurement in `value`.
    pub leverage: f64,
}
