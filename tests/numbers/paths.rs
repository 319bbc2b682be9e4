//! Play, rate limit, lag and delay in the paths of inputs and outputs: the same derivatives by every technique, and
//! none of the paths seen where they have no size. `play_and_limits` has the truth recovered.

use num_complex::Complex64;
use serde_json::{Value, json};
use trimtab_core::estimate::derivatives::CostAndGradient;
use trimtab_core::estimate::{
    Derivatives, Evaluator, FilterEvaluator, NormalEquations, Options, Problem, Unknowns,
};
use trimtab_core::model::{Edit, EditKind, Model, ModelDocument};
use trimtab_core::simulate::{
    Columns, InputInterpolation, Integrator, Segment, Sensitivities, Steps, Substeps, simulate,
};

use crate::common::plans::{plan, recording, scatter, try_plan};

const COUNT: usize = 150;

/// All elements, of two inputs and two outputs; one time stands in an equation too, one size is a sum.
fn document() -> ModelDocument {
    let text = r#"
        name = "paths"
        inputs.u = { play = "b", rate_limit = "r", lag = "T_u", delay = "tau" }
        inputs.w = { rate_limit = "3*r", lag = "T_u + T_w" }
        parameters.L = { unit = "1/s", start = -1.5 }
        parameters.K = { unit = "1/s", start = 2.0 }
        parameters.b = { unit = "-", start = 0.0 }
        parameters.r = { unit = "1/s", start = 2.0 }
        parameters.T_u = { unit = "s", start = 0.0 }
        parameters.T_w = { unit = "s", start = 0.0 }
        parameters.T_y = { unit = "s", start = 0.0 }
        parameters.tau = { unit = "s", start = 0.0 }
        states.p = { initial = "0.1", derivative = "L*p + K*(u + 0.3*w)" }
        outputs.y = { equation = "p + 0.2*u", lag = "T_y", delay = "tau" }
        outputs.z = { equation = "p^2 + L*T_y", lag = "T_y + 0.5*T_w" }
        outputs.x = { equation = "p" }
        outputs.v = { equation = "u", lag = "T_w" }
    "#;
    toml::from_str(text).expect("a document")
}

/// L, K, b, r, T_u, T_w, T_y, tau: no path, all of it, times longer and shorter than a step, a lead.
const SIZES: [[f64; 8]; 5] = [
    [-1.5, 2.0, 0.0, 1e3, 0.0, 0.0, 0.0, 0.0],
    [-1.5, 2.0, 0.05, 1.3, 0.07, 0.2, 0.15, 0.053],
    [-1.5, 2.0, 0.01, 4.0, 0.004, 1e-5, 2.0, -0.017],
    [-1.5, 2.0, 0.3, 0.6, 0.5, -0.4, 0.01, 0.4],
    [-1.5, 2.0, 0.02, 2.5, -0.03, 0.1, -0.06, 0.0],
];

fn segment(uneven: bool) -> Segment {
    let steps = (0..COUNT - 1).map(|k| 0.02 + 0.01 * (k % 5) as f64);
    let wave = |frequency: f64, edge: usize| -> Vec<f64> {
        let step = |k: usize| f64::from(u8::from((k / edge).is_multiple_of(2)));
        let at = |k: usize| (frequency * k as f64).sin() + step(k);
        (0..COUNT).map(at).collect()
    };
    Segment {
        label: "test".into(),
        time: (0..COUNT).map(|k| 0.04 * k as f64).collect(),
        steps: if uneven {
            Steps::Uneven(steps.collect())
        } else {
            Steps::Even(0.04)
        },
        substeps: Substeps::default(),
        inputs: vec![wave(0.11, 23), wave(0.05, 31)],
        measured: vec![vec![0.0; COUNT]; 4],
    }
}

/// By output, then sample.
fn outputs(
    model: &Model,
    inputs: InputInterpolation,
    segment: &Segment,
    theta: &[f64],
) -> Vec<Vec<f64>> {
    let mut outputs = vec![Vec::new(); model.outputs.len()];
    let rk4 = Integrator::Rk4;
    simulate(model, rk4, inputs, segment, theta, |_, y: &[f64]| {
        outputs
            .iter_mut()
            .zip(y)
            .for_each(|(series, &y)| series.push(y));
    });
    outputs
}

