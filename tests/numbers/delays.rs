//! Time delays of inputs and outputs as parameters: exact derivatives at any real value, and the truth recovered.

use std::sync::Arc;

use crate::common::plans::{gradient_errors, parameter, plan, scatter, solve, try_plan};
use indexmap::IndexMap;
use num_complex::Complex64;
use serde_json::{Value, json};
use trimtab_core::flight::{Channel, Maneuver, Unit};
use trimtab_core::model::{Model, ModelDocument};
use trimtab_core::simulate::{
    Columns, InputInterpolation, Integrator, Segment, Sensitivities, Steps, Substeps, simulate,
};

/// Multiples of the mean step: negative, zero, whole ones and others, longer than a block, longer than the recording.
const DELAYS: [f64; 13] = [
    0.0, 0.37, 1.0, 3.6, 20.0, 33.25, -0.4, -1.0, -2.5, -17.0, 70.7, 500.0, -500.0,
];

/// Both an input and outputs delayed; one delay stands in an equation too, one is a sum, one output is prompt.
fn document() -> ModelDocument {
    let text = r#"
        name = "delayed"
        inputs.u = { delay = "tau_u" }
        inputs.w = {}
        parameters.L = { unit = "1/s", start = -1.5 }
        parameters.K = { unit = "1/s", start = 2.0 }
        parameters.tau_u = { unit = "s", start = 0.0 }
        parameters.tau_y = { unit = "s", start = 0.0 }
        parameters.extra = { unit = "s", start = 0.0 }
        states.p = { initial = "0.1", derivative = "L*p + K*(u + 0.3*w)" }
        outputs.y = { equation = "p + 0.2*u", delay = "tau_y" }
        outputs.z = { equation = "p^2 + L*tau_y", delay = "tau_y/2 + extra" }
        outputs.x = { equation = "p" }
    "#;
    toml::from_str(text).expect("a document")
}

fn segments() -> [Segment; 2] {
    let uneven: Vec<f64> = (0..129).map(|k| 0.02 + 0.01 * f64::from(k % 5)).collect();
    [Steps::Even(0.04), Steps::Uneven(uneven)].map(|steps| {
        let wave = |frequency: f64| -> Vec<f64> {
            let step = |k: usize| f64::from(u8::from((k / 23).is_multiple_of(2)));
            (0..130)
                .map(|k| (frequency * k as f64).sin() + step(k))
                .collect()
        };
        Segment {
            label: "test".into(),
            time: (0..130).map(|k| 0.04 * k as f64).collect(),
            steps,
            substeps: Substeps::default(),
            inputs: vec![wave(0.11), wave(0.05)],
            measured: vec![vec![0.0; 130]; 3],
        }
    })
}

fn outputs(model: &Model, segment: &Segment, theta: &[f64]) -> Vec<Vec<f64>> {
    let mut outputs = vec![Vec::new(); model.outputs.len()];
    let (integrator, inputs) = (Integrator::Rk4, InputInterpolation::Linear);
    simulate(model, integrator, inputs, segment, theta, |_, y: &[f64]| {
        outputs
            .iter_mut()
            .zip(y)
            .for_each(|(series, &y)| series.push(y));
    });
    outputs
}

