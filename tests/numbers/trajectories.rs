//! Quantities along a trajectory, and how the errors of the parameters carry over to them.

use crate::common::plans::{plan, recording, scatter, try_plan};
use nalgebra::DMatrix;
use serde_json::{Value, json};
use std::ops::ControlFlow;
use std::sync::Arc;
use trimtab_core::estimate::{Estimate, QuantityKind, Trajectory, TrajectorySeries};
use trimtab_core::flight::Maneuver;
use trimtab_core::job::{self, NoTrajectory};

/// x' = b, y = x, c = b x: everything along it has a closed form.
fn ramp() -> Value {
    json!({
        "name": "ramp",
        "parameters": {"a": {"start": 0.1}, "b": {"unit": "1/s", "start": 1.0}},
        "states": {"x": {"initial": "a", "derivative": "b"}},
        "definitions": {"c": {"unit": "1/s", "equation": "b*x"}},
        "outputs": {"y": {"equation": "x"}},
    })
}

fn recorded() -> Arc<Maneuver> {
    let time: Vec<f64> = (0..40).map(|k| 0.1 * f64::from(k)).collect();
    let y = |(k, t): (usize, &f64)| 0.4 + 1.2 * t + 0.1 * scatter(k, 2.0);
    let values = time.iter().enumerate().map(y).collect();
    recording(time, &[("y", values)])
}

fn fitted(model: Value, maneuver: &Arc<Maneuver>) -> (Estimate, Vec<Trajectory>) {
    let plan = plan(model, json!({}), std::slice::from_ref(maneuver));
    let result = job::run(&plan, &mut |_| ControlFlow::Continue(())).unwrap();
    let trajectories = job::trajectories_of(&plan, &result.estimate).unwrap();
    (result.estimate, trajectories)
}

fn series<'t>(trajectory: &'t Trajectory, name: &str) -> &'t TrajectorySeries {
    let mut all = trajectory.quantities.iter();
    all.find(|series| series.name == name).expect("a quantity")
}

#[test]
fn errors_of_the_parameters_carry_over_as_in_closed_form() {
    let (estimate, trajectories) = fitted(ramp(), &recorded());
    let [trajectory] = &trajectories[..] else {
        panic!("one segment");
    };
    let kinds: Vec<(&str, QuantityKind)> = (trajectory.quantities.iter())
        .map(|series| (series.name.as_str(), series.kind))
        .collect();
    let expected = [
        ("x", QuantityKind::State),
        ("c", QuantityKind::Definition),
        ("y", QuantityKind::Output),
    ];
    assert_eq!(kinds, expected);
    let [a, b] = [0, 1].map(|i| &estimate.parameters[i]);
    let errors = [a.standard_error.unwrap(), b.standard_error.unwrap()];
    let p = DMatrix::from_fn(2, 2, |i, j| {
        errors[i] * errors[j] * estimate.correlation[i][j]
    });
    let (a, b) = (a.estimate, b.estimate);
    for (k, t) in trajectory.time.iter().enumerate() {
        let x = a + b * t;
        // ∂/∂a and ∂/∂b
        for (name, value, slope) in [
            ("x", x, [1.0, *t]),
            ("c", b * x, [b, x + b * t]),
            ("y", x, [1.0, *t]),
        ] {
            let series = series(trajectory, name);
            let slope = DMatrix::from_row_slice(1, 2, &slope);
            let error = (&slope * &p * slope.transpose())[(0, 0)].sqrt();
            assert!((series.values[k] - value).abs() < 1e-12, "{name} at {t}");
            let ours = series.standard_errors[k];
            assert!(
                (ours / error - 1.0).abs() < 1e-9,
                "{name} at {t}: {ours}, {error}"
            );
        }
    }
}

/// The truth of a coefficient lies within two standard errors of it as often as the normal law says.
#[test]
fn bands_hold_the_truth() {
    const SEEDS: usize = 200;
    let time: Vec<f64> = (0..60).map(|k| 0.1 * f64::from(k)).collect();
    let mut inside = 0;
    for seed in 0..SEEDS {
        // a sum of twelve uniform numbers has variance 1/12 each
        let noise = |k: usize| {
            (0..12)
                .map(|n| scatter(12 * k + n, seed as f64))
                .sum::<f64>()
        };
        let y = |(k, t): (usize, &f64)| 0.4 + 1.2 * t + 0.2 * noise(k);
        let values = time.iter().enumerate().map(y).collect();
        let (_, trajectories) = fitted(ramp(), &recording(time.clone(), &[("y", values)]));
        let c = series(&trajectories[0], "c");
        let truth = 1.2 * (0.4 + 1.2 * time[30]);
        inside += usize::from((c.values[30] - truth).abs() < 1.96 * c.standard_errors[30]);
    }
    eprintln!("{inside} of {SEEDS} bands of 95 % hold the truth");
    // a binomial of 0.95 spreads by 3.1 of 200
    assert!((181..=199).contains(&inside), "{inside} of {SEEDS}");
}

/// Where the data do not show a parameter the estimate has no covariance to carry over.
#[test]
fn a_singular_estimate_has_a_trajectory_without_errors() {
    let mut model = ramp();
    model["parameters"]["unseen"] = json!({"start": 2.0});
    model["definitions"]["d"] = json!({"equation": "unseen*x"});
    let (_, trajectories) = fitted(model, &recorded());
    for series in &trajectories[0].quantities {
        assert!(series.standard_errors.is_empty(), "{}", series.name);
        assert_eq!(series.values.len(), 40);
    }
}

#[test]
fn what_has_no_trajectory_says_why() {
    let maneuver = recorded();
    let (estimate, _) = fitted(ramp(), &maneuver);
    let mut other = ramp();
    other["parameters"]["more"] = json!({"start": 1.0, "fixed": true});
    let plan = try_plan(other, json!({}), std::slice::from_ref(&maneuver)).unwrap();
    let refused = job::trajectories_of(&plan, &estimate).unwrap_err();
    assert_eq!(refused, NoTrajectory::OtherParameters);
}
