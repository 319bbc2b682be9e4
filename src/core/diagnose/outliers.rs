//! Samples that are no measurements: spikes, dropouts and stuck values, found before anything else, since least squares
//! follow them.

use super::case::Case;
use super::effect::{Effect, Treatment};
use super::fitted::Fitted;
use super::found::Accepted;
use super::report::Evidence;
use super::stack::Layout;
use crate::estimate::Role;

/// Noise goes this many robust standard deviations from its neighbourhood once in 500 million samples.
const OUTLYING: f64 = 6.0;

/// Samples on either side that make the neighbourhood.
const SIDE: usize = 4;

/// Samples on either side by which roughness is judged.
const WIDE: usize = 25;

/// A value that stays the same to the last digit for so many samples, while the model moves, is stuck.
const STUCK: usize = 6;

/// More than this share is no matter of single samples.
const MOST: f64 = 0.1;
const LEAST: usize = 2;

/// The case without such samples (they have no value any more), and the effects; `None` where there are none.
pub(super) fn clean(case: &Case, declared: &Fitted) -> Option<(Case, Vec<Accepted>)> {
    let layout = Layout::of(&declared.problem);
    let mut cleaned = case.clone();
    let mut found = Vec::new();
    for (index, output) in declared.problem.model.outputs.iter().enumerate() {
        let mut count = 0;
        let mut evidence = 0.0;
        let mut flights = cleaned
            .flights
            .iter_mut()
            .filter(|f| f.role == Role::Estimation);
        for series in layout.series.iter().filter(|series| series.output == index) {
            let flight = flights.next()?;
            let residual = &declared.residual[series.range.clone()];
            let (measured, _) = flight.channels.get_mut(&output.name)?;
            for (k, deviation) in outlying(residual, measured) {
                measured[k] = f64::NAN;
                count += 1;
                evidence += deviation * deviation;
            }
        }
        let samples: usize = layout
            .of_output(&declared.residual, index)
            .iter()
            .map(|s| s.len())
            .sum();
        if count < LEAST || count as f64 > MOST * samples as f64 {
            restore(&mut cleaned, case, &output.name);
            continue;
        }
        found.push((
            Effect::treatment(Treatment::SensorOutliers, &output.name),
            count,
            evidence,
        ));
    }
    if found.is_empty() {
        return None;
    }
    // the flights that are predicted have such samples too: what their own neighbourhood tells is left out
    for flight in cleaned
        .flights
        .iter_mut()
        .filter(|flight| flight.role != Role::Estimation)
    {
        for (effect, ..) in &found {
            if let Some((measured, _)) = flight.channels.get_mut(&effect.target) {
                for (k, _) in outlying(&measured.clone(), measured) {
                    measured[k] = f64::NAN;
                }
            }
        }
    }
    let fitted = Fitted::trial(&cleaned, declared.document.clone(), &declared.values()).ok()?;
    let accepted = found.into_iter().map(|(effect, count, evidence)| Accepted {
        group: vec![super::report::Member {
            effect: effect.clone(),
            weight: 1.0,
        }],
        effect,
        added: Vec::new(),
        evidence: Evidence {
            likelihood_ratio: evidence,
            threshold: OUTLYING * OUTLYING * count as f64,
            score: None,
            visible_fraction: None,
            smallest_seen: None,
            held_out: None,
            held_out_by_output: Vec::new(),
        },
        fitted: fitted.clone(),
    });
    let accepted = accepted.collect();
    Some((cleaned, accepted))
}

fn restore(cleaned: &mut Case, case: &Case, output: &str) {
    for (to, from) in cleaned.flights.iter_mut().zip(&case.flights) {
        if let (Some(to), Some(from)) = (to.channels.get_mut(output), from.channels.get(output)) {
            to.0.clone_from(&from.0);
        }
    }
}