/// Sensitivities, complex steps (which have no truncation error: both agree to rounding) and central differences:
/// at whole delays, where the curvature of the interpolation jumps, they are off by half their step times that jump,
/// about 1e-5 of the column.
#[test]
fn derivatives_agree_at_any_delay() {
    let model = Model::compile(&document()).unwrap_or_else(|faults| panic!("{faults:#?}"));
    let all: Vec<usize> = (0..model.parameters.len()).collect();
    let columns = Columns::new(&model, &all);
    let (integrator, inputs) = (Integrator::Rk4, InputInterpolation::Linear);
    let mut machinery = Sensitivities::new(&model, &columns, integrator, inputs);
    let (mut worst_complex, mut worst_central) = (0.0_f64, 0.0_f64);
    for segment in segments() {
        for (i, &delay) in DELAYS.iter().enumerate() {
            let other = DELAYS[(i + 3) % DELAYS.len()];
            let theta = [-1.5, 2.0, 0.04 * delay, 0.04 * other, 0.04 * 0.7];
            let mut rows = vec![vec![vec![0.0; 130]; all.len()]; 3];
            let mut seen = 0;
            machinery
                .run(&segment, &theta, |block| {
                    assert_eq!(block.first, seen);
                    seen += block.len;
                    for (output, rows) in rows.iter_mut().enumerate() {
                        for k in 0..block.len {
                            let row = block.row(output, k);
                            for (&column, &value) in columns.of_output(output).iter().zip(row) {
                                rows[column][block.first + k] = value;
                            }
                        }
                    }
                })
                .expect("a bounded simulation");
            assert_eq!(seen, 130);
            for column in 0..all.len() {
                let mut complex: Vec<Complex64> =
                    theta.iter().map(|&v| Complex64::new(v, 0.0)).collect();
                complex[column].im = 1e-40;
                let mut by_complex = vec![Vec::new(); 3];
                simulate(&model, integrator, inputs, &segment, &complex, |_, y| {
                    by_complex
                        .iter_mut()
                        .zip(y)
                        .for_each(|(s, y)| s.push(y.im / 1e-40));
                });
                let moved = |change: f64| {
                    let mut theta = theta;
                    theta[column] += change;
                    outputs(&model, &segment, &theta)
                };
                let (above, below) = (moved(1e-7), moved(-1e-7));
                for output in 0..3 {
                    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
                    let scale = norm(&by_complex[output]).max(1e-3);
                    let difference: Vec<f64> = (0..130)
                        .map(|k| rows[output][column][k] - by_complex[output][k])
                        .collect();
                    worst_complex = worst_complex.max(norm(&difference) / scale);
                    let difference: Vec<f64> = (0..130)
                        .map(|k| (above[output][k] - below[output][k]) / 2e-7)
                        .zip(&rows[output][column])
                        .map(|(central, row)| central - row)
                        .collect();
                    worst_central = worst_central.max(norm(&difference) / scale);
                }
            }
        }
    }
    println!("against complex steps {worst_complex:.1e}, central differences {worst_central:.1e}");
    assert!(worst_complex < 1e-9, "{worst_complex:e}");
    assert!(worst_central < 1e-4, "{worst_central:e}");
}

/// Values of sensitivities' blocks and of the plain simulation are the same numbers but for rounding; a delay of
/// whole samples shifts by so many.
#[test]
fn whole_delays_shift_by_whole_samples() {
    let model = Model::compile(&document()).expect("a model");
    let [even, _] = segments();
    let prompt = outputs(&model, &even, &[-1.5, 2.0, 0.0, 0.0, 0.0]);
    let later = outputs(&model, &even, &[-1.5, 2.0, 0.0, 3.0 * 0.04, 0.0]);
    let earlier = outputs(&model, &even, &[-1.5, 2.0, 0.0, -2.0 * 0.04, 0.0]);
    for k in 0..130_usize {
        assert!((later[0][k] - prompt[0][k.saturating_sub(3)]).abs() < 1e-12);
        assert!((earlier[0][k] - prompt[0][(k + 2).min(129)]).abs() < 1e-12);
        assert_eq!(later[2][k], prompt[2][k]);
    }
}

/// The gradient of the likelihood, with missing samples too, against its differences.
#[test]
fn the_gradient_of_the_likelihood_knows_delays() {
    let step = 0.04;
    let series = |value: &dyn Fn(usize) -> f64| (0..150).map(value).collect::<Vec<f64>>();
    let channels = [
        ("u", series(&|k| f64::from(u8::from((k / 20) % 2 == 1)))),
        ("w", series(&|k| (0.06 * k as f64).cos())),
        ("y", series(&|k| (0.09 * k as f64).sin() + scatter(k, 0.0))),
        (
            "z",
            series(&|k| {
                if k % 4 == 1 {
                    scatter(k, 1.0)
                } else {
                    f64::NAN
                }
            }),
        ),
        ("x", series(&|k| (0.08 * k as f64).sin() + scatter(k, 2.0))),
    ];
    let time = series(&|k| step * k as f64);
    let recording = crate::common::plans::recording(time, &channels);
    for delay in [0.0, 0.037, 0.04, 0.15, -0.09] {
        let start = json!({"parameters": {"tau_u": {"start": delay}, "tau_y": {"start": 0.3*delay}, "extra": {"start": -delay}}});
        let document = serde_json::to_value(document()).unwrap();
        let plan = plan(document, start, std::slice::from_ref(&recording));
        for (place, error) in gradient_errors(&plan, 1e-6).into_iter().enumerate() {
            // a kink of the curvature lies within the difference at whole delays
            assert!(error < 1e-4, "{delay}, unknown {place}: {error:e}");
        }
    }
}

const STEP: f64 = 0.04;

