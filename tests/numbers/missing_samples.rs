//! Missing samples and channels at different rates: what is not there does not count.

use std::sync::Arc;

use crate::common::plans::{gradient_errors, parameter, plan, recording, scatter, solve, try_plan};
use nalgebra::{DMatrix, DVector};
use serde_json::{Value, json};
use trimtab_core::flight::{Channel, Maneuver};
use trimtab_core::model::{Model, catalog};
use trimtab_core::simulate::Scenario;

const SAMPLES: usize = 400;

/// Two outputs that share a parameter and have one of their own each; linear, so that there is a closed form.
fn linear() -> Value {
    json!({
        "name": "linear", "inputs": {"u": {}, "w": {}},
        "parameters": {"a": {"start": 0.0}, "b": {"start": 0.0}, "c": {"start": 0.0}},
        "outputs": {"y": {"equation": "a*u + b"}, "g": {"equation": "a*w + c*u"}},
    })
}

fn series(value: impl Fn(usize) -> f64) -> Vec<f64> {
    (0..SAMPLES).map(value).collect()
}

fn time() -> Vec<f64> {
    series(|k| 0.02 * k as f64)
}

fn u(k: usize) -> f64 {
    (0.11 * k as f64).sin() + ((k / 45) % 2) as f64
}

fn w(k: usize) -> f64 {
    (0.047 * k as f64).cos()
}

/// `g` has a value at every tenth sample only.
fn two_rates() -> Arc<Maneuver> {
    let g = |k: usize| 1.5 * w(k) - 0.7 * u(k) + 0.2 * scatter(k, 3.0);
    recording(
        time(),
        &[
            ("u", series(u)),
            ("w", series(w)),
            ("y", series(|k| 1.5 * u(k) + 0.3 + 0.6 * scatter(k, 1.0))),
            ("g", series(|k| if k % 10 == 4 { g(k) } else { f64::NAN })),
        ],
    )
}

/// Weighted linear regression over the samples that are there, weights and estimate in turn until they agree:
/// the equations of maximum likelihood written out, on matrices of our own.
fn by_hand(recording: &Maneuver) -> (DVector<f64>, DMatrix<f64>, [f64; 2]) {
    let values = |name: &str| &recording.channels()[name].values;
    let rows = |k: usize| [[u(k), 1.0, 0.0], [w(k), 0.0, u(k)]];
    let mut variance = [1.0, 1.0];
    let mut theta = DVector::zeros(3);
    let mut information = DMatrix::zeros(3, 3);
    for _ in 0..200 {
        information.fill(0.0);
        let mut right = DVector::zeros(3);
        let (mut squares, mut counts) = ([0.0; 2], [0.0; 2]);
        let each = |visit: &mut dyn FnMut(usize, DVector<f64>, f64)| {
            for k in 0..SAMPLES {
                for (i, name) in ["y", "g"].into_iter().enumerate() {
                    let z = values(name)[k];
                    if !z.is_nan() {
                        visit(i, DVector::from_row_slice(&rows(k)[i]), z);
                    }
                }
            }
        };
        each(&mut |i, row, z| {
            information += &row * row.transpose() / variance[i];
            right += row * (z / variance[i]);
        });
        theta = information.clone().cholesky().unwrap().solve(&right);
        each(&mut |i, row, z| {
            squares[i] += (z - row.dot(&theta)).powi(2);
            counts[i] += 1.0;
        });
        variance = [squares[0] / counts[0], squares[1] / counts[1]];
    }
    (theta, information.try_inverse().unwrap(), variance)
}

