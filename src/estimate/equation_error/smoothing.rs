//! Smoothing and differentiation of a measured state by local polynomials, the window chosen by the data.
//!
//! Around each sample a cubic is fitted to its neighbours by least squares (Savitzky and Golay; here for any
//! spacing of samples): its value and slope at the sample are the smoothed state and its derivative. Wide
//! windows take away noise, narrow ones keep the motion: the width is that of least leave-one-out error, which
//! follows from the fit without fitting again (Cleveland; Craven and Wahba).

use nalgebra::{SMatrix, SVector};

/// A state and its derivative, sample by sample.
pub(in crate::estimate) struct Smoothed {
    pub value: Vec<f64>,
    pub slope: Vec<f64>,
    /// Root mean square of measured less smoothed: the size of the noise.
    pub noise: f64,
}

const ORDER: usize = 4;

/// Half widths of the window, in samples, from which the best is chosen.
const HALF_WIDTHS: [usize; 9] = [2, 3, 4, 6, 8, 12, 16, 24, 32];

/// Samples at which the leave-one-out error is looked at: more tell no more.
const MOST_LOOKS: usize = 2_000;

/// Smooths `values`, measured at `time`. Values that are no numbers are left out and filled in.
pub(in crate::estimate) fn smoothed(time: &[f64], values: &[f64]) -> Smoothed {
    smoothed_over(time, values, half_width(time, &[values]))
}

/// The half width that suits all of some series best: the product of their leave-one-out errors is least, so that
/// their sizes do not matter.
pub(super) fn half_width(time: &[f64], series: &[&[f64]]) -> usize {
    let error = |half: usize| {
        let all = series.iter();
        all.map(|values| left_out_error(time, values, half).ln())
            .sum::<f64>()
    };
    let widths = HALF_WIDTHS.iter().filter(|&&half| 2 * half < time.len());
    widths
        .map(|&half| (half, error(half)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(HALF_WIDTHS[0], |(half, _)| half)
}

/// Mean square of the leave-one-out errors.
fn left_out_error(time: &[f64], values: &[f64], half: usize) -> f64 {
    let looks = (0..values.len()).step_by(values.len().div_ceil(MOST_LOOKS).max(1));
    let errors = looks.filter_map(|k| local(time, values, k, half)?.left_out(values[k]));
    let (sum, count) = errors.fold((0.0, 0), |(sum, count), e| (sum + e * e, count + 1));
    if count > 0 {
        // an exact fit is no better than rounding
        f64::max(sum / f64::from(count), f64::MIN_POSITIVE)
    } else {
        f64::INFINITY
    }
}

/// Smooths with windows of a half width, in samples.
pub(super) fn smoothed_over(time: &[f64], values: &[f64], half: usize) -> Smoothed {
    let mut result = Smoothed {
        value: Vec::with_capacity(values.len()),
        slope: Vec::with_capacity(values.len()),
        noise: 0.0,
    };
    for k in 0..values.len() {
        let (value, slope) = match local(time, values, k, half) {
            Some(fit) => (fit.value, fit.slope),
            // too few neighbours for a polynomial: a long hole, or a recording of a few samples
            None => (
                result
                    .value
                    .last()
                    .copied()
                    .unwrap_or_else(|| first_number(values)),
                0.0,
            ),
        };
        result.value.push(value);
        result.slope.push(slope);
    }
    let squares = values
        .iter()
        .zip(&result.value)
        .map(|(z, x)| (z - x) * (z - x));
    let (sum, count) = squares
        .filter(|square| square.is_finite())
        .fold((0.0, 0_usize), |(sum, count), square| {
            (sum + square, count + 1)
        });
    result.noise = (sum / count.max(1) as f64).sqrt();
    result
}

fn first_number(values: &[f64]) -> f64 {
    values
        .iter()
        .copied()
        .find(|v| v.is_finite())
        .unwrap_or(0.0)
}

/// The local polynomial at one sample.
struct Local {
    value: f64,
    slope: f64,
    /// What the sample's own measurement counts in `value`.
    leverage: f64,
}

impl Local {
    /// The error at the sample, had its own measurement not been used.
    fn left_out(&self, measured: f64) -> Option<f64> {
        let error = (measured - self.value) / (1.0 - self.leverage);
        error.is_finite().then_some(error)
    }
}

/// Fits the neighbours of sample `k`; at the ends the window keeps its width and leans inwards.
fn local(time: &[f64], values: &[f64], k: usize, half: usize) -> Option<Local> {
    let first = k
        .saturating_sub(half)
        .min(values.len().saturating_sub(2 * half + 1));
    let last = (first + 2 * half).min(values.len() - 1);
    let width = (time[last] - time[first]).max(f64::MIN_POSITIVE);
    // the normal matrix of a polynomial has Σ s^(i + j) at (i, j)
    let mut sums = [0.0; 2 * ORDER - 1];
    let mut right = SVector::<f64, ORDER>::zeros();
    let mut count = 0;
    for j in (first..=last).filter(|&j| values[j].is_finite()) {
        // scaled to the window, so that powers stay of one size
        let s = 2.0 * (time[j] - time[k]) / width;
        let mut power = 1.0;
        for (i, sum) in sums.iter_mut().enumerate() {
            *sum += power;
            if i < ORDER {
                right[i] += power * values[j];
            }
            power *= s;
        }
        count += 1;
    }
    if count < ORDER {
        return None;
    }
    let normal = SMatrix::<f64, ORDER, ORDER>::from_fn(|i, j| sums[i + j]);
    let inverse = normal.cholesky()?.inverse();
    let fit = inverse * right;
    Some(Local {
        value: fit[0],
        slope: fit[1] * 2.0 / width,
        leverage: inverse[(0, 0)],
    })
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    #[test]
    fn a_cubic_is_reproduced_with_its_derivative() {
        let time: Vec<f64> = (0..40)
            .map(|k| f64::from(k) * 0.1 + f64::from(k % 3) * 0.01)
            .collect();
        let cubic = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t - 0.2 * t * t * t;
        let values: Vec<f64> = time.iter().map(|&t| cubic(t)).collect();
        let smooth = smoothed(&time, &values);
        for (k, &t) in time.iter().enumerate() {
            // the normal equations of a cubic over a window lose some digits
            assert!((smooth.value[k] - cubic(t)).abs() < 1e-9);
            assert!(
                (smooth.slope[k] - (-2.0 + t - 0.6 * t * t)).abs() < 1e-8,
                "{k}"
            );
        }
    }

    #[test]
    fn noise_widens_the_window_and_a_missing_value_is_filled_in() {
        let time: Vec<f64> = (0..400).map(|k| f64::from(k) * 0.02).collect();
        // white: what is correlated from sample to sample looks like motion, and narrows the window
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut scatter = || random.random_range(-0.05..0.05);
        let mut values: Vec<f64> = time.iter().map(|t| t.sin() + scatter()).collect();
        values[100] = f64::NAN;
        let smooth = smoothed(&time, &values);
        // differences of neighbours err by 0.05/0.02, about 2; a window of 65 samples by some hundredths
        let error = |k: usize| (smooth.slope[k] - time[k].cos()).abs();
        let mean = (32..368).map(error).sum::<f64>() / 336.0;
        assert!(mean < 0.1, "{mean}");
        assert!((smooth.value[100] - time[100].sin()).abs() < 0.05);
        // the scatter is uniform in ±0.05: its deviation is 0.05/√3
        assert!((0.02..0.04).contains(&smooth.noise), "{}", smooth.noise);
    }
}
