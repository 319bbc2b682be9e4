//! Noise as the error bounds take it to be: white with the covariance R, or with the colour of the residuals.

use nalgebra::{DMatrix, DVector};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::fitted::Fitted;
use super::repeated::Scatter;
use crate::estimate::accuracy::coloured_residuals::root;
use crate::estimate::options::error_bounds::ErrorBoundsKind;
use crate::stop;

/// Samples before the first, so that a filter has forgotten where it began.
const BEFORE: usize = 1000;

pub(super) struct Noise {
    /// By output: a_1, a_2, ...; none where it is white.
    coefficients: Vec<Vec<f64>>,
    /// A root of the covariance of the innovations.
    root: DMatrix<f64>,
}

impl Noise {
    /// `covariance` is R.
    pub(super) fn new(fitted: &Fitted, kind: ErrorBoundsKind, covariance: &DMatrix<f64>) -> Self {
        match kind {
            ErrorBoundsKind::Conventional => Self {
                coefficients: vec![Vec::new(); covariance.nrows()],
                root: root(covariance.clone()),
            },
            ErrorBoundsKind::Corrected => Self {
                coefficients: (fitted.colour.models.iter())
                    .map(|model| model.coefficients.clone())
                    .collect(),
                root: fitted.colour.root.clone(),
            },
        }
    }

    fn is_white(&self) -> bool {
        self.coefficients.iter().all(Vec::is_empty)
    }
}

impl Scatter for Noise {
    fn add(&self, random: &mut ChaCha8Rng, _: usize, outputs: &mut [Vec<f64>]) {
        let samples = outputs.first().map_or(0, Vec::len);
        let before = if self.is_white() { 0 } else { BEFORE };
        let mut noise = vec![vec![0.0; before + samples]; outputs.len()];
        let mut normal = DVector::zeros(outputs.len());
        for k in 0..before + samples {
            stop::check_sometimes(k);
            normal
                .iter_mut()
                .for_each(|to| *to = StandardNormal.sample(random));
            let innovation = &self.root * &normal;
            for (output, (noise, coefficients)) in
                noise.iter_mut().zip(&self.coefficients).enumerate()
            {
                let (earlier, now) = noise.split_at_mut(k);
                let latest_first = coefficients.iter().zip(earlier.iter().rev());
                now[0] = innovation[output] + latest_first.map(|(a, e)| a * e).sum::<f64>();
            }
        }
        for (output, noise) in outputs.iter_mut().zip(&noise) {
            let last = &noise[before..];
            (output.iter_mut().zip(last)).for_each(|(z, e)| *z += e);
        }
    }
}
