//! The sizes of play, rate limit and lags are recovered from flights that were integrated in fine steps from continuous
//! inputs, by other equations than those that find them.

use std::sync::Arc;

use indexmap::IndexMap;
use serde_json::{Value, json};
use trimtab_core::flight::{Channel, Maneuver, Unit};

use crate::common::plans::{parameter, scatter, solve};

const STEP: f64 = 0.04;
const FINE: usize = 100;
const COUNT: usize = 400;

/// What is between the stick and the recorder of a flight.
#[derive(Clone, Copy, Default)]
struct Truth {
    play: f64,
    rate_limit: Option<f64>,
    actuator_lag: f64,
    sensor_lag: f64,
}

/// The stick, with edges as a pilot makes them.
fn elevator(t: f64) -> f64 {
    let edge = |at: f64| ((t - at) / 0.12).tanh();
    0.02 * (edge(1.0) - 2.0 * edge(3.4) + 2.0 * edge(5.0) - 2.0 * edge(5.8) + edge(6.6))
}

/// Euler steps of a hundredth of the recorder's for what is behind it, a short period by the midpoint rule.
fn flown(truth: Truth) -> Arc<Maneuver> {
    let h = STEP / FINE as f64;
    let (mut loose, mut slow, mut surface) = (elevator(0.0), elevator(0.0), elevator(0.0));
    let (mut alpha, mut q, mut vane) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut recorded = [const { Vec::new() }; 3];
    for i in 0..COUNT * FINE {
        let t = i as f64 * h;
        if i % FINE == 0 {
            let k = i / FINE;
            recorded[0].push(elevator(t));
            recorded[1].push(vane + 0.0006 * scatter(k, 1.0));
            recorded[2].push(q + 0.001 * scatter(k, 5.0));
        }
        let stick = elevator(t + h);
        loose = loose.max(stick - truth.play).min(stick + truth.play);
        let way = loose - slow;
        slow += truth.rate_limit.map_or(way, |r| way.clamp(-r * h, r * h));
        let before = surface;
        surface = if truth.actuator_lag > 0.0 {
            surface + (slow - surface) * h / (truth.actuator_lag + 0.5 * h)
        } else {
            slow
        };
        let de = 0.5 * (before + surface);
        let rate = |alpha: f64, q: f64| {
            [
                -0.9 * alpha + 0.97 * q - 0.08 * de,
                -3.4 * alpha - 1.6 * q - 4.8 * de,
            ]
        };
        let half = rate(alpha, q);
        let middle = rate(alpha + 0.5 * h * half[0], q + 0.5 * h * half[1]);
        (alpha, q) = (alpha + h * middle[0], q + h * middle[1]);
        vane = if truth.sensor_lag > 0.0 {
            vane + (alpha - vane) * h / (truth.sensor_lag + 0.5 * h)
        } else {
            alpha
        };
    }
    let channels = ["de", "alpha", "q"].map(String::from).into_iter();
    let series = recorded.map(|values| Channel::from_recorded("-", Unit::NONE, values));
    let channels: IndexMap<String, Channel> = channels.zip(series).collect();
    let time = (0..COUNT).map(|k| STEP * k as f64).collect();
    Arc::new(Maneuver::new(time, channels).expect("a maneuver"))
}

fn short_period() -> Value {
    json!({
        "name": "short-period-behind-an-actuator",
        "inputs": {"de": {}},
        "parameters": {
            "Za": {"unit": "1/s", "start": -0.6}, "Zq": {"unit": "1/s", "start": 0.97, "fixed": true},
            "Zde": {"unit": "1/s", "start": -0.08, "fixed": true},
            "Ma": {"unit": "1/s", "start": -3.0}, "Mq": {"unit": "1/s", "start": -1.2}, "Mde": {"unit": "1/s", "start": -4.0},
        },
        "states": {
            "alpha": {"initial": "0", "derivative": "Za*alpha + Zq*q + Zde*de"},
            "q": {"initial": "0", "derivative": "Ma*alpha + Mq*q + Mde*de"},
        },
        "outputs": {"alpha": {"equation": "alpha"}, "q": {"equation": "q"}},
    })
}

