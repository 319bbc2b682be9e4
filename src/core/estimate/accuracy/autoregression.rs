//! The colour of a residual in few numbers: an autoregressive model of it.

/// e_k = Σ_m a_m e_(k−m) + w_k with white w: a spectrum without a window to choose, never negative, and the
/// same forwards and backwards in time.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Autoregression {
    /// a_1, a_2, ...; none where the residual is white.
    pub coefficients: Vec<f64>,
    /// Of w, in the unit of the autocovariances.
    pub variance: f64,
    /// Of e.
    power: f64,
    /// Autocorrelation at lag 1, as it was measured.
    pub lag_one: f64,
}

/// The most lags worth looking at: the customary 10 log10 N, and a small part of what there is.
pub(crate) fn most_lags(samples: usize) -> usize {
    let customary = 10.0 * (samples.max(1) as f64).log10();
    (customary as usize).min(samples / 8)
}

impl Autoregression {
    /// From autocovariances at lags 0, 1, ... (sums over `samples` divided by `samples`, so that the model is
    /// stable), by the Levinson-Durbin recursion. Among all orders, that of least Schwarz criterion
    /// N ln σ² + order ln N: it finds order 0 for white noise, nearly always.
    pub(crate) fn fit(autocovariance: &[f64], samples: usize) -> Self {
        let power = autocovariance.first().copied().unwrap_or(0.0);
        let n = samples as f64;
        let mut best = Self {
            coefficients: Vec::new(),
            variance: power,
            power,
            lag_one: 0.0,
        };
        if !(power > 0.0 && power.is_finite()) {
            return best;
        }
        best.lag_one = autocovariance.get(1).map_or(0.0, |lag_one| lag_one / power);
        let mut coefficients: Vec<f64> = Vec::new();
        let (mut variance, mut least) = (power, n * power.ln());
        for order in 1..autocovariance.len() {
            let predicted: f64 = (coefficients.iter().enumerate())
                .map(|(m, a)| a * autocovariance[order - 1 - m])
                .sum();
            let reflection = (autocovariance[order] - predicted) / variance;
            // out of this range only where samples are missing, or by rounding
            if reflection.is_nan() || reflection.abs() >= 1.0 {
                break;
            }
            let mirrored: Vec<f64> = coefficients.iter().rev().copied().collect();
            (coefficients.iter_mut().zip(mirrored)).for_each(|(a, b)| *a -= reflection * b);
            coefficients.push(reflection);
            variance *= 1.0 - reflection * reflection;
            let criterion = n * variance.ln() + order as f64 * n.ln();
            if criterion < least {
                least = criterion;
                best.coefficients.clone_from(&coefficients);
                best.variance = variance;
            }
        }
        best
    }

    /// How much of the number of samples counts for a mean: variance over spectral density at frequency 0.
    pub(crate) fn effective_share(&self) -> f64 {
        let gain = 1.0 - self.coefficients.iter().sum::<f64>();
        if self.variance > 0.0 {
            self.power * gain * gain / self.variance
        } else {
            1.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// γ_l = 0.8^l is AR(1) with a = 0.8, σ² = 1 - 0.64; for a mean, a sample counts (1 - 0.8)/(1 + 0.8).
    #[test]
    fn a_first_order_process_is_recognised() {
        let autocovariance: Vec<f64> = (0..20).map(|l| 0.8_f64.powi(l)).collect();
        let model = Autoregression::fit(&autocovariance, 500);
        assert_eq!(model.coefficients.len(), 1);
        assert!((model.coefficients[0] - 0.8).abs() < 1e-12);
        assert!((model.variance - 0.36).abs() < 1e-12);
        assert!((model.effective_share() - 1.0 / 9.0).abs() < 1e-12);
        assert!((model.lag_one - 0.8).abs() < 1e-12);
    }

    /// An oscillation takes two: γ of e_k = 1.2 e_(k-1) - 0.8 e_(k-2) + w by the Yule-Walker equations.
    #[test]
    fn a_second_order_process_is_recognised() {
        let mut autocovariance = vec![1.0, 1.2 / 1.8];
        for l in 2..20 {
            autocovariance.push(1.2 * autocovariance[l - 1] - 0.8 * autocovariance[l - 2]);
        }
        let model = Autoregression::fit(&autocovariance, 500);
        assert_eq!(model.coefficients.len(), 2);
        assert!((model.coefficients[0] - 1.2).abs() < 1e-12);
        assert!((model.coefficients[1] + 0.8).abs() < 1e-12);
    }

    #[test]
    fn white_noise_and_nothing_at_all_have_no_colour() {
        let white = Autoregression::fit(&[2.0, 0.05, -0.04, 0.03], 500);
        assert_eq!(
            (white.coefficients.len(), white.effective_share()),
            (0, 1.0)
        );
        for nothing in [&[][..], &[0.0, 0.0], &[f64::NAN, 0.0]] {
            let model = Autoregression::fit(nothing, 500);
            assert_eq!(
                (model.coefficients.len(), model.effective_share()),
                (0, 1.0)
            );
        }
    }
}
