//! Single samples that are no measurements: spikes, and values that are stuck.
//!
//! A spike of size ω at sample k stands in the innovations w of the residual as ω π, π = (1, −a₁, −a₂, ...) with the
//! coefficients of the residual's autoregression: λ_k = Σ π_j w_(k+j)/√Σ π_j² is normal where there is none (Chang,
//! Tiao and Chen, Technometrics 30, 1988). Whether there are any is asked of all λ at once: of a contaminated normal
//! distribution against the normal one.

use super::colour::Autoregression;
use crate::stop;

/// Deviation of the contaminating distribution, in those of the noise.
const WIDE: f64 = 8.0;

/// Twice the gain of ln L by which contamination is there at all.
const CONTAMINATED: f64 = 25.0;

/// A sample is taken out where it is likelier a spike than not, and never below so many deviations.
const LEAST: f64 = 4.0;

/// Samples on either side by which roughness is judged: in a stall or in rough air it is rougher than elsewhere.
const AROUND: usize = 25;

/// Samples on either side that make the neighbourhood.
const SIDE: usize = 4;

/// A value that stays the same to the last digit for so many samples, while the model moves, is stuck.
const STUCK: usize = 6;

/// How far, in robust deviations, what was stuck leaps when it comes loose.
const LOOSE: f64 = 6.0;

/// One sample, and how far it is off in deviations of the noise.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Spike {
    pub at: usize,
    pub deviations: f64,
}

/// The spikes and stuck samples of one output along one flight; `measured` less `residual` is the model.
pub(super) fn spikes(residual: &[f64], measured: &[f64]) -> Vec<Spike> {
    let mut found = single(residual, measured);
    let known: Vec<usize> = found.iter().map(|spike| spike.at).collect();
    let stuck = stuck(residual, measured);
    found.extend(stuck.into_iter().filter(|spike| !known.contains(&spike.at)));
    found
}

fn single(residual: &[f64], measured: &[f64]) -> Vec<Spike> {
    let colour = Autoregression::of_best_order(&[&without_far(residual)]);
    let mut left = residual.to_vec();
    let mut found: Vec<Spike> = Vec::new();
    // the largest first: each hides smaller ones beside it
    loop {
        let (lambda, sizes) = standardised(&colour, &left);
        let fraction = contamination(&lambda, found.len());
        let Some(fraction) = fraction else { break };
        let next = (0..lambda.len())
            .filter(|&k| is_likelier(lambda[k].abs(), fraction))
            .filter(|&k| stands_alone(k, sizes[k], residual, measured, &lambda))
            .filter(|k| !found.iter().any(|spike| spike.at == *k))
            .max_by(|&a, &b| lambda[a].abs().total_cmp(&lambda[b].abs()));
        let Some(at) = next else { break };
        found.push(Spike {
            at,
            deviations: lambda[at],
        });
        left[at] -= sizes[at];
        if found.len() * 10 > residual.len() {
            break;
        }
    }
    found
}

/// The series with what is far from its neighbourhood put in its middle, for the colour to be that of the noise.
fn without_far(series: &[f64]) -> Vec<f64> {
    let middles: Vec<f64> = (0..series.len()).map(|k| middle(series, k)).collect();
    let off: Vec<f64> = (series.iter().zip(&middles)).map(|(e, m)| e - m).collect();
    let scale = robust_deviation(&off);
    (series.iter().zip(&middles).zip(&off))
        .map(|((e, m), off)| if off.abs() > LEAST * scale { *m } else { *e })
        .collect()
}

