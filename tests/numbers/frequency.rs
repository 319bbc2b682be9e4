//! Output error and equation error in the frequency domain, against an independent computation, known truth and output
//! error in the time domain.

use std::sync::Arc;

use serde_json::{Value, json};
use trimtab_core::estimate::Estimate;
use trimtab_core::flight::Maneuver;
use trimtab_core::ingest::{Format, Limits, read};
use trimtab_core::job::JobSpec;
use trimtab_core::model::{Model, ModelDocument, catalog};
use trimtab_core::simulate::Scenario;

use crate::common::coverage::{Coverage, fit, over_seeds};
use crate::common::plans::{parameter, recording, scatter, solve, try_plan};

const ELEVATOR: &str = include_str!("../../data/elevator.toml");

fn elevator() -> (ModelDocument, Model, Scenario) {
    let document = catalog::find("short-period").expect("a catalog model");
    let model = Model::compile(&document).expect("a model");
    (
        document,
        model,
        toml::from_str(ELEVATOR).expect("a scenario"),
    )
}

fn options(estimator: &str, band: [f64; 2], bounds: &str) -> Value {
    json!({"estimator": estimator, "frequency": {"band_hz": band}, "error_bounds": bounds, "tolerance": 1e-9})
}

/// What was recorded of data/elevator.toml.
fn recorded() -> Arc<Maneuver> {
    let text = include_bytes!("../../data/elevator.csv");
    Arc::new(read(text, Format::Csv, &Limits::default()).expect("a recording"))
}

/// By numpy 2.4 and scipy 1.17, without anything of here: Gauss-Legendre quadrature of the interpolated signals from sample to
/// sample, the frequency response of two states by Cramer's rule, scipy.optimize.least_squares on real and imaginary parts
/// with the variances found again until they stand (tests/python/frequency_domain.py).
#[test]
fn estimates_are_those_of_an_independent_computation() {
    let cases: [(&str, [f64; 6], [f64; 6]); 2] = [
        (
            "output_error_frequency",
            [
                -0.850_468_828_97,
                0.973_594_728_11,
                -0.070_253_527_66,
                -3.400_665_199_57,
                -1.599_529_222_55,
                -4.800_178_327_63,
            ],
            [
                0.007_005_414_09,
                0.006_459_653_91,
                0.009_642_126_04,
                0.014_766_948_49,
                0.012_571_428_63,
                0.019_705_836_14,
            ],
        ),
        (
            "equation_error_frequency",
            [
                -0.849_658_410_31,
                0.980_213_717_06,
                -0.053_727_255_67,
                -3.395_060_611_31,
                -1.607_790_404_21,
                -4.807_969_032_14,
            ],
            [
                0.016_771_406_64,
                0.014_123_064_42,
                0.022_089_459_32,
                0.035_742_687_75,
                0.030_098_625_15,
                0.047_076_352_27,
            ],
        ),
    ];
    for (estimator, estimates, errors) in cases {
        let changes = json!({"options": options(estimator, [0.1, 1.5], "conventional")});
        let result = solve(json!("short-period"), changes, &[recorded()]);
        let names = ["Za", "Zq", "Zde", "Ma", "Mq", "Mde"];
        for ((name, estimate), error) in names.iter().zip(estimates).zip(errors) {
            let row = parameter(&result, name);
            let found = row.standard_error.expect("an error bound");
            println!("{estimator} {name}: {} ± {found}", row.estimate);
            assert!(
                (row.estimate - estimate).abs() < 1e-5 * error,
                "{name}: {}",
                row.estimate
            );
            // 10 unknowns, those of ends and trends with them, have absorbed of the noise in 140 numbers
            let error = error * (140.0_f64 / 130.0).sqrt();
            assert!((found / error - 1.0).abs() < 1e-6, "{name}: {found}");
        }
        if estimator == "output_error_frequency" {
            let cost = result.estimate.cost;
            assert!((cost + 763.201_894_247).abs() < 1e-6, "{cost}");
        }
    }
}

