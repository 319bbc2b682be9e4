//! What is supposed of a force before the data: it is about zero, and smooth.
//!
//! The sizes c of neighbouring shapes are normal with the covariance λ² K, K⁻¹ ~ I + τ⁴ D'D where D are second differences:
//! what is slower than about τ shapes is all that there is. How large λ and how long τ are is asked of the data, by the
//! marginal likelihood.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::normal::Normal;

/// Lengths τ, in shapes.
pub(super) const LENGTHS: [f64; 5] = [0.5, 1.0, 2.0, 4.0, 8.0];

/// The law of the sizes for one τ, λ = 1.
pub(super) struct Smoothness {
    /// K⁻¹
    precision: DMatrix<f64>,
    ln_determinant: f64,
}

impl Smoothness {
    /// Of flights with so many shapes each; K is 1 on average along its diagonal.
    fn new(counts: &[usize], length: f64) -> Option<Self> {
        let all: usize = counts.iter().sum();
        let mut precision = DMatrix::identity(all, all);
        let mut first = 0;
        for &count in counts {
            for middle in first + 1..(first + count).saturating_sub(1) {
                let difference = [(middle - 1, 1.0), (middle, -2.0), (middle + 1, 1.0)];
                for (i, a) in difference {
                    for (j, b) in difference {
                        precision[(i, j)] += length.powi(4) * a * b;
                    }
                }
            }
            first += count;
        }
        let variance = Cholesky::new(precision.clone())?.inverse().trace() / all.max(1) as f64;
        precision *= variance;
        let ln_determinant = ln_determinant(&Cholesky::new(precision.clone())?);
        Some(Self {
            precision,
            ln_determinant,
        })
    }

    /// For each of [`LENGTHS`].
    pub(super) fn all(counts: &[usize]) -> Option<Vec<Self>> {
        let of = |&length: &f64| Self::new(counts, length);
        LENGTHS.iter().map(of).collect()
    }
}

fn ln_determinant(cholesky: &Cholesky<f64, Dyn>) -> f64 {
    let diagonal = cholesky.l_dirty().diagonal();
    2.0 * diagonal.iter().map(|value| value.ln()).sum::<f64>()
}

/// A force's sizes as the data leave them, for one λ and τ.
#[derive(Clone, Debug)]
pub(super) struct Posterior {
    /// ln L with the sizes integrated out and the scale of the noise at its best, but for the whitening.
    pub ln_likelihood: f64,
    /// Most likely, and on average.
    pub sizes: DVector<f64>,
    /// The noise's standard deviation in the metric.
    pub noise: f64,
    /// Of G + K⁻¹/λ².
    factor: Cholesky<f64, Dyn>,
    /// tr(G (G + K⁻¹/λ²)⁻¹)
    pub freedom: f64,
}

impl Posterior {
    fn new(
        (clear, samples): (f64, f64),
        normal: &Normal,
        smoothness: &Smoothness,
        ln_variance: f64,
    ) -> Option<Self> {
        let count = normal.moment.len();
        let weight = (-ln_variance).exp();
        let factor = Cholesky::new(&normal.gram + &smoothness.precision * weight)?;
        let sizes = factor.solve(&normal.moment);
        let left = (clear - normal.moment.dot(&sizes)).max(1e-12 * clear);
        let gain = ln_determinant(&factor) + count as f64 * ln_variance - smoothness.ln_determinant;
        let ln_likelihood = -0.5 * (samples * ((left / samples).ln() + 1.0) + gain);
        ln_likelihood.is_finite().then_some(Self {
            ln_likelihood,
            sizes,
            noise: (left / samples).sqrt(),
            factor,
            freedom: f64::NAN,
        })
    }

    /// At the likeliest λ and τ. `None` where something is not a number.
    pub(super) fn likeliest(
        (clear, samples): (f64, f64),
        normal: &Normal,
        smoothness: &[Smoothness],
    ) -> Option<Self> {
        let count = normal.moment.len().max(1) as f64;
        // the variance at which a shape on average is as large as its error
        let unit = -(normal.gram.trace() / count).max(f64::MIN_POSITIVE).ln();
        let at = |length: usize, decades: f64| {
            let variance = unit + decades * std::f64::consts::LN_10;
            Self::new((clear, samples), normal, &smoothness[length], variance)
        };
        let mut best: Option<(Self, usize, f64)> = None;
        let keep = |best: &mut Option<(Self, usize, f64)>, length: usize, decades: f64| {
            if let Some(found) = at(length, decades)
                && best
                    .as_ref()
                    .is_none_or(|(b, ..)| found.ln_likelihood > b.ln_likelihood)
            {
                *best = Some((found, length, decades));
                return true;
            }
            false
        };
        for length in [1, 3] {
            for decades in [-2.0, 0.0, 2.0, 4.0] {
                keep(&mut best, length, decades);
            }
        }
        for step in [1.0, 0.5, 0.25] {
            let (_, mut length, mut decades) = best.as_ref().map(|b| (0, b.1, b.2))?;
            loop {
                let moves = [
                    (0, step),
                    (0, -step),
                    (1, 0.0),
                    (-1, 0.0),
                    (1, step),
                    (-1, -step),
                ];
                let moved = moves.into_iter().any(|(longer, more)| {
                    let length = length as isize + longer;
                    let decades = decades + more;
                    (0..LENGTHS.len() as isize).contains(&length)
                        && MOST_DECADES.contains(&decades)
                        && keep(&mut best, length as usize, decades)
                });
                if !moved {
                    break;
                }
                (length, decades) = best.as_ref().map(|b| (b.1, b.2))?;
            }
        }
        let (mut found, ..) = best?;
        found.freedom = found.factor.solve(&normal.gram).trace();
        Some(found)
    }

    /// A draw of the sizes about their average, from one of independent, standard normal numbers.
    pub(super) fn draw(&self, mut numbers: DVector<f64>) -> DVector<f64> {
        self.factor
            .l_dirty()
            .tr_solve_lower_triangular_mut(&mut numbers);
        numbers * self.noise
    }

    /// Covariance of the sizes.
    pub(super) fn covariance(&self) -> DMatrix<f64> {
        self.factor.inverse() * self.noise.powi(2)
    }
}

/// Variances of a force, in powers of ten of the least that can be seen.
const MOST_DECADES: std::ops::RangeInclusive<f64> = -4.0..=8.0;
