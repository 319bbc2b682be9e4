//! Butterworth filters of second order, one way or both ways, over samples that need not be even.
//!
//! The filter is integrated by the trapezoidal rule, which over even samples is the bilinear transform; its frequency is
//! moved so that it is right at the usual step. Missing samples stay missing, and the filter steps over them; behind a gap it
//! starts anew.

use std::f64::consts::{PI, SQRT_2};

use super::samples::parts;
use super::spline::slopes;

/// The frequency of one way for a gain of 1/√2 both ways together, as a multiple.
fn of_one_way() -> f64 {
    (SQRT_2 - 1.0).powf(-0.25)
}

/// Ends are prolonged by so many periods.
const PROLONGED: f64 = 2.0;

/// One way, as on board.
///
/// # Errors
/// The frequency is not above 0 and below half the channel's rate.
pub(super) fn lowpass(time: &[f64], values: &[f64], frequency: f64) -> Result<Vec<f64>, String> {
    let one_way = |time: &[f64], values: &[f64], usual: f64| filter(time, values, frequency, usual);
    each_part(time, values, (frequency, 1.0), one_way)
}

/// Both ways.
///
/// # Errors
/// The frequency is not above 0 and below 0.4 of the channel's rate.
pub(super) fn smoothed(time: &[f64], values: &[f64], frequency: f64) -> Result<Vec<f64>, String> {
    let both_ways = |time: &[f64], values: &[f64], usual: f64| {
        let (_, values, before) = both_ways(time, values, frequency, usual);
        values[before..before + time.len()].to_vec()
    };
    each_part(time, values, (frequency, of_one_way()), both_ways)
}

/// The rate of change of what is smoothed both ways.
///
/// # Errors
/// As [`smoothed`].
pub(super) fn derivative(time: &[f64], values: &[f64], frequency: f64) -> Result<Vec<f64>, String> {
    let rate = |time: &[f64], values: &[f64], usual: f64| {
        let (prolonged, values, before) = both_ways(time, values, frequency, usual);
        slopes(&prolonged, &values)[before..before + time.len()].to_vec()
    };
    let mut rates = each_part(time, values, (frequency, of_one_way()), rate)?;
    // a sample alone has no rate
    let (parts, _) = parts(time, values);
    for part in parts.iter().filter(|part| part.len() < 2) {
        rates[part[0]] = f64::NAN;
    }
    Ok(rates)
}

/// Applies a filter to each part of two samples or more; `frequency` comes with its multiple in the filter.
fn each_part(
    time: &[f64],
    values: &[f64],
    (frequency, multiple): (f64, f64),
    filter: impl Fn(&[f64], &[f64], f64) -> Vec<f64>,
) -> Result<Vec<f64>, String> {
    let (parts, usual) = parts(time, values);
    let most = 0.5 / (usual * multiple);
    // a channel of one value and less has no rate
    if !(frequency > 0.0 && (frequency < most || !most.is_finite())) {
        return Err(format!(
            "the channel has {:.4} samples a second; give a frequency above 0 and below {most:.4} Hz",
            usual.recip()
        ));
    }
    let mut filtered = values.to_vec();
    for part in parts.iter().filter(|part| part.len() > 1) {
        let times: Vec<f64> = part.iter().map(|&row| time[row]).collect();
        let samples: Vec<f64> = part.iter().map(|&row| values[row]).collect();
        for (&row, value) in part.iter().zip(filter(&times, &samples, usual)) {
            filtered[row] = value;
        }
    }
    Ok(filtered)
}

/// y'' = ω²(u - y) - √2 ω y', from rest at the first sample.
fn filter(time: &[f64], values: &[f64], frequency: f64, usual: f64) -> Vec<f64> {
    let omega = 2.0 / usual * (PI * frequency * usual).tan();
    let square = omega * omega;
    let mut filtered = Vec::with_capacity(values.len());
    let (mut y, mut rate) = (values[0], 0.0);
    filtered.push(y);
    for k in 1..values.len() {
        let half = 0.5 * (time[k] - time[k - 1]);
        let before = square * (values[k - 1] - y) - SQRT_2 * omega * rate;
        let driven = rate + half * (before + square * (values[k] - y - half * rate));
        let next = driven / (1.0 + half * (SQRT_2 * omega + half * square));
        y += half * (rate + next);
        rate = next;
        filtered.push(y);
    }
    filtered
}