/// Truth of a short-period-like system, integrated at a hundredth of the step, with an elevator that acts `input`
/// samples late and a vane that lags by `output` samples. Smooth inputs, as an actuator gives them.
fn flown(input: f64, output: f64, noise: f64) -> Arc<Maneuver> {
    let fine = STEP / 100.0;
    let elevator = |t: f64| {
        let edge = |at: f64| ((t - at) / 0.12).tanh();
        0.02 * (edge(1.0) - 2.0 * edge(3.4) + 2.0 * edge(5.0) - 2.0 * edge(5.8) + edge(6.6))
    };
    let rate = |x: [f64; 2], t: f64| {
        let de = elevator(t - input * STEP);
        [
            -0.9 * x[0] + 0.97 * x[1] - 0.08 * de,
            -3.4 * x[0] - 1.6 * x[1] - 4.8 * de,
        ]
    };
    let mut states = vec![[0.0, 0.0]];
    for i in 0..40_000 {
        let (x, t) = (states[i], fine * i as f64);
        let ahead = |k: [f64; 2], h: f64| [x[0] + h * k[0], x[1] + h * k[1]];
        let k1 = rate(x, t);
        let k2 = rate(ahead(k1, fine / 2.0), t + fine / 2.0);
        let k3 = rate(ahead(k2, fine / 2.0), t + fine / 2.0);
        let k4 = rate(ahead(k3, fine), t + fine);
        let slope = |i: usize| (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) / 6.0;
        states.push([x[0] + fine * slope(0), x[1] + fine * slope(1)]);
    }
    let at = |k: usize, lag: f64, state: usize| {
        let i = ((k as f64 - lag) * 100.0).round().max(0.0) as usize;
        states[i.min(40_000)][state]
    };
    let series = |value: &dyn Fn(usize) -> f64| {
        let values = (0..400).map(value).collect();
        Channel::from_recorded("-", Unit::NONE, values)
    };
    let channels = IndexMap::from([
        ("de".to_string(), series(&|k| elevator(STEP * k as f64))),
        (
            "a".to_string(),
            series(&|k| at(k, output, 0) + 0.0006 * noise * scatter(k, 1.0)),
        ),
        (
            "q".to_string(),
            series(&|k| at(k, 0.0, 1) + 0.001 * noise * scatter(k, 5.0)),
        ),
    ]);
    Arc::new(Maneuver::new((0..400).map(|k| STEP * k as f64).collect(), channels).unwrap())
}

fn short_period() -> Value {
    json!({
        "name": "short-period-delayed",
        "inputs": {"de": {"delay": "tau_de"}},
        "parameters": {
            "Za": {"unit": "1/s", "start": -0.6}, "Zq": {"unit": "1/s", "start": 0.97, "fixed": true}, "Zde": {"unit": "1/s", "start": -0.08, "fixed": true},
            "Ma": {"unit": "1/s", "start": -3.0}, "Mq": {"unit": "1/s", "start": -1.2}, "Mde": {"unit": "1/s", "start": -4.0},
            "tau_de": {"unit": "ms", "start": 0.0}, "tau_a": {"unit": "s", "start": 0.0},
        },
        "states": {
            "alpha": {"initial": "0", "derivative": "Za*alpha + Zq*q + Zde*de"},
            "q": {"initial": "0", "derivative": "Ma*alpha + Mq*q + Mde*de"},
        },
        "outputs": {"a": {"equation": "alpha", "delay": "tau_a"}, "q": {"equation": "q"}},
    })
}

/// From start values of zero the delays come out within three and a half error bounds: 2·4 comparisons of normal errors exceed
/// that one time in 270; the noise is a fixed sequence, so that this cannot come and go.
#[test]
fn delays_of_an_input_and_an_output_are_recovered() {
    for (input, output) in [(0.37, 3.6), (1.0, 0.37), (3.6, 1.0), (2.0, -1.5)] {
        let result = solve(short_period(), json!({}), &[flown(input, output, 1.0)]);
        assert!(
            result.estimate.outcome.is_minimum(),
            "{}",
            result.estimate.reason
        );
        for (name, truth, unit) in [("tau_de", input, 1e-3), ("tau_a", output, 1.0)] {
            let found = parameter(&result, name);
            let (estimate, bound) = (
                found.estimate * unit / STEP,
                found.standard_error.expect("seen") * unit / STEP,
            );
            println!("{name}: {truth} samples, found {estimate:.4} ± {bound:.4}");
            assert!(
                (estimate - truth).abs() < 3.5 * bound,
                "{name}: {estimate} for {truth}"
            );
            assert!(bound < 0.1);
        }
    }
}