fn assert_unbiased(coverage: &Coverage) {
    for (name, row) in &coverage.0 {
        assert!(row.bias().abs() < 3.0, "{name}: {}", row.bias());
    }
}

#[test]
fn output_error_is_as_accurate_as_it_says_and_agrees_with_the_time_domain() {
    let (document, model, scenario) = elevator();
    let truth = scenario.truth.clone();
    let spec = |options: Value| -> JobSpec {
        let held = json!({"alpha_0": {"start": truth["alpha_0"]}});
        let spec = json!({"model": "short-period", "maneuvers": [{"id": "x"}], "parameters": held, "options": options});
        serde_json::from_value(spec).expect("a spec")
    };
    let flown = |seed: u64| {
        let scenario = Scenario {
            seed,
            ..scenario.clone()
        };
        Arc::new(scenario.fly(&model).expect("a maneuver"))
    };
    let own = spec(options("output_error_frequency", [0.08, 2.0], "corrected"));
    let coverage = over_seeds(1..801, &truth, |seed| fit(&document, &own, flown(seed)));
    assert_eq!(coverage.0.len(), 6);
    coverage.print("output error, frequency domain");
    assert_unbiased(&coverage);
    for share in [
        coverage.pooled(|row| &row.corrected),
        coverage.pooled(|row| &row.conventional),
    ] {
        assert!((0.93..=0.97).contains(&share), "{share}");
    }

    let time = spec(json!({}));
    let mut far = 0.0_f64;
    for seed in 1..11 {
        let (a, b) = (
            fit(&document, &own, flown(seed)),
            fit(&document, &time, flown(seed)),
        );
        for (a, b) in a.parameters.iter().zip(&b.parameters) {
            if let (Some(error), true) = (a.standard_error, b.standard_error.is_some()) {
                far = far.max((a.estimate - b.estimate).abs() / error);
            }
        }
    }
    println!("farthest from output error in the time domain: {far} standard errors");
    assert!(far < 2.0, "{far}");
}

/// With noise in the states of a tenth of the usual, so that what it biases is small beside the scatter. The residual of an
/// equation grows with frequency, as iω times the noise of a state does: corrected error bounds know, conventional ones not.
#[test]
fn equation_error_is_as_accurate_as_it_says() {
    let (document, model, mut scenario) = elevator();
    for output in scenario.outputs.values_mut() {
        output.noise *= 0.1;
    }
    let truth = scenario.truth.clone();
    let spec = json!({
        "model": "short-period", "maneuvers": [{"id": "x"}],
        "options": options("equation_error_frequency", [0.08, 2.0], "corrected"),
    });
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    let coverage = over_seeds(1..201, &truth, |seed| {
        let scenario = Scenario {
            seed,
            ..scenario.clone()
        };
        fit(
            &document,
            &spec,
            Arc::new(scenario.fly(&model).expect("a maneuver")),
        )
    });
    assert_eq!(coverage.0.len(), 6);
    coverage.print("equation error, frequency domain");
    assert_unbiased(&coverage);
    let share = coverage.pooled(|row| &row.corrected);
    assert!((0.93..=0.97).contains(&share), "{share}");
}

/// One state with a delayed input and a lagged output, in pure numbers.
fn delayed() -> Value {
    json!({
        "name": "delayed",
        "inputs": {"u": {"delay": "tau"}},
        "parameters": {
            "a": {"unit": "1/s", "start": -1.0}, "b": {"unit": "1/s", "start": 1.5},
            "tau": {"unit": "s", "start": 0.1}, "T": {"unit": "s", "start": 0.1, "lower": 0.0},
            "bias": {"start": 0.0}, "drift": {"unit": "1/s", "start": 0.0},
        },
        "states": {"x": {"initial": "0", "derivative": "a*x + b*u"}},
        "outputs": {
            "y": {"equation": "x + bias + drift*t", "lag": "T"},
            "v": {"equation": "x"},
        },
    })
}

