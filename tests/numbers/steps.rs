//! Integration steps between samples: fits of modes that are fast for the sampling rate against fits of the exact
//! solution, which is worked out here by the exponential of a matrix; and all ways of stepping against one another.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::common::plans::{parameter, plan, recording, scatter, try_plan};
use nalgebra::{DMatrix, DVector};
use serde_json::{Value, json};
use trimtab_core::estimate::derivatives::CostAndGradient;
use trimtab_core::estimate::{Derivatives, Evaluator, NormalEquations, Outcome, Problem};
use trimtab_core::flight::Maneuver;
use trimtab_core::job::{self, JobResult};
use trimtab_core::simulate::{Steps, Substeps};

fn solve(model: &Value, options: Value, maneuver: &Arc<Maneuver>) -> JobResult {
    let plan = plan(
        model.clone(),
        json!({"options": options}),
        std::slice::from_ref(maneuver),
    );
    job::run(&plan, &mut |_| ControlFlow::Continue(())).unwrap_or_else(|f| panic!("{f:#?}"))
}

/// A and B.
type Matrices = (DMatrix<f64>, DVector<f64>);

/// dx/dt = A x + B u, y = x_0, x(0) = 0; A and B by θ.
struct Linear {
    states: usize,
    matrices: fn(&[f64]) -> Matrices,
    model: fn(&[f64]) -> Value,
}

fn start(name: &str, value: f64, unit: &str) -> (String, Value) {
    (name.to_string(), json!({"start": value, "unit": unit}))
}

/// p' = -a p + b u
const ROLL: Linear = Linear {
    states: 1,
    matrices: |theta| {
        (
            DMatrix::from_element(1, 1, -theta[0]),
            DVector::from_element(1, theta[1]),
        )
    },
    model: |theta| {
        let parameters: serde_json::Map<String, Value> =
            [start("a", theta[0], "1/s"), start("b", theta[1], "1/s")]
                .into_iter()
                .collect();
        json!({
            "name": "roll", "inputs": {"u": {}}, "parameters": parameters,
            "states": {"p": {"initial": "0", "derivative": "-a*p + b*u"}},
            "outputs": {"y": {"equation": "p"}},
        })
    },
};

/// y'' = -w² y - 2 d w y' + w² b u
const BENDING: Linear = Linear {
    states: 2,
    matrices: |theta| {
        let (w, d, b) = (theta[0], theta[1], theta[2]);
        (
            DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -w * w, -2.0 * d * w]),
            DVector::from_column_slice(&[0.0, w * w * b]),
        )
    },
    model: |theta| {
        let parameters: serde_json::Map<String, Value> = [
            start("w", theta[0], "rad/s"),
            start("d", theta[1], "-"),
            start("b", theta[2], "-"),
        ]
        .into_iter()
        .collect();
        json!({
            "name": "bending", "inputs": {"u": {}}, "parameters": parameters,
            "states": {
                "x": {"initial": "0", "derivative": "v"},
                "v": {"unit": "1/s", "initial": "0", "derivative": "-w^2*x - 2*d*w*v + w^2*b*u"},
            },
            "outputs": {"y": {"equation": "x"}},
        })
    },
};

/// The way from sample to sample with inputs straight between them, exact: the exponential of the system in x, u and
/// du/dt.
fn exact(system: &Linear, theta: &[f64], u: &[f64], h: f64) -> Vec<f64> {
    let (a, b) = (system.matrices)(theta);
    let n = system.states;
    let mut whole = DMatrix::zeros(n + 2, n + 2);
    whole.view_mut((0, 0), (n, n)).copy_from(&(a * h));
    whole.view_mut((0, n), (n, 1)).copy_from(&(b * h));
    whole[(n, n + 1)] = 1.0;
    let step = whole.exp();
    let mut x = DVector::zeros(n);
    let mut y = Vec::new();
    for k in 0..u.len() {
        y.push(x[0]);
        if k + 1 < u.len() {
            let mut z = DVector::zeros(n + 2);
            z.rows_mut(0, n).copy_from(&x);
            (z[n], z[n + 1]) = (u[k], u[k + 1] - u[k]);
            x.copy_from(&(&step * z).rows(0, n));
        }
    }
    y
}

