//! The likelihood's derivatives against differences, and its error bounds against many seeds.

use std::ops::ControlFlow;
use std::sync::Arc;

use indexmap::IndexMap;
use serde_json::{Value, json};
use trimtab_core::estimate::{Evaluator, NormalEquations};
use trimtab_core::flight::{Channel, Maneuver, Unit};
use trimtab_core::job::{self, JobSpec, ModelSource, Plan};
use trimtab_core::model::{Model, catalog};
use trimtab_core::simulate::Scenario;

/// A fixed sequence without structure.
fn scatter(k: usize, seed: f64) -> f64 {
    ((k as f64 * 12.9898 + seed).sin() * 43_758.547).fract()
}

/// Two states, three outputs, parameters of each segment's own, time in the equations, a parameter in degrees.
fn model() -> Value {
    json!({
        "name": "everything",
        "inputs": {"u": {}},
        "parameters": {
            "a": {"unit": "1/s", "start": -0.8}, "b": {"unit": "1/s", "start": 1.2}, "c": {"start": 0.1},
            "w": {"unit": "1/s", "start": 2.0}, "x0": {"start": 0.3, "per": "maneuver"},
            "bias": {"start": 0.05, "per": "maneuver"}, "d": {"unit": "deg/s", "start": 0.7}, "k": {"start": 1.1},
        },
        "states": {
            "x": {"initial": "x0", "derivative": "a*x + b*u + c*w*v"},
            "v": {"initial": "c*x0", "derivative": "-w*x - 0.5*w*v + d*t*w"},
        },
        "outputs": {
            "y": {"equation": "k*x + bias + d*t"}, "z": {"equation": "v*x + bias^2"}, "q": {"equation": "k*u + c"},
        },
    })
}

/// Unevenly sampled, with residuals that are correlated between outputs.
fn maneuver(samples: usize, seed: f64) -> Arc<Maneuver> {
    let time: Vec<f64> = (0..samples)
        .scan(0.0, |t, k| {
            let now = *t;
            *t += 0.02 + 0.01 * (k % 3) as f64;
            Some(now)
        })
        .collect();
    let channel = |value: &dyn Fn(usize, f64) -> f64| {
        let values = time.iter().enumerate().map(|(k, &t)| value(k, t)).collect();
        Channel::from_recorded("-", Unit::NONE, values)
    };
    let u = |k: usize, t: f64| (1.7 * t + seed).sin() + ((k / 20) % 2) as f64;
    let common = |k: usize| 0.1 * scatter(k, seed);
    let channels = IndexMap::from([
        ("u".to_string(), channel(&u)),
        (
            "y".to_string(),
            channel(&|k, t| 0.4 * t.sin() + 0.3 * scatter(k, seed)),
        ),
        (
            "z".to_string(),
            channel(&|k, t| 0.2 * t.cos() + 0.2 * scatter(k, seed + 1.0) + common(k)),
        ),
        (
            "q".to_string(),
            channel(&|k, t| 1.05 * u(k, t) + 0.2 * scatter(k, seed + 2.0) + common(k)),
        ),
    ]);
    Arc::new(Maneuver::new(time, channels).expect("a maneuver"))
}

fn plan(model: Value, options: Value, maneuvers: &[Arc<Maneuver>]) -> Plan {
    let uses: Vec<Value> = maneuvers
        .iter()
        .map(|maneuver| json!({"id": maneuver.digest()}))
        .collect();
    let spec: JobSpec =
        serde_json::from_value(json!({"model": model, "options": options, "maneuvers": uses}))
            .expect("a spec");
    let ModelSource::Document(document) = &spec.model else {
        panic!("a document")
    };
    job::prepare(&spec, document, maneuvers).unwrap_or_else(|faults| panic!("{faults:#?}"))
}