fn every_setting() -> impl Iterator<Item = (InputInterpolation, Segment)> {
    let inputs = [InputInterpolation::Linear, InputInterpolation::Hold];
    let both = |inputs| [false, true].map(|uneven| (inputs, segment(uneven)));
    inputs.into_iter().flat_map(both)
}

/// Rows of the sensitivities, complex steps (which have no truncation error: both agree to rounding) and central
/// differences. Those are off where an edge of a play or of a limit lies within their step, or a delay is whole.
#[test]
fn rows_agree_with_complex_steps_and_differences() {
    let model = Model::compile(&document()).unwrap_or_else(|faults| panic!("{faults:#?}"));
    let all: Vec<usize> = (0..model.parameters.len()).collect();
    let columns = Columns::new(&model, &all);
    let rk4 = Integrator::Rk4;
    let (mut worst_complex, mut worst_central) = (0.0_f64, 0.0_f64);
    for (inputs, segment) in every_setting() {
        let mut machinery = Sensitivities::new(&model, &columns, rk4, inputs);
        for theta in SIZES {
            let mut rows = vec![vec![vec![0.0; COUNT]; all.len()]; 4];
            let mut values = vec![Vec::new(); 4];
            let run = machinery.run(&segment, &theta, |block| {
                for (output, rows) in rows.iter_mut().enumerate() {
                    values[output].extend_from_slice(block.output(output));
                    for k in 0..block.len {
                        let row = block.row(output, k);
                        for (&column, &value) in columns.of_output(output).iter().zip(row) {
                            rows[column][block.first + k] = value;
                        }
                    }
                }
            });
            run.expect("a bounded simulation");
            let plain = outputs(&model, inputs, &segment, &theta);
            for (a, b) in plain.iter().flatten().zip(values.iter().flatten()) {
                assert!((a - b).abs() < 1e-12, "{a} {b}");
            }
            for column in 0..all.len() {
                let mut complex: Vec<Complex64> =
                    theta.iter().map(|&v| Complex64::new(v, 0.0)).collect();
                complex[column].im = 1e-40;
                let mut by_complex = vec![Vec::new(); 4];
                simulate(&model, rk4, inputs, &segment, &complex, |_, y| {
                    by_complex
                        .iter_mut()
                        .zip(y)
                        .for_each(|(s, y)| s.push(y.im / 1e-40));
                });
                let moved = |change: f64| {
                    let mut theta = theta;
                    theta[column] += change;
                    outputs(&model, inputs, &segment, &theta)
                };
                let (above, below) = (moved(1e-8), moved(-1e-8));
                for output in 0..4 {
                    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
                    let scale = norm(&by_complex[output]).max(1e-3);
                    let apart = |of: &dyn Fn(usize) -> f64| {
                        let difference = |k| rows[output][column][k] - of(k);
                        norm(&(0..COUNT).map(difference).collect::<Vec<f64>>()) / scale
                    };
                    worst_complex = worst_complex.max(apart(&|k| by_complex[output][k]));
                    let central = |k: usize| (above[output][k] - below[output][k]) / 2e-8;
                    worst_central = worst_central.max(apart(&central));
                }
            }
        }
    }
    println!("against complex steps {worst_complex:.1e}, central differences {worst_central:.1e}");
    assert!(worst_complex < 1e-9, "{worst_complex:e}");
    assert!(worst_central < 1e-4, "{worst_central:e}");
}

/// Without sizes the paths are not there, to the last bit.
#[test]
fn paths_without_size_are_not_there() {
    let mut plain = document();
    for input in plain.inputs.values_mut() {
        *input = Default::default();
    }
    for output in plain.outputs.values_mut() {
        (output.lag, output.delay) = (None, None);
    }
    let [model, plain] = [document(), plain].map(|d| Model::compile(&d).expect("a model"));
    for (inputs, segment) in every_setting() {
        let of = |model| outputs(model, inputs, &segment, &SIZES[0]);
        assert_eq!(of(&model), of(&plain));
    }
}

