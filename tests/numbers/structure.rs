//! Structure determination, against an independent computation and known truth.

use std::ops::ControlFlow;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde_json::{Value, json};
use trimtab_core::flight::Maneuver;
use trimtab_core::job::{self, JobResult};
use trimtab_core::structure::{
    Candidates, StructureMethod, StructureOptions, Verdict, orthogonal, stepwise,
};

use crate::common::plans::{recording, try_plan};

fn options(method: StructureMethod) -> StructureOptions {
    let mut options: StructureOptions =
        serde_json::from_value(json!({"output": "z", "variables": ["x"]})).expect("options");
    options.method = method;
    options
}

/// Four regressors of 60 samples, made by a formula that any program has: the second nearly depends on the first.
fn table() -> Candidates {
    let samples = 60;
    let column = |f: fn(f64) -> f64| DVector::from_fn(samples, |k, _| f(k as f64));
    let a = column(|k| (0.37 * k).sin());
    let b = column(|k| (0.37 * k + 0.4).sin() + 0.1 * (1.3 * k).cos());
    let c = column(|k| (0.11 * k * k).cos());
    let d = column(|k| (0.05 * k).powi(2) - 3.0);
    let noise = column(|k| 0.3 * ((k * 12.9898).sin() * 43_758.547).fract());
    let response = &a * 2.0 - &c * 0.7 + noise + DVector::from_element(samples, 0.4);
    Candidates {
        names: ["a", "b", "c", "d"].map(String::from).to_vec(),
        columns: DMatrix::from_columns(&[a, b, c, d]),
        response,
        constant: true,
    }
}

/// Numbers of numpy 2.4, where each subset was fitted by numpy.linalg.lstsq, F was made from the difference of two sums of
/// squares, and PRESS by leaving out one sample after the other (tests/python/structure.py).
#[test]
fn steps_are_those_of_an_independent_computation() {
    let found = stepwise(&table(), &options(StructureMethod::Stepwise)).expect("a structure");
    for step in &found.steps {
        println!("{step:?}");
    }
    let expected: [(&str, f64, f64, f64, f64); STEPS.len()] = STEPS;
    assert_eq!(found.steps.len(), expected.len() + 1);
    for (step, (term, partial_f, r_squared, pse, press)) in found.steps[1..].iter().zip(expected) {
        assert_eq!(step.term.as_deref(), Some(term));
        for (found, expected) in [
            (step.partial_f.expect("an F"), partial_f),
            (step.r_squared, r_squared),
            (step.pse, pse),
            (step.press, press),
        ] {
            assert!(
                (found / expected - 1.0).abs() < 1e-8,
                "{term}: {found} {expected}"
            );
        }
    }
    let ordered = orthogonal(&table(), &options(StructureMethod::Orthogonal)).expect("a structure");
    let order: Vec<&str> = ordered.steps[1..]
        .iter()
        .filter_map(|s| s.term.as_deref())
        .collect();
    assert_eq!(order, ORDER);
    for (step, pse) in ordered.steps.iter().zip(ORDER_PSE) {
        assert!(
            (step.pse / pse - 1.0).abs() < 1e-8,
            "{}: {}",
            step.number,
            step.pse
        );
    }
    assert_eq!(ordered.kept, KEPT);
}

include!("structure_reference.rs");

/// A term that came in first because it stands for two goes out when these are in.
#[test]
fn a_term_that_others_make_superfluous_goes_out() {
    let samples = 200;
    let noise = normal(7, 3 * samples);
    let column = |i: usize| DVector::from_column_slice(&noise[i * samples..(i + 1) * samples]);
    let (a, b) = (column(0), column(1));
    let sum = &a + &b + column(2) * 0.3;
    let response = &a + &b;
    let quiet = DVector::from_fn(samples, |k, _| 0.05 * (k as f64 * 1.7).sin());
    let candidates = Candidates {
        names: ["a", "b", "sum"].map(String::from).to_vec(),
        columns: DMatrix::from_columns(&[a, b, sum]),
        response: response + quiet,
        constant: true,
    };
    let found = stepwise(&candidates, &options(StructureMethod::Stepwise)).expect("a structure");
    let told: Vec<(Verdict, &str)> = found.steps[1..]
        .iter()
        .map(|step| (step.verdict, step.term.as_deref().unwrap_or_default()))
        .collect();
    assert_eq!(told[0], (Verdict::Entered, "sum"));
    assert!(told.contains(&(Verdict::Removed, "sum")), "{told:?}");
    let names: Vec<&str> = found.terms.iter().map(|term| term.term.as_str()).collect();
    assert!(
        names.contains(&"a") && names.contains(&"b") && !names.contains(&"sum"),
        "{names:?}"
    );
}