/// Both are at the same minimum but for the solver's tolerance, set to 1e-10 standard errors, and rounding.
#[test]
fn a_channel_at_a_tenth_of_the_rate_weighs_as_it_does_by_hand() {
    let recording = two_rates();
    let (theta, covariance, variance) = by_hand(&recording);
    let changes = json!({"options": {"tolerance": 1e-10}});
    let result = solve(linear(), changes, std::slice::from_ref(&recording));
    for (i, name) in ["a", "b", "c"].into_iter().enumerate() {
        let ours = parameter(&result, name);
        // for white residuals, as by hand
        let bound = ours.conventional_standard_error.unwrap();
        let reference = covariance[(i, i)].sqrt();
        println!(
            "{name}: {} against {}, ± {bound} against {reference}",
            ours.estimate, theta[i]
        );
        assert!((ours.estimate - theta[i]).abs() < 1e-8 * reference);
        assert!((bound / reference - 1.0).abs() < 1e-8);
    }
    let estimate = &result.estimate;
    for (i, fit) in estimate.outputs.iter().enumerate() {
        assert!((estimate.noise_covariance[i][i] / variance[i] - 1.0).abs() < 1e-8);
        assert!((fit.rms.powi(2) / variance[i] - 1.0).abs() < 1e-8);
        assert_eq!(fit.samples, [SAMPLES, SAMPLES / 10][i]);
        assert!(fit.theil > 0.0 && fit.theil < 1.0 && fit.r_squared > 0.5);
    }
    let cost: f64 = variance
        .iter()
        .zip([SAMPLES, SAMPLES / 10])
        .map(|(r, n)| 0.5 * n as f64 * ((std::f64::consts::TAU * r).ln() + 1.0))
        .sum();
    assert!(
        (estimate.cost / cost - 1.0).abs() < 1e-12,
        "{} {cost}",
        estimate.cost
    );
}

/// Central differences of J where samples of either output are missing; with correlated noise where all outputs
/// are missing at once. Their truncation error at this step is below 1e-8 of the gradient.
#[test]
fn the_gradient_is_that_of_the_likelihood_of_what_is_there() {
    let model = json!({
        "name": "roll", "inputs": {"u": {}},
        "parameters": {"L": {"unit": "1/s", "start": -2.0}, "K": {"unit": "1/s", "start": 1.5}, "b": {"start": 0.1}},
        "states": {"p": {"initial": "b", "derivative": "L*p + K*u"}},
        "outputs": {"y": {"equation": "p + b"}, "z": {"equation": "L*p*dt1 + K*u*dt1"}},
        "constants": {"dt1": {"value": 1.0, "unit": "s"}},
    });
    for structure in ["diagonal", "full"] {
        let lost = |k: usize, seed: f64| match structure {
            "full" => scatter(k, 9.0) > 0.2,
            // a whole block without a value, too
            _ => scatter(k, seed) > 0.2 || (seed == 5.0 && (96..160).contains(&k)),
        };
        let made = |seed: f64, size: f64| {
            series(|k| {
                if lost(k, seed) {
                    f64::NAN
                } else {
                    size * (0.05 * k as f64).sin() + scatter(k, seed)
                }
            })
        };
        let recording = recording(
            time(),
            &[
                ("u", series(u)),
                ("y", made(5.0, 1.0)),
                ("z", made(6.0, 2.0)),
            ],
        );
        let noise = json!({"noise": {"kind": "estimated", "structure": structure}});
        let plan = plan(model.clone(), json!({"options": noise}), &[recording]);
        for (place, error) in gradient_errors(&plan, 1e-5).into_iter().enumerate() {
            assert!(error < 1e-7, "{structure}, unknown {place}: {error:e}");
        }
    }
}

/// Errors over 100 seeds with 30 % of the samples missing are as large as the bounds say (the standard deviation
/// of 100 errors is known to 7 %: 0.79 to 1.21 is three of its own), and the bounds are those of all samples
/// times √(1/0.7) = 1.195: which samples are lost moves that by about 5 %.
#[test]
fn bounds_grow_as_samples_are_lost() {
    let text = include_str!("../../data/elevator.toml");
    let mut scenario: Scenario = toml::from_str(text).expect("a scenario");
    let model = Model::compile(&catalog::find("short-period").unwrap()).unwrap();
    let held = json!({"parameters": {"alpha_0": {"start": scenario.truth["alpha_0"]}}});
    let mut errors: Vec<Vec<f64>> = Vec::new();
    let mut growth: Vec<f64> = Vec::new();
    for seed in 0..100 {
        scenario.seed = seed;
        let whole = scenario.fly(&model).expect("a maneuver");
        let mut channels = whole.channels().clone();
        for (i, name) in ["alpha", "q"].into_iter().enumerate() {
            let Channel { values, .. } = &mut channels[name];
            for (k, value) in values.iter_mut().enumerate() {
                if scatter(k, seed as f64 + 7.0 * i as f64) > 0.2 {
                    *value = f64::NAN;
                }
            }
        }
        let sparse = Maneuver::new(whole.time().to_vec(), channels).expect("a maneuver");
        let fit = |maneuver| solve(json!("short-period"), held.clone(), &[Arc::new(maneuver)]);
        let (whole, sparse) = (fit(whole), fit(sparse));
        let free = |p: &&trimtab_core::estimate::ParameterEstimate| !p.fixed;
        let pairs = whole.estimate.parameters.iter().filter(free);
        let pairs = pairs.zip(sparse.estimate.parameters.iter().filter(free));
        for (i, (all, some)) in pairs.enumerate() {
            let bound = some.standard_error.unwrap();
            errors.resize(errors.len().max(i + 1), Vec::new());
            errors[i].push((some.estimate - scenario.truth[&some.name]) / bound);
            growth.push(bound / all.standard_error.unwrap());
        }
    }
    let growth = growth.iter().sum::<f64>() / growth.len() as f64;
    println!("bounds grow by {growth:.3}");
    assert!(
        (growth / (1.0_f64 / 0.7).sqrt() - 1.0).abs() < 0.03,
        "{growth}"
    );
    assert_eq!(errors.len(), 9);
    for errors in errors {
        let deviation = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
        println!("error over bound: {deviation:.2}");
        assert!((0.79..1.21).contains(&deviation), "{deviation}");
    }
}