/// λ by sample, and the size of the spike that it speaks of. It is measured by the spread of λ itself, around the sample
/// and in the whole: where the residual is no autoregression its innovations are not white.
fn standardised(colour: &Autoregression, series: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let mut innovations = vec![0.0; series.len()];
    colour.whiten(series, series, &mut innovations);
    let pattern: Vec<f64> = std::iter::once(1.0)
        .chain(colour.coefficients().iter().map(|a| -a))
        .collect();
    let deviation = colour.deviation();
    let of = |k: usize| {
        stop::check_sometimes(k);
        if !series[k].is_finite() {
            return (f64::NAN, 0.0);
        }
        let ahead = innovations[k..].iter().zip(&pattern);
        let (product, square) = ahead.fold((0.0, 0.0), |(product, square), (w, p)| {
            (product + w * p, square + p * p)
        });
        (product / square.sqrt(), deviation * product / square)
    };
    let (raw, sizes): (Vec<f64>, Vec<f64>) = (0..series.len()).map(of).unzip();
    let whole = robust_deviation(&raw).max(f64::MIN_POSITIVE);
    let lambda = (0..raw.len()).map(|k| {
        stop::check_sometimes(k);
        let around = k.saturating_sub(AROUND)..(k + AROUND + 1).min(raw.len());
        let lambda = raw[k] / robust_deviation(&raw[around]).max(whole);
        if lambda.is_finite() { lambda } else { 0.0 }
    });
    (lambda.collect(), sizes)
}

/// The share of samples that are contaminated, where that is likelier than none at all.
fn contamination(lambda: &[f64], found: usize) -> Option<f64> {
    let normal = |l: f64| (-0.5 * l * l).exp();
    let wide = |l: f64| (-0.5 * (l / WIDE).powi(2)).exp() / WIDE;
    let count = lambda.len().max(1) as f64;
    let mut share = 0.01;
    for _ in 0..20 {
        stop::check();
        let contaminated: f64 = lambda
            .iter()
            .map(|&l| share * wide(l) / ((1.0 - share) * normal(l) + share * wide(l)))
            .sum();
        share = (contaminated / count).clamp(0.5 / count, 0.1);
    }
    let gain: f64 = lambda
        .iter()
        .map(|&l| ((1.0 - share) + share * wide(l) / normal(l).max(f64::MIN_POSITIVE)).ln())
        .sum();
    // once there are some, the rest need only be likelier spikes than not
    (2.0 * gain > CONTAMINATED || found > 0).then_some(share.max(found as f64 / count))
}

fn is_likelier(lambda: f64, share: f64) -> bool {
    let odds =
        (share / ((1.0 - share) * WIDE)).ln() + 0.5 * lambda * lambda * (1.0 - WIDE.powi(-2));
    odds > 0.0 && lambda > LEAST
}

/// Whether a sample leaps away from both its neighbours and back, more than the model does there and than the recording
/// has digits. A model that is late at a sharp corner of its own is no spike.
fn stands_alone(k: usize, size: f64, residual: &[f64], measured: &[f64], lambda: &[f64]) -> bool {
    let neighbour = |at: Option<usize>| {
        let at = at.filter(|&at| at < residual.len() && residual[at].is_finite())?;
        // two spikes side by side
        let is_spike = lambda[at].abs() > LEAST && lambda[at] * lambda[k] > 0.0;
        (!is_spike).then(|| (residual[k] - residual[at]) / size)
    };
    let sides = [neighbour(k.checked_sub(1)), neighbour(Some(k + 1))];
    let leaps =
        sides.iter().flatten().all(|share| *share > 0.4) && sides.iter().any(Option::is_some);
    let model = |at: usize| measured[at] - residual[at];
    let bend = (k.saturating_sub(2).max(1)..(k + 3).min(residual.len().saturating_sub(1)))
        .map(|at| (model(at - 1) - 2.0 * model(at) + model(at + 1)).abs())
        .filter(|bend| bend.is_finite())
        .fold(0.0, f64::max);
    leaps && size.abs() > 2.0 * bend && size.abs() > 1.5 * quantum(measured)
}

