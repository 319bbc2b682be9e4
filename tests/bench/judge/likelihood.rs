//! Likelihood of residuals whose colour is known, which only the judge does.

use trimtab_core::estimate::TimeHistory;

use crate::noise::Noise;

/// Residuals by output, then flight, SI.
pub(crate) type Residuals = Vec<Vec<Vec<f64>>>;

pub(crate) fn of_histories(histories: &[TimeHistory]) -> Residuals {
    let outputs = histories.first().map_or(0, |h| h.outputs.len());
    (0..outputs)
        .map(|i| {
            histories
                .iter()
                .map(|h| h.outputs[i].residual.to_vec())
                .collect()
        })
        .collect()
}

/// By output: what noise of these colours is made of, all flights in a row.
pub(crate) fn innovations(residuals: &Residuals, noises: &[Noise]) -> Vec<Vec<f64>> {
    let of = |(flights, noise): (&Vec<Vec<f64>>, &Noise)| {
        flights.iter().flat_map(|e| noise.whitened(e)).collect()
    };
    residuals.iter().zip(noises).map(of).collect()
}

/// Σ w² over whitened residuals, in units of the noise's variance; `deviations` are those of the noise, SI.
pub(crate) fn squares(residuals: &Residuals, noises: &[Noise], deviations: &[f64]) -> f64 {
    let of = |(white, deviation): (&Vec<f64>, &f64)| {
        white.iter().map(|w| (w / deviation).powi(2)).sum::<f64>()
    };
    innovations(residuals, noises)
        .iter()
        .zip(deviations)
        .map(of)
        .sum()
}

/// ln L with the variance of each output estimated, but for constants.
pub(crate) fn ln_likelihood(residuals: &Residuals, noises: &[Noise]) -> f64 {
    let of = |white: &Vec<f64>| {
        let n = white.len() as f64;
        -0.5 * n * (white.iter().map(|w| w * w).sum::<f64>() / n).ln()
    };
    innovations(residuals, noises).iter().map(of).sum()
}

/// ln L of residuals under the best autoregression of each output, less what its order costs (Schwarz).
pub(crate) fn ln_likelihood_of_best_colour(residuals: &Residuals) -> f64 {
    residuals.iter().map(|flights| best_colour(flights)).sum()
}

fn best_colour(flights: &[Vec<f64>]) -> f64 {
    const MOST_ORDER: usize = 6;
    let n: usize = flights.iter().map(Vec::len).sum();
    let covariance = |lag: usize| {
        let of =
            |e: &Vec<f64>| -> f64 { e.iter().zip(e.iter().skip(lag)).map(|(a, b)| a * b).sum() };
        flights.iter().map(of).sum::<f64>() / n as f64
    };
    let c: Vec<f64> = (0..=MOST_ORDER).map(covariance).collect();
    // Levinson and Durbin
    let mut variance = c[0];
    let mut coefficients: Vec<f64> = Vec::new();
    let mut best = f64::NEG_INFINITY;
    for order in 0..=MOST_ORDER {
        let ln = -0.5 * n as f64 * variance.ln() - 0.5 * order as f64 * (n as f64).ln();
        best = best.max(ln);
        if order == MOST_ORDER {
            break;
        }
        let seen: f64 = coefficients
            .iter()
            .enumerate()
            .map(|(m, a)| a * c[order - m])
            .sum();
        let reflection = (c[order + 1] - seen) / variance;
        let mirrored: Vec<f64> = coefficients.iter().rev().copied().collect();
        coefficients
            .iter_mut()
            .zip(mirrored)
            .for_each(|(a, b)| *a -= reflection * b);
        coefficients.push(reflection);
        variance *= 1.0 - reflection * reflection;
    }
    best
}
