//! Options that do not go together: every pair of choices, with each estimator and each kind of job, works or is refused
//! before it begins, by the name of an option.

use std::cell::Cell;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use crate::common::plans::{recording, scatter, try_plan};
use serde_json::{Value, json};
use trimtab_core::estimate::study::Clock;
use trimtab_core::flight::Maneuver;
use trimtab_core::job;

const SAMPLES: usize = 40;

fn maneuver() -> Arc<Maneuver> {
    let step = 0.1;
    let u: Vec<f64> = (0..SAMPLES)
        .map(|k| if (k / 9) % 2 == 0 { 1.0 } else { -0.5 })
        .collect();
    let (mut x, mut y) = (0.2, Vec::new());
    for (k, u) in u.iter().enumerate() {
        y.push(x + 0.1 + 0.02 * scatter(k, 0.4));
        x += step * (-1.5 * x + 2.0 * u);
    }
    let rate: Vec<f64> = (0..SAMPLES)
        .map(|k| -1.5 * y[k] + 2.0 * u[k] + 0.05 * scatter(k, 0.1))
        .collect();
    let time = (0..SAMPLES).map(|k| k as f64 * step).collect();
    recording(time, &[("u", u), ("y", y), ("yd", rate)])
}

/// Two states, one of them not measured, an output that sees no state, a parameter of each maneuver.
fn model() -> Value {
    json!({
        "name": "pairs",
        "inputs": {"u": {}},
        "parameters": {
            "a": {"unit": "1/s", "start": -1.0}, "b": {"unit": "1/s", "start": 1.5},
            "c": {"start": 0.1}, "x_0": {"start": "first(y)", "per": "maneuver"},
        },
        "states": {
            "x": {"initial": "x_0", "derivative": "a*x + b*w"},
            "w": {"initial": "0", "derivative": "rate*(u - w)"},
        },
        "outputs": {"y": {"equation": "x + c"}, "yd": {"equation": "(a*x + b*w)*second"}},
        "constants": {
            "rate": {"value": 8.0, "unit": "1/s"}, "second": {"value": 1.0, "unit": "s"},
            "tau": {"value": 0.05, "unit": "s"},
        },
    })
}

/// What one choice changes: a pointer into the spec, and what is put there.
type Choice = (&'static str, Value);

/// By option: its values but for the default.
fn choices() -> Vec<Vec<Choice>> {
    let option = |name: &'static str, values: Vec<Value>| -> Vec<Choice> {
        values.into_iter().map(|value| (name, value)).collect()
    };
    let technique = |name: &str| json!({"technique": name});
    let kind = |name: &str| json!({"kind": name});
    vec![
        option("/options/method", vec![json!("gauss_newton")]),
        option(
            "/options/derivatives",
            [
                "forward_difference",
                "central_difference",
                "complex_step",
                "adjoint",
            ]
            .map(technique)
            .to_vec(),
        ),
        option(
            "/options/start",
            vec![
                kind("document"),
                kind("equation_error"),
                json!({"kind": "nelder_mead", "max_evaluations": 40}),
                json!({"kind": "multi_start", "starts": 3}),
                kind("multiple_shooting"),
            ],
        ),
        option("/options/integrator", vec![json!("euler"), json!("rk2")]),
        option("/options/steps_per_sample", vec![json!(1), json!(3)]),
        option("/options/input_interpolation", vec![json!("hold")]),
        option(
            "/options/noise",
            vec![
                json!({"kind": "estimated", "structure": "full"}),
                json!({"kind": "given", "variance": [4e-4, 2.5e-3]}),
            ],
        ),
        option("/options/error_bounds", vec![json!("conventional")]),
        option(
            "/options/process_noise",
            vec![
                json!({"x": {"start": 0.1}}),
                json!({"w": {"start": 0.0, "fixed": true}}),
            ],
        ),
        option("/options/max_iterations", vec![json!(0), json!(2)]),
        option("/options/tolerance", vec![json!(1e-9), json!(1.0)]),
        option(
            "/parameters/a/prior",
            vec![json!({"mean": -1.5, "sd": 0.3})],
        ),
        option(
            "/parameters/x_0/prior",
            vec![json!({"mean": 0.2, "sd": 0.1})],
        ),
        option("/parameters/b/upper", vec![json!(1.2)]),
        option("/parameters/a/fixed", vec![json!(true)]),
        option(
            "/maneuvers/1/role",
            vec![json!("validation"), json!("final")],
        ),
        option("/model/outputs/y/delay", vec![json!("tau")]),
        option("/model/inputs/u/delay", vec![json!("tau")]),
        option(
            "/options/frequency",
            vec![
                json!({"band_hz": [0.3, 3.0], "step_hz": 0.1}),
                json!({"band_hz": [0.25, 4.0], "ends": "at_rest", "trend": "constant"}),
            ],
        ),
    ]
}