/// Least squares on the exact solution, by Gauss-Newton with central differences; from the truth.
fn exact_fit(system: &Linear, truth: &[f64], u: &[f64], z: &[f64], h: f64) -> Vec<f64> {
    let mut theta = truth.to_vec();
    for _ in 0..30 {
        let y = exact(system, &theta, u, h);
        let residual = DVector::from_iterator(z.len(), z.iter().zip(&y).map(|(z, y)| z - y));
        let mut slopes = DMatrix::zeros(z.len(), theta.len());
        for i in 0..theta.len() {
            let step = 1e-5 * theta[i].abs();
            let at = |change: f64| {
                let mut there = theta.clone();
                there[i] += change;
                exact(system, &there, u, h)
            };
            let (up, down) = (at(step), at(-step));
            for (k, (up, down)) in up.iter().zip(&down).enumerate() {
                slopes[(k, i)] = (up - down) / (2.0 * step);
            }
        }
        let normal = slopes.tr_mul(&slopes).cholesky().expect("definite");
        let change = normal.solve(&slopes.tr_mul(&residual));
        theta
            .iter_mut()
            .zip(&change)
            .for_each(|(theta, change)| *theta += change);
    }
    theta
}

/// Steps of several lengths: something for every mode.
fn input(samples: usize, h: f64) -> Vec<f64> {
    let level = |k: usize| {
        let t = k as f64 * h;
        let slow = if ((t / 1.7) as usize).is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
        slow + 0.5 * scatter(k, 0.9)
    };
    (0..samples).map(level).collect()
}

fn recorded(
    system: &Linear,
    truth: &[f64],
    rate: f64,
    noise: f64,
) -> (Vec<f64>, Vec<f64>, Arc<Maneuver>) {
    let (samples, h) = ((12.0 * rate) as usize + 120, 1.0 / rate);
    let u = input(samples, h);
    let z: Vec<f64> = exact(system, truth, &u, h)
        .into_iter()
        .enumerate()
        .map(|(k, y)| y + noise * scatter(k, 3.7))
        .collect();
    let time = (0..samples).map(|k| k as f64 * h).collect();
    let maneuver = recording(time, &[("u", u.clone()), ("y", z.clone())]);
    (u, z, maneuver)
}

/// Of the fit: the largest distance from the exact one, in standard errors.
fn distance(
    system: &Linear,
    names: &[&str],
    truth: &[f64],
    rate: f64,
    options: Value,
) -> (f64, JobResult) {
    let (u, z, maneuver) = recorded(system, truth, rate, 0.02);
    let near: Vec<f64> = truth.iter().map(|value| 0.98 * value).collect();
    let mut all = json!({"error_bounds": "conventional", "start": {"kind": "document"}});
    for (key, value) in options.as_object().expect("an object") {
        all[key] = value.clone();
    }
    let result = solve(&(system.model)(&near), all, &maneuver);
    let expected = exact_fit(system, truth, &u, &z, 1.0 / rate);
    let far = names.iter().zip(expected).map(|(name, expected)| {
        let row = parameter(&result, name);
        (row.estimate - expected).abs() / row.standard_error.expect("an error")
    });
    let far = far.fold(0.0, f64::max);
    (far, result)
}

const RATES: [f64; 4] = [10.0, 20.0, 50.0, 100.0];

#[test]
fn first_order_modes_are_as_of_the_exact_solution() {
    for rate in RATES {
        for a in [1.0, 3.0, 8.0, 12.0, 20.0, 30.0, 45.0, 60.0] {
            let (far, result) = distance(&ROLL, &["a", "b"], &[a, 7.0 * a], rate, json!({}));
            let found = &result.estimate;
            assert_eq!(
                found.outcome,
                Outcome::Converged,
                "{a} 1/s at {rate} Hz: {}",
                found.reason
            );
            let steps = found.integration.as_ref().expect("steps").most_steps();
            assert!(
                far < 0.1,
                "{a} 1/s at {rate} Hz, {steps} steps: {far} standard errors"
            );
        }
    }
}

#[test]
fn second_order_modes_are_as_of_the_exact_solution() {
    for rate in RATES {
        for frequency in [0.3, 1.0, 3.0, 6.0, 10.0, 15.0] {
            let truth = [frequency * std::f64::consts::TAU, 0.1, 1.0];
            // above half the rate there is nothing to see of its motion but an alias
            let names = ["w", "d", "b"];
            let (far, result) = distance(&BENDING, &names, &truth, rate, json!({}));
            let found = &result.estimate;
            assert!(
                found.outcome.is_minimum(),
                "{frequency} Hz at {rate} Hz: {}",
                found.reason
            );
            let steps = found.integration.as_ref().expect("steps").most_steps();
            assert!(
                far < 0.1,
                "{frequency} Hz at {rate} Hz, {steps} steps: {far} standard errors"
            );
        }
    }
}

