//! Medians, percentiles and small least squares of samples that may be missing.

use crate::stop;
use nalgebra::{DMatrix, DVector};

/// The values that are numbers, sorted.
pub(super) fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    stop::check();
    let mut sorted: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// The value below which this share of sorted values lies.
pub(super) fn percentile(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    Some(sorted[(share * last as f64).round() as usize])
}

pub(super) fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    percentile(&sorted(values), 0.5)
}

/// A fit of y by columns, whose parts along constants and ramps are taken out of all of them in each window.
#[derive(Default)]
pub(super) struct Regression {
    columns: Vec<Vec<f64>>,
    y: Vec<f64>,
}

/// What a regression comes to.
pub(super) struct Fit {
    pub coefficients: Vec<f64>,
    /// Of the variation of y, the share that the columns explain.
    pub explained: f64,
}

impl Regression {
    /// Adds a window of samples: times, y, and the columns beside it. Samples without a value of any are left out.
    pub(super) fn add(&mut self, time: &[f64], y: &[f64], columns: &[Vec<f64>]) {
        let whole = |k: &usize| y[*k].is_finite() && columns.iter().all(|c| c[*k].is_finite());
        let rows: Vec<usize> = (0..y.len()).filter(whole).collect();
        if rows.len() < 20 {
            return;
        }
        let time: Vec<f64> = rows.iter().map(|&k| time[k]).collect();
        let pick = |column: &[f64]| {
            let picked: Vec<f64> = rows.iter().map(|&k| column[k]).collect();
            without_ramp(&time, picked)
        };
        self.y.extend(pick(y));
        self.columns.resize(columns.len(), Vec::new());
        for (all, column) in self.columns.iter_mut().zip(columns) {
            all.extend(pick(column));
        }
    }

    /// Fits with all columns but those left out; `None` where the columns are too few or too alike.
    pub(super) fn fit(&self, without: Option<usize>) -> Option<Fit> {
        let kept: Vec<&Vec<f64>> = (self.columns.iter().enumerate())
            .filter(|(place, _)| Some(*place) != without)
            .map(|(_, column)| column)
            .collect();
        let total: f64 = self.y.iter().map(|y| y * y).sum();
        if self.y.len() < 50 || total <= 0.0 {
            return None;
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        // columns of one size: the normal equations of a few smooth signals are well enough conditioned then
        let sizes: Vec<f64> = kept.iter().map(|c| dot(c, c).sqrt()).collect();
        if sizes.iter().any(|size| *size <= 0.0) {
            return None;
        }
        let normal = DMatrix::from_fn(kept.len(), kept.len(), |i, j| {
            dot(kept[i], kept[j]) / (sizes[i] * sizes[j])
        });
        let right = DVector::from_fn(kept.len(), |i, _| dot(kept[i], &self.y) / sizes[i]);
        let solution = match kept.is_empty() {
            true => right.clone(),
            false => normal.cholesky()?.solve(&right),
        };
        Some(Fit {
            explained: (solution.dot(&right) / total).clamp(0.0, 1.0),
            coefficients: solution
                .iter()
                .zip(&sizes)
                .map(|(x, size)| x / size)
                .collect(),
        })
    }
}

/// A series less its straight line of least squares.
fn without_ramp(time: &[f64], mut values: Vec<f64>) -> Vec<f64> {
    let count = values.len() as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
    let (middle, level) = (mean(time), mean(&values));
    let spread: f64 = time.iter().map(|t| (t - middle).powi(2)).sum();
    let along: f64 = time
        .iter()
        .zip(&values)
        .map(|(t, v)| (t - middle) * (v - level))
        .sum();
    let slope = if spread > 0.0 { along / spread } else { 0.0 };
    for (value, t) in values.iter_mut().zip(time) {
        *value -= level + slope * (t - middle);
    }
    values
}

/// The integral over time from the first sample, straight between samples that have a value.
pub(super) fn integral(time: &[f64], values: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut sum = 0.0;
    let mut before: Option<(f64, f64)> = None;
    let step = |k: usize| {
        let value = values(k);
        if !value.is_finite() {
            return f64::NAN;
        }
        if let Some((t, last)) = before {
            sum += (time[k] - t) * (value + last) / 2.0;
        }
        before = Some((time[k], value));
        sum
    };
    (0..time.len()).map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_regression_finds_what_was_put_in_beside_any_ramp() {
        let time: Vec<f64> = (0..200).map(|k| f64::from(k) * 0.1).collect();
        let a: Vec<f64> = time.iter().map(|t| (2.0 * t).sin()).collect();
        let b = integral(&time, |k| a[k]);
        let y: Vec<f64> = (0..200)
            .map(|k| 3.0 * a[k] - 0.5 * b[k] + 7.0 - 2.0 * time[k])
            .collect();
        let mut regression = Regression::default();
        regression.add(&time, &y, &[a, b]);
        let fit = regression.fit(None).unwrap();
        assert!(
            (fit.coefficients[0] - 3.0).abs() < 1e-9 && (fit.coefficients[1] + 0.5).abs() < 1e-9
        );
        assert!(fit.explained > 1.0 - 1e-9);
        assert!(regression.fit(Some(0)).unwrap().explained < 0.5);
    }

    #[test]
    fn percentiles_are_of_what_is_there() {
        let sorted = sorted([3.0, f64::NAN, 1.0, 2.0].into_iter());
        assert_eq!(percentile(&sorted, 0.5), Some(2.0));
        assert_eq!(percentile(&[], 0.5), None);
        assert_eq!(median([5.0].into_iter()), Some(5.0));
    }
}
