//! Estimation from simulated recordings: recovers the truth, and says why where it cannot.

use std::ops::ControlFlow;
use std::sync::Arc;

use indexmap::IndexMap;
use serde_json::{Value, json};
use trimtab_core::estimate::{Bound, Evaluator, NormalEquations, Outcome, Progress};
use trimtab_core::flight::{Channel, Maneuver, Unit};
use trimtab_core::job::{self, Faults, JobResult, JobSpec, ModelSource};

/// x' = a x + b u, x(0) = x0; y = x + c. Exact data for a = -2, b = 3, c = 0.5, with some noise.
fn model() -> Value {
    json!({
        "name": "first-order",
        "inputs": {"u": {}},
        "parameters": {
            "a": {"unit": "1/s", "start": -1.0}, "b": {"unit": "1/s", "start": 1.0}, "c": {"start": 0.0},
        },
        "states": {"x": {"initial": "0", "derivative": "a*x + b*u"}},
        "outputs": {"y": {"equation": "x + c"}},
    })
}

fn maneuver(noise: f64) -> Arc<Maneuver> {
    let step = 0.02;
    let u: Vec<f64> = (0..500)
        .map(|k| if (k / 60) % 2 == 0 { 1.0 } else { -0.5 })
        .collect();
    let (mut x, mut y) = (0.0_f64, Vec::new());
    for k in 0..500 {
        // a fixed sequence without structure stands for noise
        let scatter = ((k as f64 * 12.9898).sin() * 43_758.547).fract();
        y.push(x + 0.5 + noise * scatter);
        if k + 1 < 500 {
            // the classical Runge-Kutta step with linear inputs, written out
            let (u0, u1) = (u[k], u[k + 1]);
            let f = |x: f64, u: f64| -2.0 * x + 3.0 * u;
            let k1 = f(x, u0);
            let k2 = f(x + step / 2.0 * k1, (u0 + u1) / 2.0);
            let k3 = f(x + step / 2.0 * k2, (u0 + u1) / 2.0);
            let k4 = f(x + step * k3, u1);
            x += step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        }
    }
    let channel = |values: Vec<f64>| Channel::from_recorded("-", Unit::NONE, values);
    let channels = IndexMap::from([("u".to_string(), channel(u)), ("y".to_string(), channel(y))]);
    Arc::new(
        Maneuver::new((0..500).map(|k| f64::from(k) * step).collect(), channels)
            .expect("a maneuver"),
    )
}

fn try_solve(model: Value, changes: Value, maneuver: &Arc<Maneuver>) -> Result<JobResult, Faults> {
    let mut spec = json!({"model": model, "maneuvers": [{"id": maneuver.digest()}]});
    for (key, value) in changes.as_object().expect("an object") {
        spec[key] = value.clone();
    }
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    let ModelSource::Document(document) = &spec.model else {
        panic!("a document")
    };
    let plan = job::prepare(&spec, document, std::slice::from_ref(maneuver))?;
    job::run(&plan, &mut |_| ControlFlow::Continue(()))
}

fn solve(model: Value, changes: Value, maneuver: &Arc<Maneuver>) -> JobResult {
    try_solve(model, changes, maneuver).unwrap_or_else(|faults| panic!("{faults:#?}"))
}

fn value(result: &JobResult, name: &str) -> f64 {
    result
        .estimate
        .parameters
        .iter()
        .find(|p| p.name == name)
        .expect("the parameter")
        .estimate
}

#[test]
fn recovers_the_truth_within_its_own_error_bounds() {
    for method in ["gauss_newton", "levenberg_marquardt"] {
        let result = solve(
            model(),
            json!({"options": {"method": method}}),
            &maneuver(0.01),
        );
        assert_eq!(
            result.estimate.outcome,
            Outcome::Converged,
            "{}",
            result.estimate.reason
        );
        for (name, truth) in [("a", -2.0), ("b", 3.0), ("c", 0.5)] {
            let row = result
                .estimate
                .parameters
                .iter()
                .find(|p| p.name == name)
                .expect("the parameter");
            let bound = row.standard_error.expect("an error bound");
            assert!(
                (row.estimate - truth).abs() < 4.0 * bound,
                "{method} {name}: {} ± {bound}",
                row.estimate
            );
            assert!(bound < 0.05 * truth.abs());
        }
        assert!(result.estimate.outputs[0].r_squared > 0.999);
    }
}

