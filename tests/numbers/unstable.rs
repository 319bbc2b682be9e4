//! An unstable plant under feedback: no simulation follows it, and the answer of output error says so.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::common::plans::{parameter, plan, recording, scatter};
use serde_json::{Value, json};
use trimtab_core::flight::{Maneuver, Severity};
use trimtab_core::job::{self, JobResult};

const A: f64 = 900.0;
const B: f64 = -150.0;
const STEP: f64 = 0.005;
const SAMPLES: usize = 1000;

/// y'' = A y + B u with u = 12 y + 0.3 y' + dither, held between samples: exact by many small steps.
fn closed_loop() -> Arc<Maneuver> {
    let (mut y, mut v) = (0.0, 0.0);
    let (mut us, mut ys) = (Vec::new(), Vec::new());
    let fine = 100;
    for k in 0..SAMPLES {
        let dither = 0.02 * if (k / 17) % 2 == 0 { 1.0 } else { -1.0 } + 0.01 * scatter(k / 5, 2.0);
        let u = 12.0 * y + 0.3 * v + dither;
        us.push(u);
        ys.push(y + 2e-5 * scatter(k, 5.0));
        let h = STEP / f64::from(fine);
        for _ in 0..fine {
            // the midpoint rule
            let (y_half, v_half) = (y + 0.5 * h * v, v + 0.5 * h * (A * y + B * u));
            y += h * v_half;
            v += h * (A * y_half + B * u);
        }
    }
    let time = (0..SAMPLES).map(|k| k as f64 * STEP).collect();
    recording(time, &[("u", us), ("y", ys)])
}

fn model() -> Value {
    json!({
        "name": "unstable plant", "inputs": {"u": {}},
        "parameters": {
            "a": {"unit": "1/s^2", "start": A}, "b": {"unit": "1/s^2", "start": B},
            "y_0": {"start": "first(y)", "per": "maneuver"},
            "v_0": {"unit": "1/s", "start": 0.0, "per": "maneuver"},
        },
        "states": {
            "y": {"initial": "y_0", "derivative": "v"},
            "v": {"unit": "1/s", "initial": "v_0", "derivative": "a*y + b*u"},
        },
        "outputs": {"y": {"equation": "y"}},
    })
}

fn solve(options: Value) -> JobResult {
    let plan = plan(model(), json!({"options": options}), &[closed_loop()]);
    job::run(&plan, &mut |_| ControlFlow::Continue(())).unwrap_or_else(|f| panic!("{f:#?}"))
}

/// Nothing is said of steps, of instability or of a poor fit.
fn assert_no_doubt(result: &JobResult) {
    let found = &result.estimate.findings;
    for code in [
        "step_too_long",
        "mode_at_edge",
        "unstable_model",
        "second_look",
    ] {
        assert!(
            found.iter().all(|finding| finding.code != code),
            "{found:#?}"
        );
    }
}

#[test]
fn output_error_says_that_it_cannot_follow_and_what_filter_error_finds() {
    let result = solve(json!({"input_interpolation": "hold"}));
    let found = result.estimate.findings;
    let finding = found
        .iter()
        .find(|finding| finding.code == "unstable_model");
    let finding = finding.unwrap_or_else(|| panic!("{found:#?}"));
    assert_eq!(finding.severity, Severity::Warning);
    assert!(
        finding.message.contains("30.000 1/s"),
        "{}",
        finding.message
    );
    assert!(
        finding.message.contains("filter error finds a = "),
        "{}",
        finding.message
    );
    assert!(finding.remedy.contains("filter_error"));
    let filtered = solve(json!({"input_interpolation": "hold", "estimator": "filter_error"}));
    for (name, truth) in [("a", A), ("b", B)] {
        let row = parameter(&filtered, name);
        let error = row.standard_error.expect("an error");
        assert!(
            (row.estimate - truth).abs() < 4.0 * error,
            "{name}: {} ± {error}",
            row.estimate
        );
        assert!(error < 0.05 * truth.abs(), "{name} ± {error}");
    }
    assert_no_doubt(&filtered);
}

/// The same equations, stable: nothing to say.
#[test]
fn a_stable_model_has_no_such_finding() {
    let mut stable = model();
    stable["parameters"]["a"]["start"] = json!(-4.0);
    let u: Vec<f64> = (0..400)
        .map(|k| if (k / 40) % 2 == 0 { 1.0 } else { -1.0 })
        .collect();
    let (mut y, mut v, mut ys) = (0.0, 0.0, Vec::new());
    for (k, u) in u.iter().enumerate() {
        ys.push(y + 0.01 * scatter(k, 1.0));
        for _ in 0..50 {
            let h = 0.02 / 50.0;
            (y, v) = (y + h * v, v + h * (-5.0 * y - 0.8 * v + u));
        }
    }
    stable["parameters"]["c"] = json!({"unit": "1/s", "start": -0.5});
    stable["parameters"]["b"]["start"] = json!(0.7);
    stable["states"]["v"]["derivative"] = json!("a*y + b*u + c*v");
    let time = (0..400).map(|k| f64::from(k) * 0.02).collect();
    let maneuver = recording(time, &[("u", u), ("y", ys)]);
    let options = json!({"options": {"input_interpolation": "hold"}});
    let plan = plan(stable, options, &[maneuver]);
    let result = job::run(&plan, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_no_doubt(&result);
}