/// One step a sample is off by many standard errors, and the shift that halving it would make says so.
#[test]
fn a_step_that_is_too_long_is_told_by_what_halving_it_does() {
    let options = json!({"steps_per_sample": 1});
    let (far, result) = distance(&ROLL, &["a", "b"], &[20.0, 140.0], 10.0, options);
    assert!(far > 3.0, "{far}");
    let integration = result.estimate.integration.expect("steps");
    assert_eq!(integration.steps_per_sample, [1]);
    let halved = integration.halved.expect("a shift");
    assert!(
        halved.most > 0.5 * far && halved.most < 2.0 * far,
        "{halved:?} {far}"
    );
    assert_eq!(halved.shifts.len(), 2);
    assert!(
        (integration.fastest - 1.9).abs() < 0.2,
        "{}",
        integration.fastest
    );
    // and where the step is short enough, that is said too
    let (far, result) = distance(&ROLL, &["a", "b"], &[1.0, 7.0], 50.0, json!({}));
    let integration = result.estimate.integration.expect("steps");
    assert_eq!(integration.steps_per_sample, [1]);
    assert!(far < 0.01 && integration.halved.expect("a shift").most < 0.02);
}

/// The shift is that of another fit with twice the steps.
#[test]
fn the_shift_is_what_another_fit_with_halved_steps_finds() {
    for model in [ROLL.model, nonlinear] {
        let (_, _, maneuver) = recorded(&ROLL, &[8.0, 40.0], 10.0, 0.02);
        let fit = |steps: usize| {
            let options = json!({"steps_per_sample": steps, "tolerance": 1e-8});
            solve(&model(&[7.0, 35.0]), options, &maneuver).estimate
        };
        let (one, two) = (fit(1), fit(2));
        let halved = one.integration.expect("steps").halved.expect("a shift");
        for ((a, b), shift) in one
            .parameters
            .iter()
            .zip(&two.parameters)
            .zip(&halved.shifts)
        {
            let moved = (b.estimate - a.estimate) / a.standard_error.expect("an error");
            let shift = shift.expect("a shift");
            assert!(
                (moved - shift).abs() < 0.1 * moved.abs() + 0.01,
                "{moved} {shift}"
            );
        }
    }
}

/// Nearly [`ROLL`], and not affine.
fn nonlinear(theta: &[f64]) -> Value {
    let mut model = (ROLL.model)(theta);
    model["states"]["p"]["derivative"] = json!("-a*p + b*u - 0.01*a*p*abs(p)");
    model
}

fn with_steps(problem: &Problem, substeps: Substeps) -> Problem {
    let mut problem = problem.clone();
    problem
        .segments
        .iter_mut()
        .for_each(|segment| segment.substeps = substeps);
    problem
}

/// Gradients of all techniques, and the cost without sensitivities, with several steps a sample; for a model with a
/// constant step, one without, and held inputs; even and uneven samples.
#[test]
fn all_techniques_agree_on_several_steps() {
    for model in [(ROLL.model)(&[6.0, 30.0]), nonlinear(&[6.0, 30.0])] {
        for interpolation in ["linear", "hold"] {
            let (_, _, maneuver) = recorded(&ROLL, &[8.0, 40.0], 10.0, 0.02);
            let options = json!({"input_interpolation": interpolation});
            let plan = plan(
                model.clone(),
                json!({"options": options}),
                std::slice::from_ref(&maneuver),
            );
            for substeps in [
                Substeps::Each(3),
                Substeps::Each(70),
                Substeps::NoLonger(0.04),
            ] {
                for uneven in [false, true] {
                    let mut problem = with_steps(&plan.problem, substeps);
                    if uneven {
                        let count = problem.segments[0].len() - 1;
                        let length = |k: usize| 0.06 + 0.05 * (k % 4) as f64;
                        problem.segments[0].steps = Steps::Uneven((0..count).map(length).collect());
                    }
                    agree(&problem);
                }
            }
        }
    }
}

fn agree(problem: &Problem) {
    let theta = problem.unknowns.start();
    let equations = |technique: Derivatives| {
        let mut problem = problem.clone();
        problem.options.derivatives = technique;
        let mut evaluator = Evaluator::new(&problem);
        let found = NormalEquations::at(&mut evaluator, &theta).expect("a cost");
        (
            found.cost(),
            found.descent.clone(),
            found.information.clone(),
        )
    };
    let (cost, descent, information) = equations(Derivatives::ForwardSensitivities {});
    let size = descent.norm();
    for technique in Derivatives::all() {
        // forward differences have half the digits, central ones two thirds
        let share = match technique {
            Derivatives::ForwardDifference { .. } => 1e-4,
            Derivatives::CentralDifference { .. } => 1e-7,
            _ => 1e-9,
        };
        let (other, gradient, matrix) = equations(technique);
        assert!(
            (other - cost).abs() < 1e-9 * cost.abs(),
            "{technique:?}: {other} {cost}"
        );
        assert!(
            (&gradient - &descent).norm() < share * size,
            "{technique:?}: {gradient} {descent}"
        );
        assert!(
            (&matrix - &information).norm() < share * information.norm(),
            "{technique:?}"
        );
    }
    let (adjoint, gradient) = CostAndGradient::new(problem).at(&theta).expect("a cost");
    assert!((adjoint - cost).abs() < 1e-9 * cost.abs());
    assert!((gradient + descent).norm() < 1e-9 * size);
}