/// Simulated by the exact recursion of a state and a lag under an input held straight between samples ten times finer.
fn delayed_maneuver(seed: f64, phase: f64) -> Arc<Maneuver> {
    let (a, b, tau, lag) = (-1.7, 2.3, 0.173, 0.25);
    let (step, samples, fine) = (0.05, 400, 50);
    let input = |t: f64| {
        let t: f64 = t.max(0.0);
        // a sweep that has died away at the end
        (t * (1.0 + 0.15 * t) + phase).sin() * (1.0 - (t / 16.0).powi(2)).max(0.0)
            - phase.sin() * (1.0 - t / 2.0).max(0.0)
    };
    let h = step / f64::from(fine);
    let (mut x, mut w) = (0.0, 0.0);
    let (mut time, mut u, mut y, mut v) = (vec![], vec![], vec![], vec![]);
    for k in 0..samples {
        let t = f64::from(k) * step;
        time.push(t);
        u.push(input(t));
        y.push(w + 0.3 - 0.004 * t + 0.04 * scatter(k as usize, seed));
        v.push(x + 0.04 * scatter(k as usize, seed + 0.5));
        for i in 0..fine {
            let t = t + f64::from(i) * h;
            // Heun's method: steps are a millisecond
            let f = |x: f64, w: f64, t: f64| (a * x + b * input(t - tau), (x - w) / lag);
            let (fx, fw) = f(x, w, t);
            let (gx, gw) = f(x + h * fx, w + h * fw, t + h);
            x += 0.5 * h * (fx + gx);
            w += 0.5 * h * (fw + gw);
        }
    }
    recording(time, &[("u", u), ("y", y), ("v", v)])
}

/// Delay, lag, bias, drift, two maneuvers of one model; steps that are finer than 1/T tell no more.
#[test]
fn delays_and_lags_are_exact_and_drifts_left_out() {
    let maneuvers = [delayed_maneuver(0.1, 0.4), delayed_maneuver(0.2, 1.1)];
    let truth = [("a", -1.7), ("b", 2.3), ("tau", 0.173), ("T", 0.25)];
    let run = |frequency: Value| {
        let options = json!({"estimator": "output_error_frequency", "frequency": frequency, "tolerance": 1e-8});
        solve(delayed(), json!({"options": options}), &maneuvers)
    };
    let plain = run(json!({"band_hz": [0.06, 1.2]}));
    let fine = run(json!({"band_hz": [0.06, 1.2], "step_hz": 0.02}));
    let wide = run(
        json!({"band_hz": [0.06, 1.2], "step_hz": 0.1, "ends": "at_rest", "trend": "constant"}),
    );
    for result in [&plain, &fine, &wide] {
        assert!(
            result.estimate.outcome.is_minimum(),
            "{}",
            result.estimate.reason
        );
        for (name, truth) in truth {
            let row = parameter(result, name);
            let error = row.standard_error.expect("an error bound");
            println!("{name}: {} ± {error}", row.estimate);
            assert!(
                (row.estimate - truth).abs() < 3.5 * error,
                "{name}: {}",
                row.estimate
            );
            assert!(error < 0.02 * truth.abs() + 0.005, "{name}: {error}");
        }
    }
    for (name, _) in truth {
        let errors = [&plain, &fine].map(|r| parameter(r, name).standard_error.unwrap());
        assert!(
            (errors[1] / errors[0] - 1.0).abs() < 0.25,
            "{name}: {errors:?}"
        );
    }
    // what the band leaves out is fitted to the time histories, and has no error bound
    for (name, truth) in [("bias", 0.3), ("drift", -0.004)] {
        let row = parameter(&plain, name);
        assert!(row.standard_error.is_none());
        assert!(
            (row.estimate - truth).abs() < 0.05 * truth.abs(),
            "{name}: {}",
            row.estimate
        );
    }
    let fits = &plain.estimate.outputs;
    assert!(fits.iter().all(|fit| fit.r_squared > 0.98), "{fits:?}");
}

