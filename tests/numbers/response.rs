//! Frequency responses of recorded signals, against known truth and an independent computation.

use std::f64::consts::TAU;
use std::sync::Arc;

use num_complex::Complex64;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde_json::{Value, json};
use trimtab_core::flight::Maneuver;
use trimtab_core::response::{
    FrequencyResponse, FrequencyResponses, ResponseOptions, frequency_responses,
};

use crate::common::plans::recording;

const STEP: f64 = 0.02;
const SAMPLES: usize = 6000;

fn normal(rng: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// Two correlated inputs; y answers to both: to a by 3/(s + 2) a tenth of a second late, to b by 5/(s² + 1.2 s + 9).
fn flown(seed: u64, noise: f64) -> Arc<Maneuver> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let fine = 4;
    let h = STEP / f64::from(fine);
    let (mut slow, mut other) = (0.0, 0.0);
    let mut a = vec![0.0; SAMPLES];
    let mut b = vec![0.0; SAMPLES];
    for k in 1..SAMPLES {
        slow += STEP * (-6.0 * slow) + STEP.sqrt() * normal(&mut rng);
        other += STEP * (-6.0 * other) + STEP.sqrt() * normal(&mut rng);
        (a[k], b[k]) = (slow, 0.6 * slow + other);
    }
    let line = |series: &[f64], t: f64| {
        let place = (t / STEP).clamp(0.0, (SAMPLES - 1) as f64);
        let k = (place as usize).min(SAMPLES - 2);
        series[k] + (series[k + 1] - series[k]) * (place - k as f64)
    };
    let (mut x, mut p, mut v) = (0.0, 0.0, 0.0);
    let mut y = Vec::new();
    for k in 0..SAMPLES {
        y.push(x + p + noise * normal(&mut rng));
        for i in 0..fine {
            let t = k as f64 * STEP + f64::from(i) * h;
            let f = |x: f64, p: f64, v: f64, t: f64| {
                (
                    -2.0 * x + 3.0 * line(&a, t - 0.1),
                    v,
                    -9.0 * p - 1.2 * v + 5.0 * line(&b, t),
                )
            };
            let first = f(x, p, v, t);
            let second = f(x + h * first.0, p + h * first.1, v + h * first.2, t + h);
            x += 0.5 * h * (first.0 + second.0);
            p += 0.5 * h * (first.1 + second.1);
            v += 0.5 * h * (first.2 + second.2);
        }
    }
    let time = (0..SAMPLES).map(|k| k as f64 * STEP).collect();
    recording(time, &[("a", a), ("b", b), ("y", y)])
}

fn truth(input: &str, frequency: f64) -> Complex64 {
    let s = Complex64::new(0.0, TAU * frequency);
    match input {
        "a" => 3.0 / (s + 2.0) * (-0.1 * s).exp(),
        _ => 5.0 / (s * s + 1.2 * s + 9.0),
    }
}

fn responses(maneuver: &Maneuver, changes: Value) -> FrequencyResponses {
    let mut options =
        json!({"inputs": ["a", "b"], "outputs": ["y"], "band_hz": [0.2, 1.5], "points": 40});
    for (key, value) in changes.as_object().expect("an object") {
        options[key] = value.clone();
    }
    let options: ResponseOptions = serde_json::from_value(options).expect("options");
    frequency_responses(maneuver, &options).unwrap_or_else(|faults| panic!("{faults:#?}"))
}

fn at(response: &FrequencyResponse, k: usize) -> Complex64 {
    Complex64::from_polar(
        response.magnitude[k].unwrap(),
        response.phase_deg[k].unwrap().to_radians(),
    )
}

/// Over 20 seeds: conditioned responses are those of the truth but for what the windows blur at the resonance, where the
/// unconditioned one is far off, and scatter as the random error says. The same in numpy, with other noise: bias 0.16, scatter
/// 1.10.
#[test]
fn conditioned_responses_are_those_of_the_truth_and_as_accurate_as_they_say() {
    let seeds = 20;
    let (mut biased, mut sums) = (0.0_f64, vec![vec![Complex64::ZERO; 40]; 2]);
    let (mut ratio, mut count) = (0.0, 0.0);
    for seed in 0..seeds {
        let maneuver = flown(seed, 0.05);
        let found = responses(&maneuver, json!({"band_hz": [0.2, 1.0]}));
        for (sums, response) in sums.iter_mut().zip(&found.responses) {
            for (k, sum) in sums.iter_mut().enumerate() {
                let exact = truth(&response.input, found.frequency_hz[k]);
                let error = (at(response, k) - exact) / exact;
                *sum += error;
                ratio += 0.5 * error.norm_sqr() / response.random_error[k].unwrap().powi(2);
                count += 1.0;
            }
        }
        let alone = responses(&maneuver, json!({"inputs": ["a"]}));
        let exact = truth("a", alone.frequency_hz[5]);
        biased += ((at(&alone.responses[0], 5) - exact) / exact).norm() / seeds as f64;
    }
    let worst = sums
        .iter()
        .flatten()
        .map(|sum| sum.norm() / seeds as f64)
        .fold(0.0, f64::max);
    let ratio = (ratio / count).sqrt();
    println!(
        "bias {worst:.4}, without conditioning {biased:.3}; scatter {ratio:.3} of the random error"
    );
    assert!(worst < 0.25, "{worst}");
    assert!(biased > 0.4, "{biased}");
    assert!((0.8..=1.4).contains(&ratio), "{ratio}");
}