#[test]
fn without_noise_it_finds_the_truth_to_rounding() {
    let result = solve(
        model(),
        json!({"options": {"noise": {"kind": "given", "variance": [1e-4]}}}),
        &maneuver(0.0),
    );
    for (name, truth) in [("a", -2.0), ("b", 3.0), ("c", 0.5)] {
        assert!(
            (value(&result, name) - truth).abs() < 1e-7,
            "{name} = {}",
            value(&result, name)
        );
    }
}

#[test]
fn a_full_covariance_of_one_output_is_the_diagonal_one() {
    let diagonal = solve(model(), json!({}), &maneuver(0.01));
    let noise = json!({"options": {"noise": {"kind": "estimated", "structure": "full"}}});
    let full = solve(model(), noise, &maneuver(0.01));
    for name in ["a", "b", "c"] {
        assert!((value(&diagonal, name) - value(&full, name)).abs() < 1e-6);
    }
    assert!((diagonal.estimate.cost - full.estimate.cost).abs() < 1e-6);
}

#[test]
fn units_of_parameters_are_those_of_the_document() {
    let mut in_degrees = model();
    in_degrees["parameters"]["c"] = json!({"unit": "deg", "start": 10.0});
    let result = solve(in_degrees, json!({}), &maneuver(0.01));
    assert!((value(&result, "c") - 0.5_f64.to_degrees()).abs() < 0.1);
}

#[test]
fn two_parameters_that_only_appear_as_a_sum_are_named() {
    let mut redundant = model();
    redundant["parameters"]["d"] = json!({"start": 0.0});
    redundant["outputs"]["y"]["equation"] = json!("x + c + d");
    redundant["parameters"]["idle"] = json!({"start": 1.0});
    let result = solve(redundant, json!({}), &maneuver(0.01));
    let estimate = &result.estimate;
    assert_eq!(estimate.outcome, Outcome::Singular);
    let mut sets: Vec<Vec<String>> = estimate
        .collinear
        .iter()
        .map(|set| set.parameters.clone())
        .collect();
    sets.sort();
    assert_eq!(
        sets,
        vec![
            vec!["c".to_string(), "d".to_string()],
            vec!["idle".to_string()]
        ]
    );
    let pair = estimate
        .collinear
        .iter()
        .find(|set| set.parameters.len() == 2)
        .expect("the pair");
    assert!(
        (pair.direction[0] + pair.direction[1]).abs() < 1e-6,
        "{:?}",
        pair.direction
    );
    let bound = |name: &str| {
        estimate
            .parameters
            .iter()
            .find(|p| p.name == name)
            .expect("it")
            .standard_error
    };
    assert!(
        bound("a").is_some()
            && bound("c").is_none()
            && bound("d").is_none()
            && bound("idle").is_none()
    );
    // what can be told is told: the sum
    assert!((value(&result, "c") + value(&result, "d") - 0.5).abs() < 0.01);
}

#[test]
fn a_bound_is_kept_and_said() {
    let result = solve(
        model(),
        json!({"parameters": {"a": {"lower": -1.5}}}),
        &maneuver(0.01),
    );
    assert_eq!(result.estimate.outcome, Outcome::AtBound);
    let a = result
        .estimate
        .parameters
        .iter()
        .find(|p| p.name == "a")
        .expect("a");
    assert_eq!(
        (a.estimate, a.at_bound, a.standard_error),
        (-1.5, Some(Bound::Lower), None)
    );
    // a bound that is not reached changes nothing
    let free = solve(model(), json!({}), &maneuver(0.01));
    let wide = solve(
        model(),
        json!({"parameters": {"a": {"lower": -5.0, "upper": 0.0}}}),
        &maneuver(0.01),
    );
    assert!((value(&free, "a") - value(&wide, "a")).abs() < 1e-6);
}