#[test]
fn the_log_says_what_is_missing() {
    let plan = plan(linear(), json!({}), &[two_rates()]);
    let [finding] = plan.prepared.findings.as_slice() else {
        panic!("{:#?}", plan.prepared.findings)
    };
    assert_eq!(
        (
            finding.code.as_str(),
            finding.channel.as_deref(),
            finding.count
        ),
        ("missing_values", Some("g"), SAMPLES - SAMPLES / 10)
    );
    assert!(
        finding.message.contains("360 of 400"),
        "{}",
        finding.message
    );
}

#[test]
fn correlated_noise_with_some_outputs_missing_is_refused() {
    let full = json!({"options": {"noise": {"kind": "estimated", "structure": "full"}}});
    let faults = try_plan(linear(), full, &[two_rates()])
        .err()
        .expect("a fault");
    assert_eq!(
        (faults[0].pointer.as_str(), &*faults[0].code),
        ("/options/noise", "missing_values")
    );
    assert!(
        faults[0].message.contains(" g lack"),
        "{}",
        faults[0].message
    );
}

#[test]
fn an_output_with_no_or_few_values_is_refused() {
    for present in [0, 1, 2] {
        let g = series(|k| if k < present { 1.0 } else { f64::NAN });
        let recording = recording(
            time(),
            &[
                ("u", series(u)),
                ("w", series(w)),
                ("y", series(u)),
                ("g", g),
            ],
        );
        let faults = try_plan(linear(), json!({}), &[recording])
            .err()
            .expect("a fault");
        assert_eq!(&*faults[0].code, "too_few_samples");
        // c stands in the equation of g alone: a value for it, and two for the noise
        assert!(faults[0].message.contains("'g'") && faults[0].message.contains("at least 3"));
    }
}

/// A slower input is refused as it is and accepted on straight lines between its values, where they begin and end.
#[test]
fn a_slower_input_can_be_interpolated() {
    let sparse = |values: Vec<f64>| -> Vec<f64> {
        let kept = |(k, v): (usize, f64)| if k % 3 == 0 { v } else { f64::NAN };
        values.into_iter().enumerate().map(kept).collect()
    };
    let ramp = series(|k| 0.01 * k as f64);
    let y = series(|k| 1.5 * 0.01 * k as f64 + 0.3 + 0.1 * scatter(k, 1.0));
    let g = series(|k| 1.5 * w(k) - 0.7 * 0.01 * k as f64 + 0.1 * scatter(k, 2.0));
    let channels = |u: Vec<f64>| {
        [
            ("u", u),
            ("w", series(w)),
            ("y", y.clone()),
            ("g", g.clone()),
        ]
    };
    let whole = recording(time(), &channels(ramp.clone()));
    let slower = recording(time(), &channels(sparse(ramp)));
    let faults = try_plan(linear(), json!({}), std::slice::from_ref(&slower))
        .err()
        .unwrap();
    assert_eq!(&*faults[0].code, "missing_values");
    assert!(
        faults[0].message.contains("interpolated(u)"),
        "{}",
        faults[0].message
    );
    let changes = json!({"channels": {"u": "interpolated(u)"}});
    let interpolated = solve(linear(), changes, &[slower]);
    let reference = solve(linear(), json!({}), &[whole]);
    for name in ["a", "b", "c"] {
        let (ours, theirs) = (parameter(&interpolated, name), parameter(&reference, name));
        assert!((ours.estimate - theirs.estimate).abs() < 1e-9 * theirs.estimate.abs());
    }
}