fn problem(
    derivatives: Derivatives,
    sizes: [f64; 8],
    setting: (InputInterpolation, Segment),
) -> Problem {
    let model = Model::compile(&document()).expect("a model");
    let (input_interpolation, mut segment) = setting;
    let truth = sizes.map(|size| 0.9 * size + 0.01);
    segment.measured = outputs(&model, input_interpolation, &segment, &truth);
    for (output, series) in segment.measured.iter_mut().enumerate() {
        for (k, z) in series.iter_mut().enumerate() {
            *z = if k % 7 == output {
                f64::NAN
            } else {
                *z + 0.01 * scatter(k, output as f64)
            };
        }
    }
    let Ok(unknowns) = Unknowns::new(&model, 1, |parameter, _| {
        Ok::<f64, std::convert::Infallible>(sizes[parameter])
    });
    let options = Options {
        derivatives,
        input_interpolation,
        ..Options::default()
    };
    Problem::new(model, vec![segment], unknowns, options)
}

/// The gradient of the cost by all five techniques, with missing samples, each component times what its parameter's
/// standard error would be alone: to the accuracy that each has.
#[test]
fn five_techniques_give_one_gradient() {
    for (inputs, segment) in every_setting() {
        for sizes in SIZES {
            let of = |derivatives: Derivatives| {
                let problem = problem(derivatives, sizes, (inputs, segment.clone()));
                let theta = problem.unknowns.start();
                let equations = NormalEquations::at(&mut Evaluator::new(&problem), &theta);
                let equations = equations.expect("a gradient");
                // what has no effect at this size must have none by any technique
                let scale = |f: f64| if f > 0.0 { f.sqrt().recip() } else { 1.0 };
                let scale = equations.information.diagonal().map(scale);
                let gradient = match derivatives {
                    Derivatives::Adjoint { .. } => {
                        CostAndGradient::new(&problem)
                            .at(&theta)
                            .expect("a gradient")
                            .1
                    }
                    _ => -equations.descent,
                };
                (gradient, scale)
            };
            let (exact, scale) = of(Derivatives::default());
            for technique in Derivatives::all() {
                // half and two thirds of the digits, less what curvature and edges within the step take
                let most = match technique {
                    Derivatives::ForwardDifference { .. } => 1e-4,
                    Derivatives::CentralDifference { .. } => 1e-3,
                    _ => 1e-9,
                };
                let (found, _) = of(technique);
                let error = (&found - &exact).component_mul(&scale).norm()
                    / exact.component_mul(&scale).norm();
                println!("{:20} {error:.1e}", technique.name());
                assert!(error < most, "{} {sizes:?}: {error:e}", technique.name());
            }
        }
    }
}

/// The likelihood of the filter's innovations has its gradient, with an input on its path.
#[test]
fn the_filter_sees_inputs_on_their_paths() {
    let model = json!({
        "name": "filtered",
        "inputs": {"u": {"play": "b", "lag": "T"}},
        "parameters": {
            "L": {"unit": "1/s", "start": -1.5}, "K": {"unit": "1/s", "start": 2.0},
            "b": {"start": 0.05}, "T": {"unit": "s", "start": 0.1},
        },
        "states": {"p": {"initial": "0", "derivative": "L*p + K*u"}},
        "outputs": {"y": {"equation": "p"}},
    });
    let series = |of: &dyn Fn(usize) -> f64| (0..300).map(of).collect::<Vec<f64>>();
    let channels = [
        ("u", series(&|k| (0.05 * k as f64).sin())),
        (
            "y",
            series(&|k| (0.05 * k as f64 - 0.5).sin() + 0.1 * scatter(k, 1.0)),
        ),
    ];
    let recorded = recording(series(&|k| 0.04 * k as f64), &channels);
    let filter = json!({"options": {"estimator": "filter_error"}});
    let recorded = std::slice::from_ref(&recorded);
    let own = plan(model.clone(), filter.clone(), recorded);
    let mut evaluator = FilterEvaluator::new(&own.problem).expect("start values");
    let z = evaluator.start();
    let descent = evaluator.at(&z).expect("a gradient").descent;
    for place in 0..z.len() {
        let mut cost = |change: f64| {
            let mut moved = z.clone();
            moved[place] += change;
            evaluator.at(&moved).expect("a cost").cost
        };
        let difference = (cost(1e-6) - cost(-1e-6)) / 2e-6;
        let error = (difference + descent[place]).abs() / descent.amax();
        assert!(error < 1e-5, "{place}: {error:e}");
    }
    // an output on a path it does not know
    let mut late = model;
    late["outputs"]["y"]["lag"] = json!("T");
    let faults = try_plan(late, filter, recorded).err().expect("a fault");
    assert_eq!(faults[0].pointer, "/options/estimator");
}