fn normal(seed: u64, count: usize) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..count)
        .map(|_| StandardNormal.sample(&mut rng))
        .collect()
}

/// Pitching moment coefficient over angle of attack, pitch rate and elevator; three of nine terms are there.
fn coefficient(seed: u64) -> Arc<Maneuver> {
    let samples = 500;
    let t = |k: usize| k as f64 * 0.04;
    let alpha: Vec<f64> = (0..samples)
        .map(|k| 0.1 + 0.08 * (0.9 * t(k)).sin() + 0.03 * (2.3 * t(k)).sin())
        .collect();
    let q: Vec<f64> = (0..samples)
        .map(|k| 0.01 * (1.4 * t(k) + 0.3).cos() + 0.004 * (3.1 * t(k)).sin())
        .collect();
    let de: Vec<f64> = (0..samples)
        .map(|k| 0.1 * (0.6 * t(k)).cos() * (0.21 * t(k)).sin())
        .collect();
    let noise = normal(seed, samples);
    let cm = (0..samples).map(|k| {
        0.05 - 0.7 * alpha[k] - 12.0 * q[k] - 1.1 * de[k]
            + 6.0 * alpha[k] * alpha[k]
            + 0.004 * noise[k]
    });
    let cm = cm.collect();
    recording(
        (0..samples).map(t).collect(),
        &[("alpha", alpha), ("q", q), ("de", de), ("Cm", cm)],
    )
}

fn model() -> Value {
    json!({
        "name": "moment",
        "inputs": {"alpha": {}, "q": {}, "de": {}},
        "outputs": {"Cm": {"equation": "0"}},
    })
}

fn run(structure: Value, maneuvers: &[Arc<Maneuver>]) -> JobResult {
    let changes = json!({"kind": "structure", "structure": structure});
    let plan = try_plan(model(), changes, maneuvers).unwrap_or_else(|faults| panic!("{faults:#?}"));
    job::run_structure(&plan, &mut |_| ControlFlow::Continue(()))
        .unwrap_or_else(|faults| panic!("{faults:#?}"))
}

/// 40 seeds: the true terms are all found, and few others; estimates are unbiased where the structure is the true one.
#[test]
fn the_terms_of_a_known_equation_are_found() {
    let truth = ["1", "alpha", "q", "de", "alpha^2"];
    for method in ["stepwise", "orthogonal"] {
        let (mut all, mut others, mut errors) = (0, 0, Vec::new());
        for seed in 0..40 {
            let structure = json!({"output": "Cm", "method": method, "variables": ["alpha", "q", "de"], "f_to_enter": 12.0, "f_to_remove": 12.0});
            let result = run(structure, &[coefficient(seed)]);
            let found = result.structure.expect("a structure");
            assert_eq!(found.candidates, 9);
            let names: Vec<&str> = found.terms.iter().map(|term| term.term.as_str()).collect();
            all += usize::from(truth.iter().all(|term| names.contains(term)));
            others += names.iter().filter(|term| !truth.contains(term)).count();
            let de = result
                .estimate
                .parameters
                .iter()
                .find(|row| row.name == "Cm_de")
                .expect("Cm_de");
            errors.push((de.estimate + 1.1) / de.standard_error.expect("an error bound"));
            // the model is one that can be fitted, and says what was found
            let equation = &result.model.outputs["Cm"].equation;
            assert_eq!(equation, &found.equation);
            assert!(equation.contains("Cm_alpha2*alpha^2"), "{equation}");
        }
        println!("{method}: all in {all} of 40, {others} others");
        assert!(all >= 39, "{method}: {all}");
        assert!(others <= 12, "{method}: {others}");
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        assert!(mean.abs() < 3.0 / 40.0_f64.sqrt(), "{method}: {mean}");
    }
}