/// One window without overlap of another: by numpy 2.4's Hann-tapered sums at the same frequencies, written out here.
#[test]
fn spectra_of_one_window_are_those_of_the_definition() {
    let maneuver = flown(3, 0.1);
    let found = responses(
        &maneuver,
        json!({"inputs": ["a"], "windows": [30.0], "points": 3}),
    );
    let (length, hop) = (1500, 750);
    let taper = |n: usize| 0.5 - 0.5 * (TAU * (n as f64 + 0.5) / length as f64).cos();
    let transform = |series: &[f64], first: usize, frequency: f64| -> Complex64 {
        let part = &series[first..first + length];
        let whole: f64 = (0..length).map(taper).sum();
        let mean = part
            .iter()
            .enumerate()
            .map(|(n, x)| x * taper(n))
            .sum::<f64>()
            / whole;
        let summand = |(n, x): (usize, &f64)| {
            Complex64::from_polar((x - mean) * taper(n), -TAU * frequency * n as f64 * STEP)
        };
        part.iter().enumerate().map(summand).sum()
    };
    let channels = maneuver.channels();
    for (k, &frequency) in found.frequency_hz.iter().enumerate() {
        let (mut xx, mut xy, mut yy) = (0.0, Complex64::ZERO, 0.0);
        let mut first = 0;
        while first + length <= SAMPLES {
            let x = transform(&channels["a"].values, first, frequency);
            let y = transform(&channels["y"].values, first, frequency);
            xx += x.norm_sqr();
            yy += y.norm_sqr();
            xy += x.conj() * y;
            first += hop;
        }
        let response = &found.responses[0];
        assert!((at(response, k) - xy / xx).norm() < 1e-9);
        let coherence = xy.norm_sqr() / (xx * yy);
        assert!((response.coherence[k].unwrap() - coherence).abs() < 1e-9);
    }
}

/// Transfer functions with the poles, gain and delay of the truth.
#[test]
fn transfer_functions_with_delay_are_found() {
    let maneuver = flown(1, 0.02);
    let with = |numerator: usize, denominator: usize, delay: bool| json!({"windows": [60.0, 30.0], "transfer_function": {"numerator": numerator, "denominator": denominator, "delay": delay}});
    let first = responses(&maneuver, with(0, 1, true)).responses.remove(0);
    let fit = first.transfer_function.expect("a fit");
    println!("{fit:?}");
    assert!((fit.numerator[0] - 3.0).abs() < 0.15, "{fit:?}");
    assert!((fit.denominator[0] - 2.0).abs() < 0.15, "{fit:?}");
    assert!((fit.delay - 0.1).abs() < 0.01, "{fit:?}");
    assert!(fit.cost < 20.0);
    let second = responses(&maneuver, with(0, 2, false)).responses.remove(1);
    let fit = second.transfer_function.expect("a fit");
    println!("{fit:?}");
    for (found, exact, within) in [
        (fit.numerator[0], 5.0, 0.3),
        (fit.denominator[0], 9.0, 0.3),
        (fit.denominator[1], 1.2, 0.15),
    ] {
        assert!((found - exact).abs() < within, "{fit:?}");
    }
}

#[test]
fn what_gives_no_response_is_refused_by_name() {
    let maneuver = flown(1, 0.1);
    let refused = |changes: Value| {
        let mut options = json!({"inputs": ["a"], "outputs": ["y"], "band_hz": [0.2, 1.5]});
        for (key, value) in changes.as_object().expect("an object") {
            options[key] = value.clone();
        }
        let options: ResponseOptions = serde_json::from_value(options).expect("options");
        let faults = frequency_responses(&maneuver, &options).expect_err("a refusal");
        (faults[0].pointer.clone(), faults[0].code.to_string())
    };
    for (changes, pointer, code) in [
        (json!({"inputs": []}), "/inputs", "bad_option"),
        (json!({"inputs": ["c"]}), "/inputs", "unknown_channel"),
        (json!({"outputs": ["a"]}), "/outputs", "bad_option"),
        (json!({"band_hz": [0.0, 1.0]}), "/band_hz", "bad_option"),
        (json!({"band_hz": [0.2, 30.0]}), "/band_hz", "bad_option"),
        (json!({"points": 1}), "/points", "bad_option"),
        (json!({"windows": [-1.0]}), "/windows", "bad_option"),
        (json!({"windows": [1000.0]}), "/windows", "too_few_samples"),
        (
            json!({"windows": [60.0, 30.0], "transfer_function": {"numerator": 3, "denominator": 2}}),
            "/transfer_function",
            "bad_option",
        ),
    ] {
        assert_eq!(
            refused(changes.clone()),
            (pointer.to_string(), code.to_string()),
            "{changes}"
        );
    }
    // an input that is a sum of others has no response of its own
    let again = recording(
        maneuver.time().to_vec(),
        &[
            ("a", maneuver.channels()["a"].values.clone()),
            (
                "b",
                maneuver.channels()["a"]
                    .values
                    .iter()
                    .map(|x| 2.0 * x)
                    .collect(),
            ),
            ("y", maneuver.channels()["y"].values.clone()),
        ],
    );
    let options: ResponseOptions = serde_json::from_value(
        json!({"inputs": ["a", "b"], "outputs": ["y"], "band_hz": [0.2, 1.5]}),
    )
    .unwrap();
    let faults = frequency_responses(&again, &options).expect_err("a refusal");
    assert_eq!(faults[0].code, "no_response");
}