/// Fits with these edits from where they start; each size, and the derivatives, within four error bounds and a hundredth
/// of what they are: the recorder's straight lines between samples are not the pilot's edges.
#[track_caller]
fn recovers(truth: Truth, effects: &[(&str, &str, &str, f64)]) {
    let edits: Vec<Value> = (effects.iter())
        .map(|(kind, target, ..)| json!({"kind": kind, "target": target}))
        .collect();
    let flight = flown(truth);
    let without = solve(short_period(), json!({}), std::slice::from_ref(&flight));
    let found = solve(short_period(), json!({"edits": edits}), &[flight]);
    let estimate = &found.estimate;
    assert!(estimate.outcome.is_minimum(), "{}", estimate.reason);
    let gain = without.estimate.cost - estimate.cost;
    println!("{effects:?}: ln L grows by {gain:.1}");
    assert!(gain > 20.0, "{gain}");
    let sizes = effects.iter().map(|(_, _, name, size)| (*name, *size));
    let derivatives = [("Za", -0.9), ("Ma", -3.4), ("Mq", -1.6), ("Mde", -4.8)];
    for (name, truth) in sizes.chain(derivatives) {
        let row = parameter(&found, name);
        let bound = row.standard_error.expect("seen");
        println!("{name}: {truth}, found {:.5} ± {bound:.5}", row.estimate);
        let off = (row.estimate - truth).abs();
        assert!(off < 4.0 * bound + 0.01 * truth.abs(), "{name}: {off}");
        assert!(bound < 0.1 * truth.abs(), "{name}: {bound}");
    }
}

#[test]
fn play_of_the_elevator() {
    let truth = Truth {
        play: 0.004,
        ..Truth::default()
    };
    recovers(truth, &[("backlash", "de", "de_backlash", 0.004)]);
}

#[test]
fn a_limited_rate_of_the_elevator() {
    for r in [0.2, 0.06] {
        let truth = Truth {
            rate_limit: Some(r),
            ..Truth::default()
        };
        recovers(truth, &[("actuator_rate_limit", "de", "de_rate_limit", r)]);
    }
}

/// Of half a sample too, which a state could not follow.
#[test]
fn a_lag_of_the_elevator() {
    for lag in [0.02, 0.12] {
        let truth = Truth {
            actuator_lag: lag,
            ..Truth::default()
        };
        recovers(truth, &[("actuator_lag", "de", "de_lag", lag)]);
    }
}

#[test]
fn a_lag_of_the_vane() {
    for lag in [0.03, 0.15] {
        let truth = Truth {
            sensor_lag: lag,
            ..Truth::default()
        };
        recovers(truth, &[("sensor_lag", "alpha", "alpha_lag", lag)]);
    }
}

#[test]
fn all_of_them_at_once() {
    let truth = Truth {
        play: 0.003,
        rate_limit: Some(0.1),
        actuator_lag: 0.06,
        sensor_lag: 0.1,
    };
    let effects = [
        ("backlash", "de", "de_backlash", 0.003),
        ("actuator_rate_limit", "de", "de_rate_limit", 0.1),
        ("actuator_lag", "de", "de_lag", 0.06),
        ("sensor_lag", "alpha", "alpha_lag", 0.1),
    ];
    recovers(truth, &effects);
}

/// Where there is none, none is found: the sizes end at their bounds of no effect, or within their errors of it.
#[test]
fn nothing_where_there_is_nothing() {
    let flight = [flown(Truth::default())];
    for (kind, target, name) in [
        ("backlash", "de", "de_backlash"),
        ("actuator_lag", "de", "de_lag"),
        ("sensor_lag", "alpha", "alpha_lag"),
    ] {
        let edits = json!({"edits": [{"kind": kind, "target": target}]});
        let found = solve(short_period(), edits, &flight);
        let row = parameter(&found, name);
        let none = row.at_bound.is_some() || row.estimate < 3.5 * row.standard_error.expect("seen");
        assert!(none, "{kind}: {row:?}");
    }
}