/// A model that goes by a matrix, and the same with an unused square in it, which does not: many steps of either are the
/// exact solution.
#[test]
fn many_steps_are_the_exact_solution() {
    let truth = [25.0, 100.0];
    let (_, z, maneuver) = recorded(&ROLL, &truth, 10.0, 0.0);
    let mut general = (ROLL.model)(&truth);
    general["states"]["p"]["derivative"] = json!("-a*p + b*u + 0*p^2");
    for model in [(ROLL.model)(&truth), general] {
        let options =
            json!({"steps_per_sample": 200, "max_iterations": 0, "start": {"kind": "document"}});
        let result = solve(&model, options, &maneuver);
        for (y, z) in result.histories[0].outputs[0].model.iter().zip(&z) {
            assert!((y - z).abs() < 1e-7, "{y} {z}");
        }
    }
}

/// The filter takes the same steps: with little process noise its estimate is that of the exact fit, but for what its noise
/// model takes: half a standard error.
#[test]
fn filter_error_takes_as_many_steps() {
    let (far, result) = {
        let options = json!({"estimator": "filter_error"});
        distance(&ROLL, &["a", "b"], &[20.0, 140.0], 10.0, options)
    };
    let integration = result.estimate.integration.expect("steps");
    assert!(integration.most_steps() > 1, "{integration:?}");
    assert!(integration.halved.expect("a shift").most < 0.05);
    assert!(far < 0.5, "{far} standard errors");
}

#[test]
fn a_number_out_of_range_is_refused_by_name() {
    let (_, _, maneuver) = recorded(&ROLL, &[2.0, 14.0], 10.0, 0.02);
    for steps in [json!(0), json!(1001)] {
        let options = json!({"options": {"steps_per_sample": steps}});
        let faults = try_plan(
            (ROLL.model)(&[2.0, 14.0]),
            options,
            std::slice::from_ref(&maneuver),
        );
        let faults = faults.err().expect("a fault");
        let fault = faults.iter().next().expect("one");
        assert_eq!(fault.pointer, "/options/steps_per_sample");
    }
}

/// A motion that no number of steps can follow is refused at the door, and named.
#[test]
fn a_stiff_model_is_refused_by_name() {
    let (_, _, maneuver) = recorded(&ROLL, &[2.0, 14.0], 10.0, 0.02);
    let faults = try_plan(
        (ROLL.model)(&[5e5, 3e6]),
        json!({}),
        std::slice::from_ref(&maneuver),
    );
    let faults = faults.err().expect("a fault");
    let fault = faults
        .iter()
        .find(|fault| fault.code == "too_stiff")
        .expect("too stiff");
    assert!(fault.message.contains("'p'"), "{}", fault.message);
    // ten thousand times slower it is integrated
    let (far, _) = distance(&ROLL, &["a", "b"], &[300.0, 2100.0], 10.0, json!({}));
    assert!(far < 0.1, "{far}");
}

/// A flight that is predicted is stepped as finely as those that were fitted: its error is that of the noise, not of the
/// integration.
#[test]
fn a_prediction_takes_the_steps_of_the_estimate() {
    let truth = [20.0, 140.0];
    let [fitted, predicted] = [1e-4, 1.1e-4].map(|noise| recorded(&ROLL, &truth, 10.0, noise).2);
    let uses = json!([
        {"id": fitted.digest(), "label": "fitted"},
        {"id": predicted.digest(), "label": "predicted", "role": "validation"},
    ]);
    let plan = plan(
        (ROLL.model)(&truth),
        json!({"maneuvers": uses}),
        &[fitted, predicted],
    );
    let result = job::run(&plan, &mut |_| ControlFlow::Continue(())).expect("a result");
    let steps = result.estimate.integration.as_ref().expect("steps");
    // two are within reach of the fastest motion
    assert!(steps.most_steps() > 2, "{steps:?}");
    let rms = [
        result.estimate.outputs[0].rms,
        result.estimate.prediction[0].outputs[0].rms,
    ];
    assert!(rms[1] < 1.5 * rms[0], "{rms:?}");
}
