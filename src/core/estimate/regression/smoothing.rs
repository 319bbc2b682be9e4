//! Smoothing and differentiation of a measured state by local polynomials, the window chosen by the data.
//!
//! Around each sample a cubic is fitted to its neighbours by least squares (Savitzky and Golay; here for any
//! spacing of samples): its value and slope at the sample are the smoothed state and its derivative. Wide
//! windows take away noise, narrow ones keep the motion: the width is that of least leave-one-out error, which
//! follows from the fit without fitting again (Cleveland; Craven and Wahba).

use multiversion::multiversion;

use super::local_fit::{Kernel, LocalFit};
use crate::estimate::linear::products::dot;
use crate::stop;

/// A state and its derivative, sample by sample.
pub(crate) struct Smoothed {
    pub value: Vec<f64>,
    pub slope: Vec<f64>,
    /// Root mean square of measured less smoothed: the size of the noise.
    pub noise: f64,
}

/// Half widths of the window, in samples, from which the best is chosen.
const HALF_WIDTHS: [usize; 9] = [2, 3, 4, 6, 8, 12, 16, 24, 32];

/// Samples at which the leave-one-out error is looked at: more tell no more.
const MOST_LOOKS: usize = 2_000;

/// Steps that differ by less than this share are the same: rounding of a time of a million samples leaves 1e-10.
const LARGEST_UNEVENNESS: f64 = 1e-9;

/// Smooths `values`, measured at `time`. Values that are not finite are left out and filled in.
pub(crate) fn smoothed(time: &[f64], values: &[f64]) -> Smoothed {
    Windows::new(time, half_width(time, &[values])).smoothed(values)
}