/// Terms of one's own, two maneuvers, one held out: it is predicted with what was found.
#[test]
fn own_terms_and_a_held_out_maneuver() {
    let two = [coefficient(1), coefficient(2)];
    let ids: Vec<Value> = two
        .iter()
        .zip(["estimation", "validation"])
        .map(|(m, role)| json!({"id": m.digest(), "role": role}))
        .collect();
    let changes = json!({
        "kind": "structure", "maneuvers": ids,
        "structure": {"output": "Cm", "terms": ["alpha", "q", "de", "sin(alpha)*alpha", "de*(alpha + q)"], "constant": true},
    });
    let plan = try_plan(model(), changes, &two).unwrap_or_else(|faults| panic!("{faults:#?}"));
    let result = job::run_structure(&plan, &mut |_| ControlFlow::Continue(())).expect("a result");
    let found = result.structure.expect("a structure");
    assert!(
        found
            .terms
            .iter()
            .any(|term| term.term == "sin(alpha)*alpha"),
        "{:?}",
        found.terms
    );
    let prediction = &result.estimate.prediction[0];
    assert!(prediction.outputs[0].r_squared > 0.98, "{prediction:?}");
    assert!((prediction.outputs[0].rms / 0.004 - 1.0).abs() < 0.2);
}

#[test]
fn what_cannot_be_searched_is_refused_by_name() {
    let maneuver = coefficient(1);
    let refused = |changes: Value| -> Vec<(String, String)> {
        let tried = try_plan(model(), changes, std::slice::from_ref(&maneuver));
        let faults = tried.err().expect("a refusal");
        faults
            .iter()
            .map(|fault| (fault.pointer.clone(), fault.code.to_string()))
            .collect()
    };
    let structure = |changes: Value| {
        let mut structure = json!({"output": "Cm", "variables": ["alpha"]});
        for (key, value) in changes.as_object().unwrap() {
            structure[key] = value.clone();
        }
        json!({"kind": "structure", "structure": structure})
    };
    let pair = |pointer: &str, code: &str| vec![(pointer.to_string(), code.to_string())];
    assert_eq!(
        refused(json!({"kind": "structure"})),
        pair("/structure", "bad_option")
    );
    let mut other = structure(json!({}));
    other["kind"] = json!("estimate");
    assert_eq!(refused(other), pair("/structure", "bad_option"));
    for (changes, pointer, code) in [
        (
            json!({"output": "Cl"}),
            "/structure/output/Cl",
            "unknown_output",
        ),
        (
            json!({"variables": ["beta"]}),
            "/structure/variables/beta",
            "unknown_channel",
        ),
        (
            json!({"variables": ["alpha", "alpha"]}),
            "/structure/variables/1",
            "bad_option",
        ),
        (json!({"variables": []}), "/structure/terms", "bad_option"),
        (
            json!({"terms": ["alpha +"]}),
            "/structure/terms/0",
            "syntax_error",
        ),
        (
            json!({"terms": ["beta"]}),
            "/structure/terms/0",
            "unknown_channel",
        ),
        (json!({"order": 9}), "/structure/order", "bad_option"),
        (
            json!({"f_to_remove": 5.0}),
            "/structure/f_to_remove",
            "bad_option",
        ),
        (
            json!({"least_r_squared": 2.0}),
            "/structure/least_r_squared",
            "bad_option",
        ),
        (
            json!({"most_terms": 0}),
            "/structure/most_terms",
            "bad_option",
        ),
    ] {
        assert_eq!(
            refused(structure(changes.clone())),
            pair(pointer, code),
            "{changes}"
        );
    }
    let mut frequency = structure(json!({}));
    frequency["options"] =
        json!({"estimator": "output_error_frequency", "frequency": {"band_hz": [0.1, 1.0]}});
    assert_eq!(refused(frequency), pair("/options/estimator", "bad_option"));
}