#[test]
fn sizes_that_cannot_be_are_refused() {
    let time: Vec<f64> = (0..50).map(|k| 0.04 * f64::from(k)).collect();
    let recorded = ["u", "w", "y", "z", "x", "v"].map(|name| (name, vec![1.0; 50]));
    let recorded = [recording(time, &recorded)];
    let whole = || serde_json::to_value(document()).expect("JSON");
    let refused = |place: &str, size: &str| {
        let mut model = whole();
        *model.pointer_mut(place).expect("a place") = json!(size);
        let faults = try_plan(model, json!({}), &recorded)
            .err()
            .expect("a fault");
        (faults[0].pointer.clone(), faults[0].code.to_string())
    };
    for (place, size, code) in [
        ("/inputs/u/play", "T_u", "unit_mismatch"),
        ("/inputs/u/rate_limit", "b", "unit_mismatch"),
        ("/inputs/u/lag", "r", "unit_mismatch"),
        ("/outputs/y/lag", "b", "unit_mismatch"),
        ("/inputs/u/play", "w", "play_depends_on_data"),
        ("/inputs/u/rate_limit", "p*r", "rate_limit_depends_on_data"),
        ("/inputs/w/lag", "T_u + t", "lag_depends_on_data"),
        ("/outputs/z/lag", "p*T_y", "lag_depends_on_data"),
        ("/outputs/z/lag", "T_x", "unknown_symbol"),
        ("/inputs/u/play", "b +", "syntax_error"),
    ] {
        let wanted = (format!("/model{place}"), code.to_string());
        assert_eq!(refused(place, size), wanted, "{place} {size}");
    }
    let start = json!({"parameters": {"r": {"start": -1.0}}});
    let plan = plan(whole(), start, &recorded);
    let run = trimtab_core::job::run(&plan, &mut |_| std::ops::ControlFlow::Continue(()));
    let faults = run.expect_err("a fault");
    assert_eq!(&*faults[0].code, "path_out_of_bounds");
    let message = &faults[0].message;
    assert!(message.contains("rate limit of the input 'u'"), "{message}");
}

/// Edits of what is on a path already: play and lags add up, of two limits the lower one counts.
#[test]
fn edits_go_on_with_the_path_that_is_there() {
    let mut edited = document();
    let edits = [
        (EditKind::Backlash, "u"),
        (EditKind::ActuatorRateLimit, "u"),
        (EditKind::ActuatorLag, "u"),
        (EditKind::InputDelay, "u"),
        (EditKind::SensorLag, "y"),
        (EditKind::SensorDelay, "y"),
    ];
    for (kind, target) in edits {
        let more = Edit::new(kind, target).apply(&edited).expect("an edit");
        edited = more.document;
    }
    let value: Value = serde_json::to_value(&edited).expect("JSON");
    let input = json!({
        "play": "b + (u_backlash)",
        "rate_limit": "min(r, u_rate_limit)",
        "lag": "T_u + (u_lag)",
        "delay": "tau + (u_delay)",
    });
    assert_eq!(value["inputs"]["u"], input);
    assert_eq!(value["outputs"]["y"]["lag"], "T_y + (y_lag)");
    assert_eq!(value["outputs"]["y"]["delay"], "tau + (y_delay)");
    Model::compile(&edited).unwrap_or_else(|faults| panic!("{faults:#?}"));
}