/// The gradient, by all parameters with ends and trends behind them, is that of the cost: a minimum of both.
#[test]
fn the_estimate_is_the_minimum_of_the_cost() {
    let maneuvers = [delayed_maneuver(0.1, 0.4)];
    let cost = |changes: Value| {
        let options = json!({
            "estimator": "output_error_frequency", "tolerance": 1e-9,
            "frequency": {"band_hz": [0.06, 1.2]}, "error_bounds": "conventional",
        });
        let result = solve(
            delayed(),
            json!({"options": options, "parameters": changes}),
            &maneuvers,
        );
        (result.estimate.cost, result)
    };
    let (least, result) = cost(json!({}));
    for name in ["a", "b", "tau", "T"] {
        let row = parameter(&result, name);
        let error = row.standard_error.expect("an error bound");
        for side in [-1.0, 1.0] {
            let moved = json!({name: {"start": row.estimate + side * 0.1 * error, "fixed": true}});
            let rise = cost(moved).0 - least;
            // ½ (Δ/σ)² of the profile of the likelihood
            assert!((rise / 0.005 - 1.0).abs() < 0.1, "{name}: {rise}");
        }
    }
}

#[test]
fn a_model_that_is_not_linear_is_told_to_be_linearised() {
    let mut document = delayed();
    document["states"]["x"]["derivative"] = json!("a*sin(x) + b*u");
    let small = |maneuver: Arc<Maneuver>| {
        let channels: Vec<(&str, Vec<f64>)> = ["u", "y", "v"]
            .map(|name| {
                (
                    name,
                    maneuver.channels()[name]
                        .values
                        .iter()
                        .map(|x| 0.01 * x)
                        .collect(),
                )
            })
            .to_vec();
        recording(maneuver.time().to_vec(), &channels)
    };
    let options = options("output_error_frequency", [0.06, 1.2], "corrected");
    let result = solve(
        document,
        json!({"options": options}),
        &[small(delayed_maneuver(0.1, 0.4))],
    );
    assert!(
        result
            .estimate
            .findings
            .iter()
            .any(|finding| finding.code == "linearised")
    );
    let a = parameter(&result, "a");
    assert!(
        (a.estimate + 1.7).abs() < 3.5 * a.standard_error.unwrap(),
        "{}",
        a.estimate
    );
}

/// An unstable state that feedback holds: no simulation follows its model over the record, and none is needed.
#[test]
fn an_unstable_aircraft_does_no_harm() {
    let (step, samples, fine, growth) = (0.01, 6000_usize, 10, 15.0);
    let h = step / f64::from(fine);
    let (mut x, mut u, mut v, mut time) = (0.0, vec![], vec![], vec![]);
    let command = |x: f64, t: f64| (t * (0.6 + 0.03 * t)).sin() + 0.5 * (1.9 * t).cos() - 12.0 * x;
    for k in 0..samples {
        let t = k as f64 * step;
        time.push(t);
        u.push(command(x, t));
        v.push(x + 0.02 * scatter(k, 0.3));
        for i in 0..fine {
            let t = t + f64::from(i) * h;
            let slope = |x: f64, t: f64| growth * x + 2.0 * command(x, t);
            let first = slope(x, t);
            let second = slope(x + h * first, t + h);
            x += 0.5 * h * (first + second);
        }
    }
    let model = json!({
        "name": "unstable", "inputs": {"u": {}}, "outputs": {"v": {"equation": "x"}},
        "parameters": {"a": {"unit": "1/s", "start": 10.0}, "b": {"unit": "1/s", "start": 1.0}},
        "states": {"x": {"initial": "0", "derivative": "a*x + b*u"}},
    });
    let options = json!({
        "estimator": "output_error_frequency",
        "frequency": {"band_hz": [0.05, 1.5]},
    });
    let changes = json!({"options": options});
    let result = solve(model, changes, &[recording(time, &[("u", u), ("v", v)])]);
    println!("{}", result.estimate.reason);
    assert!(result.estimate.outcome.is_minimum());
    for (name, truth) in [("a", growth), ("b", 2.0)] {
        let row = parameter(&result, name);
        let error = row.standard_error.expect("an error bound");
        println!("{name}: {} ± {error}", row.estimate);
        assert!((row.estimate - truth).abs() < 4.0 * error && error < 0.05 * truth);
    }
    assert!(result.histories.is_empty() && result.estimate.reason.contains("no time histories"));
    let told = serde_json::to_string(&result.estimate).expect("JSON");
    let read: Estimate = serde_json::from_str(&told).expect("an estimate");
    assert_eq!(read.parameters, result.estimate.parameters);
}

