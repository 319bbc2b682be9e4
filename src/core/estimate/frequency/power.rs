//! How the power of residuals is spread over frequency.
//!
//! An average over neighbours, of residuals that were divided by what the power of each output does over the whole band: it grows
//! with ω² where a state that is measured with noise was differentiated. For periodogram ordinates of mean p = c₀ + c₂ ω² the
//! likelihood is Σ |e|²/p + ln p (Whittle 1953), found by least squares with weights 1/p².

use nalgebra::DMatrix;
use num_complex::Complex64;

/// Frequencies at either side that count, at least and as a share of all.
const LEAST_SIDE: usize = 4;
const SIDE: f64 = 0.4;

/// Rounds of the weighted least squares.
const ROUNDS: usize = 8;

/// The residuals of one segment.
pub(super) struct Power {
    /// By frequency, then output: residuals over the root of `trends`.
    scaled: Vec<Vec<Complex64>>,
    /// By frequency, then output: √p.
    roots: Vec<Vec<f64>>,
    side: usize,
}

impl Power {
    /// By frequency, then output; `close` is how many of the frequencies are independent, as a share of all.
    pub(super) fn of(omega: &[f64], residuals: &[Vec<Complex64>], close: f64) -> Self {
        let outputs = residuals.first().map_or(0, Vec::len);
        let trends: Vec<Vec<f64>> = (0..outputs)
            .map(|output| trend(omega, residuals, output))
            .collect();
        let root = |k: usize| trends.iter().map(|trend| trend[k].sqrt()).collect();
        let roots: Vec<Vec<f64>> = (0..omega.len()).map(root).collect();
        let scaled = residuals.iter().zip(&roots).map(|(residuals, roots)| {
            let both = residuals.iter().zip(roots);
            both.map(|(e, root)| {
                if *root > 0.0 {
                    e / root
                } else {
                    Complex64::ZERO
                }
            })
            .collect()
        });
        Self {
            scaled: scaled.collect(),
            side: (LEAST_SIDE as f64 / close).max(SIDE * residuals.len() as f64) as usize,
            roots,
        }
    }

    /// E(e eᴴ) at a frequency.
    pub(super) fn at(&self, k: usize) -> DMatrix<Complex64> {
        // at the edges of the band as many frequencies, on one side
        let width = (2 * self.side + 1).min(self.scaled.len());
        let first = k.saturating_sub(self.side).min(self.scaled.len() - width);
        let roots = &self.roots[k];
        let mut sum = DMatrix::zeros(roots.len(), roots.len());
        for residual in &self.scaled[first..first + width] {
            for i in 0..roots.len() {
                for j in 0..roots.len() {
                    sum[(i, j)] += residual[i] * residual[j].conj() * (roots[i] * roots[j]);
                }
            }
        }
        sum / Complex64::from(width as f64)
    }
}

/// p = c₀ + c₂ ω² of an output, by frequency.
fn trend(omega: &[f64], residuals: &[Vec<Complex64>], output: usize) -> Vec<f64> {
    let power: Vec<f64> = residuals.iter().map(|e| e[output].norm_sqr()).collect();
    let mean = power.iter().sum::<f64>() / power.len().max(1) as f64;
    let mut trend = vec![mean; power.len()];
    if mean == 0.0 {
        return trend;
    }
    for _ in 0..ROUNDS {
        // sums of 1, ω² and ω⁴, and of the power by these, each with its weight
        let mut sums = [0.0; 5];
        for ((p, power), omega) in trend.iter().zip(&power).zip(omega) {
            let (weight, square) = (p.powi(-2), omega * omega);
            let own = [1.0, square, square * square, *power, square * power];
            sums.iter_mut()
                .zip(own)
                .for_each(|(sum, own)| *sum += weight * own);
        }
        let [one, square, fourth, level, slope] = sums;
        let determinant = one * fourth - square * square;
        let constant = (level * fourth - slope * square) / determinant;
        let growth = (slope * one - level * square) / determinant;
        let (constant, growth) = match (constant > 0.0, growth > 0.0) {
            (true, true) => (constant, growth),
            (false, true) => (0.0, slope / fourth),
            // also where all frequencies are one
            _ => (level / one, 0.0),
        };
        for (p, omega) in trend.iter_mut().zip(omega) {
            *p = constant + growth * omega * omega;
        }
    }
    if trend.iter().all(|p| p.is_finite() && *p > 0.0) {
        trend
    } else {
        vec![mean; power.len()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pseudo-random phases and sizes of a power that grows with ω².
    #[test]
    fn a_power_that_grows_is_followed() {
        let count = 400;
        let omega: Vec<f64> = (1..=count).map(|k| f64::from(k) * 0.05).collect();
        let truth = |omega: f64| 2.0 + 0.5 * omega * omega;
        let residual = |(k, &omega): (usize, &f64)| {
            // exponential ordinates, as those of a periodogram are
            let uniform = ((k as f64 + 0.5) * 0.618_033_988_75).fract();
            let size = (-uniform.ln() * truth(omega)).sqrt();
            vec![Complex64::from_polar(size, 7.1 * k as f64)]
        };
        let residuals: Vec<Vec<Complex64>> = omega.iter().enumerate().map(residual).collect();
        let power = Power::of(&omega, &residuals, 1.0);
        for k in [0, 50, 200, 399] {
            let found = power.at(k)[(0, 0)].re / truth(omega[k]);
            assert!((found - 1.0).abs() < 0.1, "{k}: {found}");
        }
        // and nothing is nothing
        let none = vec![vec![Complex64::ZERO]; 10];
        assert_eq!(
            Power::of(&omega[..10], &none, 1.0).at(3)[(0, 0)],
            Complex64::ZERO
        );
    }
}
