//! Large jobs of each kind end within a second of being cancelled, wherever they are. What a solver does in small jobs that
//! are stopped between iterations is shown beside each of them.

use std::sync::{Arc, LazyLock};
use std::time::Duration;

use serde_json::{Value, json};
use trimtab_core::flight::Maneuver;

use crate::common::chain::{chain, recorded};
use crate::common::large_jobs::{LONGEST, LargeJob, asks_often, long_elevator};
use crate::common::plans::recording;

/// Samples of 4 outputs, 40 parameters: the limit of recordings.
const LONG: usize = 1_000_000;

fn long() -> (Value, Arc<Maneuver>) {
    static RECORDED: LazyLock<Arc<Maneuver>> = LazyLock::new(|| recorded(4, LONG));
    (chain(4, 7), RECORDED.clone())
}

/// 64 states, 64 outputs, 512 parameters: the limits of a model.
fn wide(samples: usize) -> (Value, Arc<Maneuver>) {
    (chain(64, 5), recorded(64, samples))
}

fn options(options: Value) -> Value {
    json!({ "options": options })
}

/// A job is cancelled when its threads have worked for some seconds.
fn ends(name: &str, (model, flown): (Value, Arc<Maneuver>), changes: &Value, after: f64) {
    let job = LargeJob::new(&model, flown, changes);
    asks_often(name, &job, Duration::from_secs_f64(after), LONGEST);
}

/// A job is run to its end, so that what comes last is heard as well.
fn whole(name: &str, (model, flown): (Value, Arc<Maneuver>), changes: &Value, longest: Duration) {
    let job = LargeJob::new(&model, flown, changes);
    asks_often(name, &job, Duration::MAX, longest);
}

#[test]
fn output_error_over_a_million_samples() {
    ends("output error, 10^6 x 40", long(), &json!({}), 6.0);
    let given = options(json!({"start": {"kind": "document"}}));
    ends(
        "output error from given values, 10^6 x 40",
        long(),
        &given,
        4.0,
    );
}

#[test]
fn output_error_of_the_largest_model() {
    let given = options(json!({"start": {"kind": "document"}}));
    ends("output error, 64 states x 512", wide(20_000), &given, 3.0);
}

#[test]
fn confidence_intervals() {
    let given = json!({"start": {"kind": "document"}, "confidence_intervals": {}});
    let flown = (json!("short-period"), long_elevator(100_000));
    ends("intervals, 100 000 x 9", flown, &options(given), 8.0);
}

#[test]
fn differences_and_complex_steps() {
    for technique in [
        "forward_difference",
        "central_difference",
        "complex_step",
        "adjoint",
    ] {
        let given = json!({"start": {"kind": "document"}, "derivatives": {"technique": technique}});
        ends(
            &format!("{technique}, 10^6 x 40"),
            long(),
            &options(given.clone()),
            2.0,
        );
        ends(
            &format!("{technique}, 64 x 512"),
            wide(20_000),
            &options(given),
            2.0,
        );
    }
}

#[test]
fn searches_for_a_start() {
    for kind in [
        "multi_start",
        "nelder_mead",
        "multiple_shooting",
        "equation_error",
    ] {
        let given = options(json!({"start": {"kind": kind}}));
        ends(&format!("start {kind}, 10^6 x 40"), long(), &given, 4.0);
    }
    let given = options(json!({"start": {"kind": "multiple_shooting"}}));
    ends(
        "start multiple_shooting, 32 x 256",
        (chain(32, 5), recorded(32, 20_000)),
        &given,
        3.0,
    );
}

#[test]
fn filter_error() {
    let given = options(json!({"estimator": "filter_error"}));
    let long = (chain(4, 7), recorded(4, 500_000));
    ends("filter error, 500 000 x 40", long, &given, 4.0);
    let wide = (chain(32, 5), recorded(32, 2000));
    ends("filter error, 2000 x 256", wide, &given, 2.0);
}

#[test]
fn equation_error_and_the_frequency_domain() {
    let given = options(json!({"estimator": "equation_error"}));
    ends("equation error, 10^6 x 40", long(), &given, 2.0);
    for estimator in ["output_error_frequency", "equation_error_frequency"] {
        let given = options(json!({"estimator": estimator, "frequency": {"band_hz": [0.01, 5.0]}}));
        ends(&format!("{estimator}, 10^6 x 40"), long(), &given, 3.0);
    }
}

