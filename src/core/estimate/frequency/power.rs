//! How the power of residuals is spread over frequency.
//!
//! An average over neighbours, of residuals that were divided by what the power of each output does over the whole band: it grows
//! with ω² where a state that is measured with noise was differentiated. For periodogram ordinates of mean p = c₀ + c₂ ω² the
//! likelihood is Σ |e|²/p + ln p (Whittle 1953), found by least squares with weights 1/p². Of white residuals c₂ would be above zero
//! by chance half of the time, and the power at low frequencies told too small: it is taken only where it shows.

use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::stop;

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
            .map(|output| trend(omega, residuals, output, close))
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

    /// E(e eᴴ) at each frequency, one after the other: the sums of neighbours move along.
    pub(super) fn each(&self) -> impl Iterator<Item = DMatrix<Complex64>> + '_ {
        let count = self.scaled.len();
        let outputs = self.scaled.first().map_or(0, Vec::len);
        // at the edges of the band as many frequencies, on one side
        let width = (2 * self.side + 1).min(count);
        let mut sum = DMatrix::zeros(outputs, outputs);
        let (mut from, mut to) = (0, 0);
        (0..count).map(move |k| {
            let first = k.saturating_sub(self.side).min(count - width);
            while to < first + width {
                stop::check_sometimes(to);
                add(&mut sum, &self.scaled[to], 1.0);
                to += 1;
            }
            while from < first {
                add(&mut sum, &self.scaled[from], -1.0);
                from += 1;
            }
            let roots = &self.roots[k];
            let of = |i: usize, j: usize| sum[(i, j)] * (roots[i] * roots[j] / width as f64);
            DMatrix::from_fn(outputs, outputs, of)
        })
    }
}

/// Adds e eᴴ, or takes it off.
fn add(sum: &mut DMatrix<Complex64>, e: &[Complex64], sign: f64) {
    for (i, a) in e.iter().enumerate() {
        for (j, b) in e.iter().enumerate() {
            sum[(i, j)] += a * b.conj() * sign;
        }
    }
}

/// Twice the gain in the logarithm of the likelihood above which the power grows: two standard deviations.
const SHOWS: f64 = 4.0;

/// p = c₀ + c₂ ω² of an output, by frequency, or their mean; each frequency counts by the share `close`.
fn trend(omega: &[f64], residuals: &[Vec<Complex64>], output: usize, close: f64) -> Vec<f64> {
    let power: Vec<f64> = residuals.iter().map(|e| e[output].norm_sqr()).collect();
    let mean = power.iter().sum::<f64>() / power.len().max(1) as f64;
    let mut trend = vec![mean; power.len()];
    if mean == 0.0 {
        return trend;
    }
    for _ in 0..ROUNDS {
        stop::check();
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
    let flat = vec![mean; power.len()];
    let gain = likelihood(&flat, &power) - likelihood(&trend, &power);
    // not where the trend is no power
    if 2.0 * close * gain > SHOWS {
        trend
    } else {
        flat
    }
}

/// -ln L = Σ |e|²/p + ln p; NaN where a power is not above zero.
fn likelihood(trend: &[f64], power: &[f64]) -> f64 {
    let both = trend.iter().zip(power);
    let each = both.map(|(p, power)| match *p > 0.0 {
        true => power / p + p.ln(),
        false => f64::NAN,
    });
    each.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of white noise the power is the same everywhere, although the trend that fits it best may grow.
    #[test]
    fn a_power_that_does_not_grow_is_one_everywhere() {
        let omega: Vec<f64> = (1..=60).map(|k| f64::from(k) * 0.2).collect();
        let power_of = |seed: f64| {
            let size = |k: usize| {
                let uniform = ((k as f64 + 0.5) * 0.618_033_988_75 + seed).fract();
                -uniform.ln()
            };
            let residuals: Vec<Vec<Complex64>> = (0..omega.len())
                .map(|k| vec![Complex64::from(size(k).sqrt())])
                .collect();
            trend(&omega, &residuals, 0, 1.0)
        };
        for seed in 0..20 {
            let trend = power_of(f64::from(seed) * 0.05);
            assert!(trend.iter().all(|p| *p == trend[0]), "{seed}: {trend:?}");
        }
    }

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
        for (k, found) in power.each().enumerate() {
            let found = found[(0, 0)].re / truth(omega[k]);
            assert!((found - 1.0).abs() < 0.1, "{k}: {found}");
        }
        // and nothing is nothing
        let none = vec![vec![Complex64::ZERO]; 10];
        let power = Power::of(&omega[..10], &none, 1.0);
        assert!(power.each().all(|power| power[(0, 0)] == Complex64::ZERO));
    }

    /// Against the average over each frequency's neighbours, of two outputs that go together, few and many frequencies.
    #[test]
    fn sums_that_move_along_are_those_of_the_neighbours() {
        for count in [1, 3, 9, 40, 101] {
            let omega: Vec<f64> = (1..=count).map(f64::from).collect();
            let one = |k: usize| Complex64::from_polar(1.0 + (k % 7) as f64, 1.3 * k as f64);
            let residuals: Vec<Vec<Complex64>> = (0..omega.len())
                .map(|k| vec![one(k), one(k) * 0.5 + one(3 * k + 1)])
                .collect();
            let power = Power::of(&omega, &residuals, 1.0);
            let width = (2 * power.side + 1).min(omega.len());
            let all: Vec<_> = power.each().collect();
            assert_eq!(all.len(), omega.len());
            for (k, found) in all.iter().enumerate() {
                let first = k.saturating_sub(power.side).min(omega.len() - width);
                let near = &power.scaled[first..first + width];
                for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let sum: Complex64 = near.iter().map(|e| e[i] * e[j].conj()).sum();
                    let mean = sum / width as f64 * (power.roots[k][i] * power.roots[k][j]);
                    assert!((found[(i, j)] - mean).norm() < 1e-11, "{count}: {k}");
                }
            }
        }
    }
}