/// Samples that stand out of their neighbourhood, or are stuck, with how far they are off in robust standard deviations.
fn outlying(residual: &[f64], measured: &[f64]) -> Vec<(usize, f64)> {
    let median = |values: &mut Vec<f64>| {
        values.retain(|value| value.is_finite());
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
    };
    let off: Vec<f64> = (0..residual.len())
        .map(|k| {
            let around = k.saturating_sub(SIDE)..(k + SIDE + 1).min(residual.len());
            residual[k] - median(&mut residual[around].to_vec())
        })
        .collect();
    let scale = robust_deviation(&off);
    if scale.is_nan() || scale <= 0.0 {
        return Vec::new();
    }
    // where the model moves fast a residual is large for many a reason: the measurement itself must stand out more
    let off_middle = |series: &dyn Fn(usize) -> f64, k: usize| {
        let around = k.saturating_sub(SIDE)..(k + SIDE + 1).min(residual.len());
        let middle = median(&mut around.clone().map(series).collect());
        let most = around
            .map(|i| (series(i) - middle).abs())
            .fold(0.0, f64::max);
        ((series(k) - middle).abs(), most)
    };
    // and alone: turbulence is no less rough than noise, but it does not leap there and back
    let leaps: Vec<f64> = (0..residual.len())
        .map(|k| match (k.checked_sub(1), residual.get(k + 1)) {
            (Some(before), Some(behind)) => residual[k] - 0.5 * (residual[before] + behind),
            _ => 0.0,
        })
        .collect();
    let leap = robust_deviation(&leaps);
    let quantum = measured
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .filter(|d| *d > 0.0);
    let quantum = quantum.fold(f64::INFINITY, f64::min);
    let stands_out = |k: usize, least: f64| {
        let (own, _) = off_middle(&|i| measured[i], k);
        let (_, motion) = off_middle(&|i| measured[i] - residual[i], k);
        own > least + motion && leaps[k].abs() > OUTLYING * leap
    };
    // in a stall or in rough air it is rougher than elsewhere
    let local = |k: usize| {
        let around = k.saturating_sub(WIDE)..(k + WIDE + 1).min(off.len());
        robust_deviation(&off[around]).max(scale)
    };
    let far = |k: &usize| off[*k].abs() > OUTLYING * scale;
    let mut found: Vec<(usize, f64)> = (0..off.len())
        .filter(far)
        .map(|k| (k, local(k)))
        .filter(|&(k, scale)| off[k].abs() > OUTLYING * scale && stands_out(k, OUTLYING * scale))
        .map(|(k, scale)| (k, off[k] / scale))
        .collect();
    let mut from = 0;
    for k in 1..=measured.len() {
        if k < measured.len() && measured[k] == measured[from] {
            continue;
        }
        let spread = || {
            let part = residual[from..k].iter();
            part.clone().copied().fold(f64::MIN, f64::max) - part.copied().fold(f64::MAX, f64::min)
        };
        // what was stuck leaps when it comes loose; an aircraft in steady flight does not
        let leap = measured.get(k).map_or(0.0, |z| (z - measured[from]).abs());
        let least = OUTLYING * scale.max(quantum);
        if k - from >= STUCK && spread() > least && leap > least.max(0.5 * spread()) {
            let known: Vec<usize> = found.iter().map(|(k, _)| *k).collect();
            found.extend(
                (from + 1..k)
                    .filter(|k| !known.contains(k))
                    .map(|k| (k, OUTLYING)),
            );
        }
        from = k;
    }
    found
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
    use super::*;

    #[test]
    fn spikes_and_stuck_values_are_found_and_noise_is_not() {
        let noise = |k: usize| ((k * 7919 + 13) % 101) as f64 / 101.0 - 0.5;
        let model: Vec<f64> = (0..500).map(|k| 20.0 * (k as f64 / 40.0).sin()).collect();
        let mut measured: Vec<f64> = (0..500).map(|k| model[k] + noise(k)).collect();
        let residual = |measured: &[f64]| -> Vec<f64> {
            measured.iter().zip(&model).map(|(z, y)| z - y).collect()
        };
        assert!(outlying(&residual(&measured), &measured).is_empty());
        measured[100] += 30.0;
        let stuck = measured[360];
        measured[360..375].fill(stuck);
        let found: Vec<usize> = outlying(&residual(&measured), &measured)
            .iter()
            .map(|(k, _)| *k)
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
        let noise = |k: usize| ((k * 7919 + 13) % 101) as f64 / 101.0 - 0.5;
        let of = |measured: &dyn Fn(usize) -> f64, model: &dyn Fn(usize) -> f64| {
            let measured: Vec<f64> = (0..600).map(measured).collect();
            let residual: Vec<f64> = (0..600).map(|k| measured[k] - model(k)).collect();
            outlying(&residual, &measured)
        };
        let lumps = |k: usize| (noise(k / 2) * 8.0).round() * 0.04 + 1e-4 * noise(k);
        assert_eq!(of(&lumps, &|_| 0.0), []);
        let buffet = |k: usize| noise(k) * if k < 500 { 1.0 } else { 15.0 };
        assert_eq!(of(&buffet, &|_| 0.0), []);
        let steady = |k: usize| {
            if k < 300 {
                0.5
            } else {
                0.5 + 0.1 * (noise(k) * 4.0).round()
            }
        };
        assert_eq!(of(&steady, &|k| 0.004 * k as f64), []);
    }
}