/// The smallest step of a recording.
fn quantum(measured: &[f64]) -> f64 {
    stop::check();
    let steps = measured.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let least = steps.filter(|d| *d > 0.0).fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

/// Samples that repeat one value to the last digit while the model moves.
fn stuck(residual: &[f64], measured: &[f64]) -> Vec<Spike> {
    let off: Vec<f64> = (0..residual.len())
        .map(|k| residual[k] - middle(residual, k))
        .collect();
    let scale = robust_deviation(&off);
    if scale.is_nan() || scale <= 0.0 {
        return Vec::new();
    }
    let least = LOOSE * scale.max(quantum(measured));
    let mut found = Vec::new();
    let mut from = 0;
    for k in 1..=measured.len() {
        if k < measured.len() && measured[k] == measured[from] {
            continue;
        }
        let part = || residual[from..k].iter().copied();
        let spread = || part().fold(f64::MIN, f64::max) - part().fold(f64::MAX, f64::min);
        // what was stuck leaps when it comes loose; an aircraft in steady flight does not
        let leap = measured.get(k).map_or(0.0, |z| (z - measured[from]).abs());
        if k - from >= STUCK && spread() > least && leap > least.max(0.5 * spread()) {
            found.extend((from + 1..k).map(|at| Spike {
                at,
                deviations: LOOSE,
            }));
        }
        from = k;
    }
    found
}

fn middle(series: &[f64], k: usize) -> f64 {
    stop::check_sometimes(k);
    let around = k.saturating_sub(SIDE)..(k + SIDE + 1).min(series.len());
    let mut values: Vec<f64> = series[around].to_vec();
    values.retain(|value| value.is_finite());
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Standard deviation without regard to outliers: from the median and from the fourth quintile of the sizes, whichever
/// says more. Of what mostly stays the same and sometimes moves by a digit the median alone says nothing.
fn robust_deviation(values: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = values.iter().map(|v| v.abs()).collect();
    sizes.retain(|size| size.is_finite());
    sizes.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let place = (share * sizes.len() as f64) as usize;
        sizes.get(place).copied().unwrap_or(f64::NAN)
    };
    // quantiles of the normal distribution's sizes
    (at(0.5) / 0.6745).max(at(0.8) / 1.2816)
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    /// White, of deviation 0.3.
    fn noise() -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let draw = |_| 0.3 * Distribution::<f64>::sample(&StandardNormal, &mut random);
        (0..600).map(draw).collect()
    }

    #[test]
    fn spikes_and_stuck_values_are_found_and_noise_is_not() {
        let noise = noise();
        let model: Vec<f64> = (0..500).map(|k| 20.0 * (k as f64 / 40.0).sin()).collect();
        let mut measured: Vec<f64> = (0..500).map(|k| model[k] + noise[k]).collect();
        let residual = |measured: &[f64]| -> Vec<f64> {
            measured.iter().zip(&model).map(|(z, y)| z - y).collect()
        };
        assert!(spikes(&residual(&measured), &measured).is_empty());
        measured[100] += 30.0;
        let stuck = measured[360];
        measured[360..375].fill(stuck);
        let found: Vec<usize> = spikes(&residual(&measured), &measured)
            .iter()
            .map(|spike| spike.at)
            .collect();
        assert!(
            found.contains(&100) && (363..375).all(|k| found.contains(&k)),
            "{found:?}"
        );
        assert!(found.len() <= 17, "{found:?}");
    }

    /// Three recordings without an outlier in which one was seen: airspeed that stays and then moves by many digits,
    /// buffet in a stall, and steady flight recorded to a coarse digit while the model drifts off.
    #[test]
    fn rough_stretches_and_coarse_digits_are_no_outliers() {
        let noise = noise();
        let of = |measured: &dyn Fn(usize) -> f64, model: &dyn Fn(usize) -> f64| {
            let measured: Vec<f64> = (0..600).map(measured).collect();
            let residual: Vec<f64> = (0..600).map(|k| measured[k] - model(k)).collect();
            spikes(&residual, &measured)
        };
        let lumps = |k: usize| (noise[k / 2] * 8.0).round() * 0.04 + 1e-4 * noise[k];
        assert_eq!(of(&lumps, &|_| 0.0), []);
        let buffet = |k: usize| noise[k] * if k < 500 { 1.0 } else { 15.0 };
        assert_eq!(of(&buffet, &|_| 0.0), []);
        let steady = |k: usize| {
            if k < 300 {
                0.5
            } else {
                0.5 + 0.1 * (noise[k] * 4.0).round()
            }
        };
        assert_eq!(of(&steady, &|k| 0.004 * k as f64), []);
    }
}