/// Forwards and backwards over a part that goes on at both ends, turned about its last sample: times, values, and how many
/// samples there are before the first.
fn both_ways(
    time: &[f64],
    values: &[f64],
    frequency: f64,
    usual: f64,
) -> (Vec<f64>, Vec<f64>, usize) {
    let last = time.len() - 1;
    let length = PROLONGED / frequency * (1.0 + 1e-9);
    let before = (1..=last)
        .take_while(|&k| time[k] - time[0] <= length)
        .count();
    let behind = (1..=last)
        .take_while(|&k| time[last] - time[last - k] <= length)
        .count();
    let turned = |about: usize, at: usize| {
        (
            2.0 * time[about] - time[at],
            2.0 * values[about] - values[at],
        )
    };
    let first_part = (1..=before).rev().map(|k| turned(0, k));
    let itself = time.iter().copied().zip(values.iter().copied());
    let last_part = (1..=behind).map(|k| turned(last, last - k));
    let (time, values): (Vec<f64>, Vec<f64>) = first_part.chain(itself).chain(last_part).unzip();
    let frequency = frequency * of_one_way();
    let mut forwards = filter(&time, &values, frequency, usual);
    forwards.reverse();
    let backwards: Vec<f64> = time.iter().rev().map(|time| -time).collect();
    let mut both = filter(&backwards, &forwards, frequency, usual);
    both.reverse();
    (time, both, before)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOWPASS: [(usize, f64); 6] = [
        (0, 1.0000000000000004),
        (1, 1.014594056170662),
        (13, 1.819675674011363),
        (14, 1.9054382686602065),
        (30, 5.002206119815248),
        (49, 5.147189437032286),
    ];
    const BOTH_WAYS: [(usize, f64, f64); 6] = [
        (0, 1.0000022951527805, 7.799690153071248),
        (1, 1.3081278936101053, 7.510044920784866),
        (13, 2.2721754203593654, 5.5184294903593205),
        (14, 2.4748102348562795, 4.396452391847957),
        (30, 5.025191803629168, -2.506753176485702),
        (49, 5.8742330770181885, 6.065090467276147),
    ];

    /// A step, a ramp and a wave, at 25 Hz.
    fn channel() -> (Vec<f64>, Vec<f64>) {
        let time: Vec<f64> = (0..50).map(|k| f64::from(k) * 0.04).collect();
        let value = |t: &f64| 1.0 + t + if *t > 0.5 { 2.0 } else { 0.0 } + (7.0 * t).sin();
        let values = time.iter().map(value).collect();
        (time, values)
    }

    fn assert_close(found: f64, expected: f64, within: f64, what: &str) {
        assert!(
            (found - expected).abs() < within,
            "{what}: {found} is not {expected}"
        );
    }

    /// `b, a = butter(2, 2, fs=25)`, `lfilter(b, a, x, zi=lfilter_zi(b, a)*x[0])[0]` of scipy 1.17.1.
    #[test]
    fn one_way_is_the_filter_of_scipy() {
        let (time, values) = channel();
        let filtered = lowpass(&time, &values, 2.0).unwrap();
        for (k, expected) in LOWPASS {
            assert_close(filtered[k], expected, 1e-11, "lowpass");
        }
        // late by √2/(2π f) on a ramp
        let ramp: Vec<f64> = time.iter().map(|t| 3.0 * t).collect();
        let late = lowpass(&time, &ramp, 2.0).unwrap();
        let delay = SQRT_2 / (2.0 * PI * 2.0) * (PI * 2.0 * 0.04) / (PI * 2.0 * 0.04).tan();
        assert_close(late[49], ramp[49] - 3.0 * delay, 1e-4, "delay");
    }

    /// `b, a = butter(2, 2*(2**.5 - 1)**-.25, fs=25)`, `filtfilt(b, a, x, padlen=25)` of scipy 1.17.1, and of its whole
    /// prolonged series `CubicSpline(..., bc_type='natural')` for the rate.
    #[test]
    fn both_ways_are_those_of_scipy() {
        let (time, values) = channel();
        let smooth = smoothed(&time, &values, 2.0).unwrap();
        let rate = derivative(&time, &values, 2.0).unwrap();
        for (k, value, slope) in BOTH_WAYS {
            assert_close(smooth[k], value, 1e-10, "smoothed");
            assert_close(rate[k], slope, 1e-9, "derivative");
        }
    }

    /// Closed forms: a ramp is kept, and a wave has the gain of the filter and no delay.
    #[test]
    fn ramps_and_waves_keep_their_phase() {
        // with jitter: each step is its own
        let time: Vec<f64> = (0..600)
            .map(|k| (f64::from(k) + 0.2 * (f64::from(k) * 1.7).sin()) * 0.01)
            .collect();
        let ramp: Vec<f64> = time.iter().map(|t| 4.0 - 2.0 * t).collect();
        for (k, rate) in derivative(&time, &ramp, 3.0).unwrap().iter().enumerate() {
            assert_close(*rate, -2.0, 2e-4, &format!("{k}"));
        }
        let omega = 2.0 * PI * 0.7;
        let wave: Vec<f64> = time.iter().map(|t| (omega * t).sin()).collect();
        let gain = 1.0 / (1.0 + (0.7f64 / (3.0 * of_one_way())).powi(4));
        let (smooth, rate) = (
            smoothed(&time, &wave, 3.0).unwrap(),
            derivative(&time, &wave, 3.0).unwrap(),
        );
        for k in 60..540 {
            assert_close(smooth[k], gain * wave[k], 2e-4, "wave");
            assert_close(
                rate[k],
                gain * omega * (omega * time[k]).cos(),
                2e-3,
                "its rate",
            );
        }
        let at_frequency: Vec<f64> = time.iter().map(|t| (2.0 * PI * 3.0 * t).sin()).collect();
        let smooth = smoothed(&time, &at_frequency, 3.0).unwrap();
        let most = smooth[100..500]
            .iter()
            .fold(0.0, |most: f64, value| most.max(value.abs()));
        assert_close(most, 0.5f64.sqrt(), 5e-3, "gain at the frequency");
    }

    #[test]
    fn missing_samples_stay_missing_and_gaps_part() {
        let (time, values) = channel();
        let every_fifth = |k: usize| {
            if k.is_multiple_of(5) {
                values[k]
            } else {
                f64::NAN
            }
        };
        let sparse: Vec<f64> = (0..50).map(every_fifth).collect();
        let smooth = smoothed(&time, &sparse, 1.0).unwrap();
        assert!((0..50).all(|k| smooth[k].is_nan() == sparse[k].is_nan()));
        let few: Vec<f64> = (0..50).step_by(5).map(|k| time[k]).collect();
        let alone: Vec<f64> = (0..50).step_by(5).map(|k| values[k]).collect();
        let alone = smoothed(&few, &alone, 1.0).unwrap();
        assert!((0..10).all(|k| smooth[5 * k] == alone[k]));
        // 5 Hz are the rate of the channel, not 25 Hz
        let error = lowpass(&time, &sparse, 2.6).unwrap_err();
        assert!(
            error.contains("5.0000 samples a second") && error.contains("below 2.5"),
            "{error}"
        );
        assert!(
            lowpass(&time, &values, f64::NAN).is_err() && smoothed(&time, &values, 11.0).is_err()
        );

        let mut parted = time.clone();
        parted[25..].iter_mut().for_each(|t| *t += 10.0);
        let both = smoothed(&parted, &values, 2.0).unwrap();
        assert_eq!(
            both[..25],
            smoothed(&time[..25], &values[..25], 2.0).unwrap()
        );
        let nothing = smoothed(&time, &[f64::NAN; 50], 2.0).unwrap();
        assert!(nothing.iter().all(|value| value.is_nan()));
        let mut one = vec![f64::NAN; 50];
        one[7] = 3.0;
        assert_eq!(smoothed(&time, &one, 2.0).unwrap()[7], 3.0);
    }
}