/// Whose delay is nearer to the truth: ours, or that of a straight line through the last two samples, y_k - τ/Δt
/// (y_k - y_{k-1}), which the published reference uses for whatever τ. Without noise, all else at its true value;
/// what is left of ours is the integration over whole steps.
#[test]
fn delays_are_nearer_to_the_truth_than_those_of_a_straight_line() {
    let truth = [
        ("Za", -0.9),
        ("Ma", -3.4),
        ("Mq", -1.6),
        ("Mde", -4.8),
        ("tau_de", 0.0),
    ];
    let held: serde_json::Map<String, Value> = truth
        .into_iter()
        .map(|(name, value)| (name.to_string(), json!({"start": value, "fixed": true})))
        .collect();
    for delay in [-0.3, 0.2, 0.5, 0.84, 1.6, 2.5] {
        let late = flown(0.0, delay, 0.0);
        let prompt = flown(0.0, 0.0, 0.0);
        let (z, y) = (&late.channels()["a"].values, &prompt.channels()["a"].values);
        let (above, below) = (1..400).fold((0.0, 0.0), |(above, below), k| {
            let change = y[k] - y[k - 1];
            (above + (y[k] - z[k]) * change, below + change * change)
        });
        let line: f64 = above / below - delay;
        let result = solve(short_period(), json!({"parameters": held}), &[late]);
        let ours = parameter(&result, "tau_a").estimate / STEP - delay;
        println!("a delay of {delay} samples: {ours:+.4} off, by a straight line {line:+.4}");
        assert!(ours.abs() < 0.01, "{delay}: {ours}");
        if !(0.0..=1.0).contains(&delay) {
            assert!(ours.abs() < 0.5 * line.abs(), "{delay}: {ours} {line}");
        }
    }
}

/// Delays as effects: zero is the model before.
#[test]
fn an_edit_adds_a_delay() {
    let mut prompt = short_period();
    prompt["inputs"] = json!({"de": {}});
    prompt["outputs"]["a"] = json!({"equation": "alpha"});
    for name in ["tau_de", "tau_a"] {
        prompt["parameters"].as_object_mut().unwrap().remove(name);
    }
    let maneuver = flown(1.0, 0.37, 1.0);
    let edits = json!([{"kind": "input_delay", "target": "de"}, {"kind": "sensor_delay", "target": "a", "parameter": "lag"}]);
    let held = json!({"edits": edits, "parameters": {"de_delay": {"fixed": true}, "lag": {"fixed": true}}});
    let before = solve(prompt.clone(), json!({}), std::slice::from_ref(&maneuver));
    let zero = solve(prompt.clone(), held, std::slice::from_ref(&maneuver));
    for name in ["Za", "Ma", "Mq", "Mde"] {
        assert_eq!(
            parameter(&before, name).estimate,
            parameter(&zero, name).estimate
        );
    }
    let freed = solve(prompt, json!({"edits": edits}), &[maneuver]);
    let document = solve(short_period(), json!({}), &[flown(1.0, 0.37, 1.0)]);
    let (edited, written) = (
        parameter(&freed, "de_delay"),
        parameter(&document, "tau_de"),
    );
    assert!((edited.estimate * 1e3 / written.estimate - 1.0).abs() < 1e-4);
    assert_eq!(edited.unit, "s");
    assert!(freed.estimate.cost < before.estimate.cost - 10.0);
}

#[test]
fn delays_that_cannot_be_are_refused() {
    let refused = |delay: &str| {
        let mut model = short_period();
        model["inputs"]["de"]["delay"] = json!(delay);
        let faults = try_plan(model, json!({}), &[flown(0.0, 0.0, 1.0)])
            .err()
            .expect("a fault");
        (faults[0].pointer.clone(), faults[0].code.to_string())
    };
    let place = |code: &str| ("/model/inputs/de/delay".to_string(), code.to_string());
    assert_eq!(refused("Za"), place("unit_mismatch"));
    assert_eq!(refused("tau_x"), place("unknown_symbol"));
    assert_eq!(refused("alpha*tau_de"), place("delay_depends_on_data"));
    assert_eq!(refused("de*tau_de"), place("delay_depends_on_data"));
    assert_eq!(refused("tau_de +"), place("syntax_error"));
    // a thousand samples of 0.04 s
    let far = json!({"parameters": {"tau_a": {"start": -41.0}}});
    let plan = plan(short_period(), far, &[flown(0.0, 0.0, 1.0)]);
    let faults = trimtab_core::job::run(&plan, &mut |_| std::ops::ControlFlow::Continue(()))
        .expect_err("a fault");
    assert_eq!(&*faults[0].code, "delay_too_long");
    assert!(
        faults[0].message.contains("output 'a'"),
        "{}",
        faults[0].message
    );
}