/// Central differences of (N/2) ln det R, whose truncation error at this step is below 1e-8 of the gradient.
#[test]
fn the_gradient_is_that_of_the_concentrated_likelihood() {
    let maneuvers = [maneuver(130, 0.0), maneuver(67, 0.4), maneuver(201, 0.9)];
    for structure in ["diagonal", "full"] {
        for (integrator, inputs) in [
            ("rk4", "linear"),
            ("rk4", "hold"),
            ("rk2", "linear"),
            ("euler", "hold"),
        ] {
            let noise = json!({"kind": "estimated", "structure": structure});
            let options =
                json!({"noise": noise, "integrator": integrator, "input_interpolation": inputs});
            let plan = plan(model(), options, &maneuvers);
            let mut evaluator = Evaluator::new(&plan.problem);
            let theta = plan.problem.unknowns.start();
            let samples = plan.problem.samples() as f64;
            let mut at = |theta: &[f64]| {
                NormalEquations::at(&mut evaluator, theta).expect("a bounded simulation")
            };
            let descent = at(&theta).descent;
            for place in 0..theta.len() {
                let mut half_cost = |change: f64| {
                    let mut moved = theta.clone();
                    moved[place] += change;
                    0.5 * samples * at(&moved).det_r().ln()
                };
                let difference = (half_cost(1e-5) - half_cost(-1e-5)) / 2e-5;
                let error = (difference + descent[place]).abs() / descent.amax();
                assert!(
                    error < 1e-7,
                    "{structure} {integrator} {inputs}, unknown {place}: {error:e}"
                );
            }
        }
    }
}

/// Two outputs that are one: their full covariance is singular, and that is what is said.
#[test]
fn a_singular_noise_covariance_is_named() {
    let mut twice = model();
    twice["outputs"] =
        json!({"y": {"equation": "k*x + bias + d*t"}, "z": {"equation": "2*(k*x + bias + d*t)"}});
    let recording = maneuver(130, 0.0);
    let mut spec = json!({"model": twice, "maneuvers": [{"id": "x"}], "channels": {"z": "2*y"}});
    spec["options"] = json!({"noise": {"kind": "estimated", "structure": "full"}});
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    let ModelSource::Document(document) = &spec.model else {
        panic!("a document")
    };
    let plan =
        job::prepare(&spec, document, &[recording]).unwrap_or_else(|faults| panic!("{faults:#?}"));
    let faults = job::run(&plan, &mut |_| ControlFlow::Continue(())).expect_err("a fault");
    assert_eq!(
        (&*faults[0].code, faults[0].pointer.as_str()),
        ("singular_noise", "/options/noise")
    );
}

/// Errors over 200 seeds are as large as the Cramér-Rao bounds say. The standard deviation of 200 errors is
/// known to 5 %: a ratio from 0.85 to 1.15 is three of its standard deviations; the mean may be off by 0.25.
#[test]
fn error_bounds_are_as_large_as_the_errors() {
    let text = include_str!("../../data/elevator.toml");
    let mut scenario: Scenario = toml::from_str(text).expect("a scenario");
    let document = catalog::find("short-period").expect("a catalog model");
    let model = Model::compile(&document).expect("a model");
    // alpha_0 is held: at its true value, or its error would be part of the others'
    let held = json!({"alpha_0": {"start": scenario.truth["alpha_0"]}});
    let mut errors: IndexMap<String, Vec<f64>> = IndexMap::new();
    for seed in 0..200 {
        scenario.seed = seed;
        let recording = Arc::new(scenario.fly(&model).expect("a maneuver"));
        let spec = json!({"model": "short-period", "maneuvers": [{"id": "x"}], "parameters": held});
        let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
        let plan = job::prepare(&spec, &document, &[recording])
            .unwrap_or_else(|faults| panic!("{faults:#?}"));
        let result = job::run(&plan, &mut |_| ControlFlow::Continue(()))
            .unwrap_or_else(|faults| panic!("{faults:#?}"));
        assert!(
            result.estimate.outcome.is_minimum(),
            "seed {seed}: {}",
            result.estimate.reason
        );
        for parameter in result.estimate.parameters {
            if let Some(bound) = parameter.standard_error {
                let error = (parameter.estimate - scenario.truth[&parameter.name]) / bound;
                errors.entry(parameter.name).or_default().push(error);
            }
        }
    }
    assert_eq!(errors.len(), 9);
    for (name, errors) in errors {
        let count = errors.len() as f64;
        let mean = errors.iter().sum::<f64>() / count;
        let deviation =
            (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
        println!("{name:10} error over bound: mean {mean:+.2}, standard deviation {deviation:.2}");
        assert!(
            mean.abs() < 0.25 && (0.85..1.15).contains(&deviation),
            "{name}: {mean:.2} ± {deviation:.2}"
        );
    }
}