/// The half width that suits all of some series best: the product of their leave-one-out errors is least, so that
/// their sizes do not matter.
pub(crate) fn half_width(time: &[f64], series: &[&[f64]]) -> usize {
    let error = |half: usize| {
        let windows = Windows::new(time, half);
        let all = series.iter();
        all.map(|values| windows.left_out_error(values).ln())
            .sum::<f64>()
    };
    let widths = HALF_WIDTHS.iter().filter(|&&half| 2 * half < time.len());
    widths
        .map(|&half| (half, error(half)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(HALF_WIDTHS[0], |(half, _)| half)
}

/// Windows of a half width, in samples; at the ends they keep their width and lean inwards.
pub(crate) struct Windows<'t> {
    time: &'t [f64],
    half: usize,
    /// Where samples are evenly spaced, by the place of the sample in its window: what serves every such window.
    kernels: Option<Vec<Kernel>>,
}

impl<'t> Windows<'t> {
    pub(crate) fn new(time: &'t [f64], half: usize) -> Self {
        let mut windows = Self {
            time,
            half,
            kernels: None,
        };
        let width = 2 * half + 1;
        // else there is hardly a window like another
        if time.len() > width && is_even(time) {
            let at = |place: usize| {
                let fit = LocalFit::of(&time[..width], place, |_| true)?;
                Some(fit.kernel(&time[..width]))
            };
            windows.kernels = (0..width).map(at).collect();
        }
        windows
    }

    pub(crate) fn smoothed(&self, values: &[f64]) -> Smoothed {
        let shared = self.kernels.as_ref().map(|kernels| {
            let value = self.by_kernels(kernels, values, |kernel| &kernel.value);
            let slope = self.by_kernels(kernels, values, |kernel| &kernel.slope);
            (value, slope)
        });
        let mut result = Smoothed {
            value: Vec::with_capacity(values.len()),
            slope: Vec::with_capacity(values.len()),
            noise: 0.0,
        };
        for k in 0..values.len() {
            stop::check_sometimes(k);
            let shared = shared.as_ref().map(|(value, slope)| (value[k], slope[k]));
            // a missing value makes both none
            let shared = shared.filter(|(value, slope)| value.is_finite() && slope.is_finite());
            let (value, slope) = match shared.or_else(|| self.value_and_slope(values, k)) {
                Some(both) => both,
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

    /// Mean square of the leave-one-out errors.
    fn left_out_error(&self, values: &[f64]) -> f64 {
        let len = values.len();
        let looks = (0..len).step_by(len.div_ceil(MOST_LOOKS).max(1));
        let shared = self.kernels.as_ref().map(|kernels| {
            let smoothed = self.by_kernels(kernels, values, |kernel| &kernel.value);
            (kernels, smoothed)
        });
        let errors = looks.filter_map(|k| {
            let shared = shared.as_ref().and_then(|(kernels, smoothed)| {
                let leverage = kernels[k - self.ends(k, len).0].leverage;
                left_out(values[k], smoothed[k], leverage)
            });
            shared.or_else(|| self.left_out(values, k))
        });
        let (sum, count) = errors.fold((0.0, 0), |(sum, count), e| (sum + e * e, count + 1));
        if count > 0 {
            // an exact fit is no better than rounding
            f64::max(sum / f64::from(count), f64::MIN_POSITIVE)
        } else {
            f64::INFINITY
        }
    }

    /// The first and the last sample of the window around sample `k` of `len`.
    fn ends(&self, k: usize, len: usize) -> (usize, usize) {
        let first = k
            .saturating_sub(self.half)
            .min(len.saturating_sub(2 * self.half + 1));
        (first, (first + 2 * self.half).min(len - 1))
    }

    /// The weighted sum over the window of each sample.
    fn by_kernels(
        &self,
        kernels: &[Kernel],
        values: &[f64],
        weights: fn(&Kernel) -> &[f64],
    ) -> Vec<f64> {
        stop::check();
        let (len, half) = (values.len(), self.half);
        let mut result = vec![0.0; len];
        if let (Some(middle), true) = (kernels.get(half), len > 2 * half) {
            slide(weights(middle), values, &mut result[half..len - half]);
        }
        for k in (0..half.min(len)).chain(len.saturating_sub(half)..len) {
            let (first, last) = self.ends(k, len);
            if let Some(kernel) = kernels.get(k - first) {
                result[k] = dot(weights(kernel), &values[first..=last]);
            }
        }
        result
    }

    /// The smoothed value and the derivative at sample `k`.
    fn value_and_slope(&self, values: &[f64], k: usize) -> Option<(f64, f64)> {
        let fit = self.fit(values, k)?;
        Some(fit.value_and_slope(self.near(values, k)))
    }

    /// The error at sample `k`, had its own measurement not been used.
    fn left_out(&self, values: &[f64], k: usize) -> Option<f64> {
        if !values[k].is_finite() {
            return None;
        }
        let fit = self.fit(values, k)?;
        let (value, _) = fit.value_and_slope(self.near(values, k));
        left_out(values[k], value, fit.leverage())
    }

    fn near<'v>(
        &self,
        values: &'v [f64],
        k: usize,
    ) -> impl Iterator<Item = (f64, f64)> + use<'v, 't> {
        let (first, last) = self.ends(k, values.len());
        let time = self.time[first..=last].iter().copied();
        time.zip(values[first..=last].iter().copied())
    }

    /// For any spacing, and missing values.
    fn fit(&self, values: &[f64], k: usize) -> Option<LocalFit> {
        let (first, last) = self.ends(k, values.len());
        LocalFit::of(&self.time[first..=last], k - first, |j| {
            values[first + j].is_finite()
        })
    }
}

/// The error of a smoothed value, had what was measured not been used for it; none where either is missing.
fn left_out(measured: f64, smoothed: f64, leverage: f64) -> Option<f64> {
    Some((measured - smoothed) / (1.0 - leverage)).filter(|error| error.is_finite())
}

/// to_k = Σ_j weight_j value_(k + j), several side by side.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn slide(weights: &[f64], values: &[f64], to: &mut [f64]) {
    const SIDE_BY_SIDE: usize = 32;
    let mut first = 0;
    let (groups, rest) = to.as_chunks_mut::<SIDE_BY_SIDE>();
    for to in groups {
        let mut sums = [0.0; SIDE_BY_SIDE];
        for (weight, values) in weights.iter().zip(values[first..].windows(SIDE_BY_SIDE)) {
            for i in 0..SIDE_BY_SIDE {
                sums[i] = weight.mul_add(values[i], sums[i]);
            }
        }
        *to = sums;
        first += SIDE_BY_SIDE;
    }
    for (k, to) in rest.iter_mut().enumerate() {
        *to = dot(weights, &values[first + k..][..weights.len()]);
    }
}

/// Whether samples are evenly spaced, but for rounding.
fn is_even(time: &[f64]) -> bool {
    let steps = || time.windows(2).map(|pair| pair[1] - pair[0]);
    let Some(first) = steps().next() else {
        return false;
    };
    steps().all(|step| (step - first).abs() <= LARGEST_UNEVENNESS * first)
}

fn first_number(values: &[f64]) -> f64 {
    values
        .iter()
        .copied()
        .find(|v| v.is_finite())
        .unwrap_or(0.0)
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

    /// Sums of some sixty products, of numbers of size 1 with slopes of size 3: rounding leaves some 1e-13, of which a
    /// left-out sample at an end makes up to a hundred times as much.
    #[test]
    fn windows_that_are_alike_share_their_weights() {
        let time: Vec<f64> = (0..200).map(|k| f64::from(k) * 0.02).collect();
        let mut values: Vec<f64> = time.iter().map(|t| (3.0 * t).sin()).collect();
        values[90] = f64::NAN;
        for half in HALF_WIDTHS {
            let mut windows = Windows::new(&time, half);
            let shared = (windows.smoothed(&values), windows.left_out_error(&values));
            assert!(windows.kernels.take().is_some());
            let own = (windows.smoothed(&values), windows.left_out_error(&values));
            for k in 0..time.len() {
                assert!((shared.0.value[k] - own.0.value[k]).abs() < 1e-12, "{k}");
                assert!((shared.0.slope[k] - own.0.slope[k]).abs() < 1e-10, "{k}");
            }
            let difference = shared.1.sqrt() - own.1.sqrt();
            assert!(difference.abs() < 1e-11, "{difference:e}");
        }
        let jittered: Vec<f64> = time.iter().map(|t| t + 1e-4 * (70.0 * t).sin()).collect();
        assert!(Windows::new(&jittered, 3).kernels.is_none());
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