#[test]
fn a_derivative_study() {
    let kind = json!({"kind": "derivative_study", "options": {"start": {"kind": "document"}, "max_iterations": 1}});
    ends("derivative study, 10^6 x 40", long(), &kind, 1.0);
    let short = || (chain(4, 7), recorded(4, 20_000));
    ends("derivative study, 20 000 x 40", short(), &kind, 6.0);
}

/// Samples of jobs that are run whole: of what comes last, each second that it takes over [`LONG`] is as much less here.
const SHORT: usize = 40_000;

/// Of a job of so few samples: a loop without an ask that takes more than a second over a million is heard.
const SHORTEST: Duration = Duration::from_millis(40);

#[test]
fn whole_estimations() {
    let flown = recorded(2, SHORT);
    let frequency = json!({"band_hz": [0.01, 5.0]});
    for options in [
        json!({}),
        json!({"derivatives": {"technique": "forward_difference"}, "max_iterations": 1}),
        json!({"derivatives": {"technique": "central_difference"}, "max_iterations": 1}),
        json!({"derivatives": {"technique": "complex_step"}, "max_iterations": 1}),
        json!({"derivatives": {"technique": "adjoint"}, "max_iterations": 3}),
        json!({"start": {"kind": "multiple_shooting"}, "max_iterations": 2}),
        json!({"start": {"kind": "equation_error"}, "max_iterations": 2}),
        json!({"estimator": "equation_error"}),
        json!({"estimator": "filter_error", "max_iterations": 1}),
        json!({"estimator": "output_error_frequency", "frequency": frequency, "max_iterations": 2}),
        json!({"estimator": "equation_error_frequency", "frequency": frequency}),
    ] {
        let name = options.to_string();
        whole(
            &name,
            (chain(2, 1), flown.clone()),
            &json!({"options": options}),
            SHORTEST,
        );
    }
}

#[test]
fn a_whole_study_and_a_whole_diagnosis() {
    let kind = json!({"kind": "derivative_study", "options": {"start": {"kind": "document"}, "max_iterations": 1}});
    let short = (chain(2, 1), recorded(2, 2_000));
    whole("derivative study", short, &kind, SHORTEST);
    let kind = json!({"kind": "diagnose"});
    let flown = long_elevator(3_000);
    whole("diagnosis", (json!("short-period"), flown), &kind, LONGEST);
}

#[test]
fn a_diagnosis() {
    let flown = long_elevator(249_000);
    let kind = json!({"kind": "diagnose"});
    ends(
        "diagnosis, 249 000 rows",
        (json!("short-period"), flown),
        &kind,
        12.0,
    );
}

#[test]
fn a_structure_determination() {
    let samples = 20_000;
    let time: Vec<f64> = (0..samples).map(|k| 0.02 * k as f64).collect();
    let wave = |speed: f64| -> Vec<f64> { time.iter().map(|t| (speed * t).sin()).collect() };
    let names = ["v0", "v1", "v2", "v3", "v4", "v5", "v6", "v7"];
    let mut channels: Vec<(&str, Vec<f64>)> = (names.iter().enumerate())
        .map(|(i, name)| (*name, wave(0.31 + 0.17 * i as f64)))
        .collect();
    let response = (0..samples).map(|k| {
        let product: f64 = channels.iter().map(|(_, values)| 1.0 + values[k]).product();
        product.ln_1p()
    });
    let response = response.collect();
    channels.push(("Cm", response));
    let inputs: Value = names
        .iter()
        .map(|name| (name.to_string(), json!({})))
        .collect();
    let model = json!({"name": "moment", "inputs": inputs, "outputs": {"Cm": {"equation": "0"}}});
    let flown = recording(time.clone(), &channels);
    for method in ["stepwise", "orthogonal"] {
        let structure = json!({"output": "Cm", "method": method, "variables": names, "order": 4});
        let kind = json!({"kind": "structure", "structure": structure});
        let name = format!("structure, {method}, 20 000 x 494");
        ends(&name, (model.clone(), flown.clone()), &kind, 6.0);
    }
}