#[test]
fn bands_with_nothing_in_them_are_found() {
    let maneuvers = [delayed_maneuver(0.1, 0.4)];
    let options = options("output_error_frequency", [3.0, 6.0], "corrected");
    let result = solve(delayed(), json!({"options": options}), &maneuvers);
    let codes = |estimate: &Estimate| -> Vec<String> {
        estimate
            .findings
            .iter()
            .map(|finding| finding.code.clone())
            .collect()
    };
    assert!(codes(&result.estimate).contains(&"no_power_in_band".to_string()));
    let options = self::options("output_error_frequency", [0.1, 0.4], "corrected");
    let result = solve(delayed(), json!({"options": options}), &maneuvers);
    assert!(codes(&result.estimate).contains(&"few_frequencies".to_string()));
}

#[test]
fn what_has_no_frequency_response_is_refused_by_name() {
    let maneuver = delayed_maneuver(0.1, 0.4);
    let refused = |model: Value, frequency: Value, options: Value| {
        let mut all = json!({"estimator": "output_error_frequency", "frequency": frequency});
        for (key, value) in options.as_object().unwrap() {
            all[key] = value.clone();
        }
        if all["frequency"].is_null() {
            all.as_object_mut().unwrap().remove("frequency");
        }
        let tried = try_plan(
            model,
            json!({"options": all}),
            std::slice::from_ref(&maneuver),
        );
        let faults = tried.err().expect("a refusal");
        faults
            .iter()
            .map(|fault| fault.pointer.clone())
            .collect::<Vec<String>>()
    };
    let band = json!({"band_hz": [0.1, 1.0]});
    let none = json!({});
    let mut played = delayed();
    played["inputs"]["u"]["play"] = json!("0.01");
    assert_eq!(
        refused(played, band.clone(), none.clone()),
        ["/model/inputs/u/play"]
    );
    assert_eq!(
        refused(delayed(), json!(null), none.clone()),
        ["/options/frequency"]
    );
    for (frequency, pointer) in [
        (json!({"band_hz": [0.0, 1.0]}), "/options/frequency/band_hz"),
        (json!({"band_hz": [0.5, 0.2]}), "/options/frequency/band_hz"),
        (
            json!({"band_hz": [0.1, 11.0]}),
            "/options/frequency/band_hz",
        ),
        (
            json!({"band_hz": [0.101, 0.102]}),
            "/options/frequency/band_hz",
        ),
        (
            json!({"band_hz": [0.1, 1.0], "step_hz": 0.0}),
            "/options/frequency/step_hz",
        ),
        (
            json!({"band_hz": [0.1, 1.0], "step_hz": 2.0}),
            "/options/frequency/step_hz",
        ),
        (
            json!({"band_hz": [0.1, 1.0], "step_hz": 1e-9}),
            "/options/frequency",
        ),
    ] {
        assert_eq!(
            refused(delayed(), frequency.clone(), none.clone()),
            [pointer],
            "{frequency}"
        );
    }
    for (name, value) in [
        ("integrator", json!("rk2")),
        ("steps_per_sample", json!(2)),
        ("derivatives", json!({"technique": "adjoint"})),
        ("start", json!({"kind": "multi_start"})),
    ] {
        let found = refused(delayed(), band.clone(), json!({name: value}));
        assert_eq!(found, [format!("/options/{name}")]);
    }
    // and the others have no band
    let options = json!({"estimator": "output_error", "frequency": band});
    assert_eq!(
        refused(delayed(), band.clone(), options),
        ["/options/frequency"]
    );
}