#[test]
fn the_budget_and_a_request_to_stop_end_it_with_what_there_is() {
    let result = solve(
        model(),
        json!({"options": {"max_iterations": 1, "start": {"kind": "document"}}}),
        &maneuver(0.01),
    );
    assert_eq!(
        (result.estimate.outcome, result.estimate.iterations),
        (Outcome::Budget, 1)
    );
    let recording = maneuver(0.01);
    let spec: JobSpec =
        serde_json::from_value(json!({"model": model(), "maneuvers": [{"id": "x"}], "options": {"start": {"kind": "document"}}}))
            .expect("a spec");
    let ModelSource::Document(document) = &spec.model else {
        panic!("a document")
    };
    let plan = job::prepare(&spec, document, &[recording]).unwrap_or_else(|f| panic!("{f:?}"));
    let mut told = 0;
    let result = job::run(&plan, &mut |progress| match progress {
        Progress::Iteration(iteration) => {
            told += 1;
            if iteration.number == 2 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        }
        Progress::Start(_) | Progress::Step(_) => ControlFlow::Continue(()),
    });
    assert_eq!(
        result.expect("a result").estimate.outcome,
        Outcome::Cancelled
    );
    assert_eq!(told, 3);
}

#[test]
fn a_start_that_diverges_at_once_names_the_place() {
    let changes = json!({
        "parameters": {"a": {"start": 1e6}}, "options": {"start": {"kind": "document"}},
    });
    let faults = try_solve(model(), changes, &maneuver(0.01)).expect_err("a fault");
    assert_eq!(
        (faults[0].pointer.as_str(), &*faults[0].code),
        ("/parameters", "diverged_at_start")
    );
    assert!(
        faults[0].message.contains("in segment 1 at"),
        "{}",
        faults[0].message
    );
}

#[test]
fn an_effect_is_an_edit_whose_zero_is_the_model_before() {
    let edited = json!({"edits": [{"kind": "sensor_scale", "target": "y"}, {"kind": "missing_term", "target": "x", "term": "x^2", "parameter": "axx"}]});
    let mut fixed = edited.clone();
    fixed["parameters"] = json!({"y_scale": {"fixed": true}, "axx": {"fixed": true}});
    let before = solve(model(), json!({}), &maneuver(0.01));
    let same = solve(model(), fixed, &maneuver(0.01));
    // not to the last bit: one more parameter is other work, whose sums are in another order
    let (cost, with_zero) = (before.estimate.cost, same.estimate.cost);
    assert!((with_zero / cost - 1.0).abs() < 1e-12, "{cost} {with_zero}");
    assert_eq!(same.model.outputs["y"].equation, "(1 + y_scale)*(x + c)");
    assert_eq!(same.model.states["x"].derivative, "a*x + b*u + axx*(x^2)");
    assert_eq!(same.model.parameters["axx"].unit, "1/s");
    let freed = solve(model(), edited, &maneuver(0.01));
    assert!(freed.estimate.cost <= before.estimate.cost);
    assert!(value(&freed, "axx").abs() < 0.1, "{}", value(&freed, "axx"));
}

#[test]
fn all_parameters_at_their_bounds_is_a_result() {
    let mut model = model();
    model["states"] = json!({});
    model["outputs"]["y"]["equation"] = json!("c*u");
    let only = json!({"c": {"start": 0.1, "upper": 0.2}});
    model["parameters"] = only;
    let result = solve(model, json!({}), &maneuver(0.01));
    assert_eq!(
        (result.estimate.outcome, value(&result, "c")),
        (Outcome::AtBound, 0.2)
    );
}

#[test]
fn bounds_are_let_go_where_the_minimum_is_inside() {
    let free = solve(model(), json!({}), &maneuver(0.01));
    for method in ["gauss_newton", "levenberg_marquardt"] {
        let starts = json!({
            "a": {"start": -0.2, "upper": -0.2}, "b": {"start": 9.0, "upper": 9.0}, "c": {"start": 2.0, "lower": 0.4, "upper": 2.0},
        });
        let bounded = solve(
            model(),
            json!({"parameters": starts, "options": {"method": method}}),
            &maneuver(0.01),
        );
        assert_eq!(
            bounded.estimate.outcome,
            Outcome::Converged,
            "{method}: {}",
            bounded.estimate.reason
        );
        for name in ["a", "b", "c"] {
            assert!(
                (value(&free, name) - value(&bounded, name)).abs() < 1e-5,
                "{method} {name}"
            );
        }
    }
}

