//! Priors: what was known before the data counts as one more measured value.

use std::sync::Arc;

use crate::common::plans::{parameter, recording, scatter, solve, try_plan};
use nalgebra::{DMatrix, DVector};
use serde_json::{Value, json};
use trimtab_core::estimate::Outcome;
use trimtab_core::flight::Maneuver;

const SAMPLES: usize = 50;
const VARIANCE: f64 = 0.04;

fn time() -> Vec<f64> {
    (0..SAMPLES).map(|k| 0.1 * k as f64).collect()
}

fn measured() -> Vec<f64> {
    let value = |(k, t): (usize, f64)| 0.4 + 1.2 * t + 0.7 * scatter(k, 2.0);
    time().into_iter().enumerate().map(value).collect()
}

fn line() -> Arc<Maneuver> {
    recording(time(), &[("y", measured())])
}

/// y = a + b t, with b in degrees and a prior on it.
fn model() -> Value {
    json!({
        "name": "line",
        "parameters": {
            "a": {"start": 0.0},
            "b": {"unit": "deg/s", "start": 0.0, "prior": {"mean": 80.0, "sd": 2.0}},
        },
        "outputs": {"y": {"equation": "a + b*t"}},
    })
}

/// (Xᵀ X/r + P)⁻¹ (Xᵀ z/r + P m), and the covariance split into the data's part and the prior's.
#[test]
fn a_linear_problem_has_the_posterior_of_the_textbook() {
    let degree = 1.0_f64.to_radians();
    let (mean, sd) = (80.0 * degree, 2.0 * degree);
    let x = DMatrix::from_fn(SAMPLES, 2, |k, c| if c == 0 { 1.0 } else { time()[k] });
    let prior = DMatrix::from_diagonal(&DVector::from_vec(vec![0.0, sd.powi(-2)]));
    let data = x.transpose() * &x / VARIANCE;
    let covariance = (&data + &prior).try_inverse().unwrap();
    let right = x.transpose() * DVector::from_vec(measured()) / VARIANCE
        + &prior * DVector::from_vec(vec![0.0, mean]);
    let theta = &covariance * right;
    let from_prior = &covariance * &prior * &covariance;

    // a start that is nearly there already must not do
    let changes = json!({"options": {
        "tolerance": 1e-10, "noise": {"kind": "given", "variance": [VARIANCE]},
    }});
    let result = solve(model(), changes, &[line()]);
    assert_eq!(result.estimate.outcome, Outcome::Converged);
    for (i, (name, unit)) in [("a", 1.0), ("b", degree)].into_iter().enumerate() {
        let ours = parameter(&result, name);
        let bound = covariance[(i, i)].sqrt();
        assert!(
            (ours.estimate * unit - theta[i]).abs() < 1e-9 * bound,
            "{name}"
        );
        // the textbook's noise is white
        let conventional = ours.conventional_standard_error.unwrap();
        assert!((conventional * unit / bound - 1.0).abs() < 1e-9);
        let share = from_prior[(i, i)] / covariance[(i, i)];
        println!("{name}: {} ± {bound}, of it the prior's {share}", theta[i]);
        assert!(
            (ours.prior_share.unwrap() - share).abs() < 1e-9,
            "{name}: {share}"
        );
    }
    // J is the data's and the prior's
    let residuals = DVector::from_vec(measured()) - &x * &theta;
    let cost = 0.5 * residuals.norm_squared() / VARIANCE
        + 0.5 * SAMPLES as f64 * (std::f64::consts::TAU * VARIANCE).ln()
        + 0.5 * ((theta[1] - mean) / sd).powi(2);
    assert!((result.estimate.cost / cost - 1.0).abs() < 1e-12);
}

/// Only a + b shows in the data: a prior on b tells them apart, and all of b's bound is the prior's.
#[test]
fn a_prior_tells_apart_what_the_data_cannot() {
    let sum = json!({
        "name": "sum",
        "parameters": {"a": {"start": 0.0}, "b": {"start": 0.0}, "c": {"unit": "1/s", "start": 0.0}},
        "outputs": {"y": {"equation": "a + b + c*t"}},
    });
    let without = solve(sum.clone(), json!({}), &[line()]);
    assert_eq!(without.estimate.outcome, Outcome::Singular);
    assert!(parameter(&without, "c").prior_share.is_none());

    let known = json!({"parameters": {"b": {"prior": {"mean": 0.25, "sd": 0.5}}}});
    let with = solve(sum, known, &[line()]);
    assert_eq!(
        with.estimate.outcome,
        Outcome::Converged,
        "{}",
        with.estimate.reason
    );
    let b = parameter(&with, "b");
    // the data say nothing of b: it stays as it was known, to the solver's tolerance
    assert!((b.estimate - 0.25).abs() < 1e-4 * 0.5);
    assert!((b.standard_error.unwrap() / 0.5 - 1.0).abs() < 1e-6);
    assert!((b.prior_share.unwrap() - 1.0).abs() < 1e-6);
    let (a, c) = (parameter(&with, "a"), parameter(&with, "c"));
    assert!((0.9..1.0).contains(&a.prior_share.unwrap()));
    assert!(c.prior_share.unwrap() < 1e-6, "{:?}", c.prior_share);
}

/// The process noises follow the parameters among the unknowns, and have no prior.
#[test]
fn filter_error_has_shares_of_its_priors_too() {
    let changes = json!({
        "parameters": {"Ma": {"prior": {"mean": -3.4, "sd": 0.05}}},
        "options": {"estimator": "filter_error"},
    });
    let elevator = common::recordings::maneuver(common::recordings::elevator().as_bytes());
    let result = solve(json!("short-period"), changes, &[elevator]);
    let share = |name: &str| parameter(&result, name).prior_share.expect("a share");
    assert!(share("Ma") > 0.1 && share("Ma") < 1.0, "{}", share("Ma"));
    assert!(share("q_bias") < share("Ma"), "{}", share("q_bias"));
}

#[test]
fn a_prior_that_is_none_is_refused() {
    for (prior, pointer) in [
        (json!({"mean": 1.0, "sd": 0.0}), "/parameters/b/prior"),
        (json!({"mean": 1.0, "sd": -2.0}), "/parameters/b/prior"),
        (json!({"mean": 1.0, "sd": 1e-200}), "/parameters/b/prior"),
    ] {
        let changes = json!({"parameters": {"b": {"prior": prior}}});
        let faults = try_plan(model(), changes, &[line()])
            .err()
            .expect("a fault");
        assert_eq!(
            (faults[0].pointer.as_str(), &*faults[0].code),
            (pointer, "bad_prior")
        );
    }
}
