//! Channels that a job makes by formulas, and parts of recordings that it uses.

use std::sync::Arc;

use crate::common::plans::{parameter, plan, recording, scatter, solve, try_plan};
use serde_json::{Value, json};
use trimtab_core::flight::Maneuver;

const SAMPLES: usize = 400;

fn series(value: impl Fn(usize) -> f64) -> Vec<f64> {
    (0..SAMPLES).map(value).collect()
}

fn model() -> Value {
    json!({
        "name": "linear", "inputs": {"u": {}},
        "parameters": {"a": {"start": 0.0}, "b": {"start": 0.0}},
        "outputs": {"y": {"equation": "a*u + b"}},
    })
}

fn u(k: usize) -> f64 {
    (0.4 * k as f64).sin()
}

fn y(k: usize) -> f64 {
    1.5 * u(k) + 0.3 + 0.1 * scatter(k, 1.0)
}

/// A slow channel, with empty cells and held up to the rate of the other.
fn slow() -> Arc<Maneuver> {
    recording(
        series(|k| 0.02 * k as f64),
        &[
            ("u", series(u)),
            ("y", series(|k| if k % 5 == 0 { y(k) } else { f64::NAN })),
            ("y_held", series(|k| y(k - k % 5))),
        ],
    )
}

/// Held values taken for measured ones are late by two samples on average; those that are fresh are what was measured.
#[test]
fn what_is_fresh_of_a_held_channel_is_what_was_measured() {
    let of = |formula: &str| {
        let result = solve(model(), json!({"channels": {"y": formula}}), &[slow()]);
        let (a, b) = (parameter(&result, "a"), parameter(&result, "b"));
        (
            a.estimate,
            a.standard_error,
            b.estimate,
            result.estimate.outputs[0].samples,
        )
    };
    assert_eq!(of("fresh(y_held)"), of("y"));
    assert_eq!(of("fresh(y_held)").3, SAMPLES / 5);
    let off = |formula: &str| (of(formula).0 - 1.5).abs();
    println!("off by {} held, {} fresh", off("y_held"), off("y"));
    assert!(
        off("y_held") > 20.0 * off("y"),
        "a trap that is none needs no way around it"
    );
    assert!(off("y") < 3.0 * of("y").1.unwrap());
}

#[test]
fn a_part_is_said_in_rows_or_in_seconds() {
    let use_of = |part: Value| {
        let mut usage = json!({"id": slow().digest()});
        usage
            .as_object_mut()
            .unwrap()
            .extend(part.as_object().unwrap().clone());
        json!({"channels": {"y": "y_held"}, "maneuvers": [usage]})
    };
    let segment = |part: Value| {
        let plan = plan(model(), use_of(part), &[slow()]);
        let segment = &plan.problem.segments[0];
        (segment.time.clone(), segment.measured.clone())
    };
    // row 51 is at 1 s, row 151 at 3 s
    assert_eq!(
        segment(json!({"seconds": [1.0, 3.0]})),
        segment(json!({"rows": [51, 151]}))
    );
    assert_eq!(segment(json!({"seconds": [-5.0, 0.07]})).0.len(), 4);
    for (part, place) in [
        (json!({"seconds": [3.0, 1.0]}), "/maneuvers/0/seconds"),
        (json!({"seconds": [9.0, 12.0]}), "/maneuvers/0/seconds"),
        (
            json!({"seconds": [1.0, 2.0], "rows": [1, 9]}),
            "/maneuvers/0/rows",
        ),
    ] {
        let faults = try_plan(model(), use_of(part), &[slow()])
            .err()
            .expect("refused");
        assert_eq!(
            (faults[0].code.as_ref(), faults[0].pointer.as_str()),
            ("bad_rows", place)
        );
    }
}

#[test]
fn formulas_that_do_not_fit_are_faults_of_the_job() {
    let refused = |formula: &str, code: &str, expected: &str| {
        let changes = json!({"channels": {"y": formula}});
        let faults = try_plan(model(), changes, &[slow()])
            .err()
            .expect("refused");
        assert_eq!(
            (faults[0].code.as_ref(), faults[0].pointer.as_str()),
            (code, "/channels/y")
        );
        assert!(
            faults[0].message.contains(expected),
            "{}",
            faults[0].message
        );
    };
    refused(
        "smoothed(y_held, 30[Hz])",
        "bad_argument",
        "50.0000 samples a second",
    );
    refused("derivative(y_held, 2[Hz])", "unit_mismatch", "1/s");
    refused(
        "delayed(y_held, 2[m])",
        "unit_mismatch",
        "takes a time in seconds, not m",
    );
    refused(
        "lowpass(y_held, u)",
        "bad_argument",
        "one number, not a channel",
    );
    refused("y_held + 2[warp]", "syntax_error", "unknown unit 'warp'");
}