fn put(spec: &mut Value, pointer: &str, value: &Value) {
    let mut at = spec;
    for part in pointer.split('/').skip(1) {
        at = match part.parse::<usize>() {
            Ok(index) => &mut at[index],
            Err(_) => &mut at[part],
        };
    }
    *at = value.clone();
}

/// Each look at it takes a hundredth of a second, so that nothing is repeated for long.
#[derive(Default)]
struct Looks(Cell<f64>);

impl Clock for Looks {
    fn wall(&self) -> f64 {
        self.0.set(self.0.get() + 0.01);
        self.0.get()
    }

    fn cpu(&self) -> f64 {
        self.wall()
    }
}

/// Why the job is neither done nor refused by the name of what does not go.
fn fault(spec: &Value, maneuver: &Arc<Maneuver>) -> Option<String> {
    let tried = catch_unwind(AssertUnwindSafe(|| {
        let two = [maneuver.clone(), maneuver.clone()];
        let plan = match try_plan(spec["model"].clone(), spec.clone(), &two) {
            Ok(plan) => plan,
            Err(faults) => {
                let named = |pointer: &str| {
                    [
                        "/options/",
                        "/kind",
                        "/model",
                        "/parameters",
                        "/model/outputs/y/delay",
                    ]
                    .iter()
                    .any(|n| pointer.starts_with(n))
                };
                let bad = faults
                    .iter()
                    .find(|fault| !named(&fault.pointer) || fault.message.len() < 20);
                return bad.map(|fault| format!("refused without a name: {fault}"));
            }
        };
        let ran = match spec["kind"].as_str() {
            Some("diagnose") => job::run_diagnosis(&plan, &mut |_| ControlFlow::Continue(())),
            Some("derivative_study") => {
                job::run_study(&plan, &Looks::default(), &mut |_| ControlFlow::Continue(()))
            }
            _ => job::run(&plan, &mut |_| ControlFlow::Continue(())),
        };
        match ran {
            Ok(result) => {
                let rows = &result.estimate.parameters;
                let finite = rows.iter().all(|row| row.estimate.is_finite())
                    && result.estimate.cost.is_finite();
                (!finite).then(|| "an estimate that is not finite".to_string())
            }
            Err(faults) => Some(format!("accepted, and then: {faults}")),
        }
    }));
    tried.unwrap_or_else(|_| Some("panicked".to_string()))
}

#[test]
fn every_pair_works_or_is_refused_by_name() {
    let maneuver = maneuver();
    let choices = choices();
    let mut bad = Vec::new();
    let mut tried = 0;
    for estimator in [
        "output_error",
        "filter_error",
        "equation_error",
        "output_error_frequency",
        "equation_error_frequency",
    ] {
        for kind in ["estimate", "diagnose", "derivative_study"] {
            let base = json!({
                "kind": kind, "model": model(), "parameters": {},
                "maneuvers": [{"id": maneuver.digest(), "label": "one"}, {"id": maneuver.digest(), "label": "two"}],
                "options": {"estimator": estimator},
            });
            let mut base = base;
            if estimator.ends_with("_frequency") {
                base["options"]["frequency"] = json!({"band_hz": [0.25, 4.0]});
            }
            let mut attempt = |chosen: &[&Choice]| {
                let mut spec = base.clone();
                chosen
                    .iter()
                    .for_each(|(pointer, value)| put(&mut spec, pointer, value));
                tried += 1;
                if let Some(why) = fault(&spec, &maneuver) {
                    let told: Vec<String> =
                        chosen.iter().map(|(p, v)| format!("{p} = {v}")).collect();
                    bad.push(format!("{estimator}, {kind}, {}: {why}", told.join(", ")));
                }
            };
            attempt(&[]);
            for (i, option) in choices.iter().enumerate() {
                for choice in option {
                    attempt(&[choice]);
                    // these are hundreds of estimations: there each choice alone
                    if kind != "estimate" {
                        continue;
                    }
                    for other in choices[i + 1..].iter().flatten() {
                        attempt(&[choice, other]);
                    }
                }
            }
        }
    }
    assert!(
        bad.is_empty(),
        "{} of {tried}:\n{}",
        bad.len(),
        bad.join("\n")
    );
    assert!(tried > 1000, "{tried}");
}
