//! What is wrong with data or a job is said, and what can be put right is: against data of known truth, simulated here with
//! twenty Runge-Kutta steps a sample, inputs straight between samples.

mod jobs;
mod recordings;

use std::sync::Arc;

use crate::common::plans::{parameter, scatter, solve};
use serde_json::{Value, json};
use trimtab_core::flight::{Channel, Finding, Maneuver, Unit};
use trimtab_core::job::JobResult;

const STEP: f64 = 0.02;
const SAMPLES: usize = 701;
const TRUTH: [(&str, f64); 6] = [
    ("Za", -1.4),
    ("Zq", 0.97),
    ("Zde", -0.11),
    ("Ma", -7.0),
    ("Mq", -2.4),
    ("Mde", -11.0),
];

fn elevator(k: usize) -> f64 {
    let steps = match k {
        ..260 => 0.0,
        260..320 => 1.0,
        320..360 => -1.0,
        360..380 => 1.0,
        380..400 => -1.0,
        520..560 => 0.7,
        _ => 0.0,
    };
    (-1.0 + 3.0 * steps) * 1f64.to_radians()
}

/// Noise of unit variance, without a generator: the sum of twelve scattered numbers.
fn normal(k: usize, seed: f64) -> f64 {
    (0..12).map(|i| scatter(k * 12 + i, seed)).sum()
}

/// Time, de, alpha, q, SI; the pitch rate and the angle of attack with noise of 0.08 deg/s and 0.04 deg.
fn short_period(seed: f64) -> [Vec<f64>; 4] {
    let (trim, mut alpha, mut q) = (3f64.to_radians(), 0.0, 0.0);
    let mut series = [vec![], vec![], vec![], vec![]];
    for k in 0..SAMPLES {
        let noise = 1f64.to_radians();
        let values = [
            k as f64 * STEP,
            elevator(k),
            trim + alpha + 0.04 * noise * normal(k, seed),
            q + 0.08 * noise * normal(k, seed + 0.5),
        ];
        series
            .iter_mut()
            .zip(values)
            .for_each(|(to, value)| to.push(value));
        const FINE: usize = 20;
        let h = STEP / FINE as f64;
        for i in 0..FINE {
            let de = |share: f64| {
                let s = (i as f64 + share) / FINE as f64;
                (1.0 - s) * elevator(k) + s * elevator(k + 1) + 1f64.to_radians()
            };
            let rate = |a: f64, q: f64, de: f64| {
                (
                    -1.4 * a + 0.97 * q - 0.11 * de,
                    -7.0 * a - 2.4 * q - 11.0 * de,
                )
            };
            let k1 = rate(alpha, q, de(0.0));
            let k2 = rate(alpha + h / 2.0 * k1.0, q + h / 2.0 * k1.1, de(0.5));
            let k3 = rate(alpha + h / 2.0 * k2.0, q + h / 2.0 * k2.1, de(0.5));
            let k4 = rate(alpha + h * k3.0, q + h * k3.1, de(1.0));
            alpha += h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0);
            q += h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1);
        }
    }
    series
}

fn maneuver(series: &[Vec<f64>; 4]) -> Arc<Maneuver> {
    let channel = |unit: &str, values: &Vec<f64>| {
        Channel::from_recorded(unit, Unit::parse(unit).unwrap(), values.clone())
    };
    let channels = [("de", "rad", 1), ("alpha", "rad", 2), ("q", "rad/s", 3)];
    let channels = channels.map(|(name, unit, at)| (name.to_string(), channel(unit, &series[at])));
    Arc::new(Maneuver::new(series[0].clone(), channels.into_iter().collect()).unwrap())
}

/// Some rows of the flight.
fn rows(kept: impl Fn(usize) -> bool) -> [Vec<f64>; 4] {
    short_period(1.0).map(|series| {
        let rows = series.into_iter().enumerate().filter(|(k, _)| kept(*k));
        rows.map(|(_, value)| value).collect()
    })
}

fn fit(changes: Value, series: &[Vec<f64>; 4]) -> JobResult {
    solve(json!("short-period"), changes, &[maneuver(series)])
}

/// How far estimates are from the truth, in standard errors: the furthest of all.
fn furthest(result: &JobResult) -> f64 {
    let off = TRUTH.map(|(name, truth)| {
        let row = parameter(result, name);
        (row.estimate - truth).abs() / row.standard_error.expect("a bound")
    });
    off.into_iter().fold(0.0, f64::max)
}

fn codes(findings: &[Finding]) -> Vec<&str> {
    findings
        .iter()
        .map(|finding| finding.code.as_str())
        .collect()
}