#[test]
fn bounds_are_in_the_unit_of_the_parameter() {
    let mut in_degrees = model();
    in_degrees["parameters"]["c"] =
        json!({"unit": "deg", "start": 10.0, "lower": 0.0, "upper": 20.0});
    let result = solve(in_degrees, json!({}), &maneuver(0.01));
    assert_eq!(result.estimate.outcome, Outcome::AtBound);
    assert!((value(&result, "c") - 20.0).abs() < 1e-12);
}

/// d(0^n)/dn is 0, where the general formula has ln 0. With u of 1 or below 0 nothing here depends on n: that is
/// said, where a derivative that is no number would end the job at its start.
#[test]
fn a_power_of_zero_has_a_derivative_by_its_exponent() {
    let mut model = model();
    model["states"] = json!({});
    model["parameters"] = json!({"c": {"start": 0.3}, "n": {"start": 1.2}});
    model["outputs"]["y"]["equation"] = json!("c*max(u, 0)^n + 0.1*u");
    let estimate = solve(model, json!({}), &maneuver(0.01)).estimate;
    assert_eq!(estimate.outcome, Outcome::Singular, "{}", estimate.reason);
    assert_eq!(estimate.collinear.len(), 1);
    assert_eq!(estimate.collinear[0].parameters, ["n"]);
}

#[test]
fn sizes_are_bounded_before_anything_is_made() {
    let recording = maneuver(0.01);
    let refusal = |changes: Value| {
        let mut spec = json!({"model": model(), "maneuvers": [{"id": "x"}]});
        for (key, value) in changes.as_object().expect("an object") {
            spec[key] = value.clone();
        }
        let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
        let ModelSource::Document(document) = &spec.model else {
            panic!("a document")
        };
        let recordings = vec![recording.clone(); spec.maneuvers.len()];
        job::prepare(&spec, document, &recordings)
            .err()
            .expect("a refusal")[0]
            .clone()
    };
    let same = json!({"maneuvers": [{"id": "x", "label": "run"}, {"id": "x", "label": "run"}]});
    assert_eq!(refusal(same).code, "duplicate_label");
    let mut many = model();
    many["parameters"]["c"]["per"] = json!("maneuver");
    many["parameters"]["a"]["per"] = json!("maneuver");
    many["parameters"]["b"]["per"] = json!("maneuver");
    for i in 0..3 {
        many["parameters"][format!("c{i}")] = json!({"start": 0.0, "per": "maneuver"});
    }
    let uses: Vec<Value> = (0..200).map(|_| json!({"id": "x"})).collect();
    assert_eq!(
        refusal(json!({"model": many, "maneuvers": uses})).code,
        "job_too_large"
    );
    let tolerance = refusal(json!({"options": {"tolerance": 1e308}}));
    assert_eq!(
        (&*tolerance.code, tolerance.pointer.as_str()),
        ("bad_option", "/options/tolerance")
    );
}

#[test]
fn several_threads_give_the_numbers_of_one() {
    let maneuvers: Vec<Arc<Maneuver>> = (0..9).map(|i| maneuver(0.01 * f64::from(i))).collect();
    let model = json!({
        "name": "first-order",
        "inputs": {"u": {}},
        "parameters": {
            "a": {"unit": "1/s", "start": -1.0}, "b": {"unit": "1/s", "start": 1.0},
            "c": {"start": 0.1, "per": "maneuver"},
        },
        "states": {"x": {"initial": "0", "derivative": "a*x + b*u"}},
        "outputs": {"y": {"equation": "x + c"}},
    });
    let plan = crate::common::plans::plan(model, json!({}), &maneuvers);
    let problem = &plan.problem;
    let theta = problem.unknowns.start();
    let equations = |mut evaluator: Evaluator<'_>| {
        let found = NormalEquations::at(&mut evaluator, &theta).expect("a cost");
        (found.information, found.descent)
    };
    let one = equations(Evaluator::new(problem));
    for threads in [1, 2, 3, 4, 16] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.expect("threads");
        let several = pool.install(|| equations(Evaluator::on_all_cores(problem)));
        assert_eq!(several, one, "{threads} threads");
    }
}
