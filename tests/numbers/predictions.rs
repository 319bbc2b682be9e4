//! An estimate along other recordings, from their inputs alone: against an integration of its own, draws, and noise.

use std::sync::Arc;

use indexmap::IndexMap;
use serde_json::{Value, json};
use trimtab_core::estimate::{Estimate, QuantityKind};
use trimtab_core::flight::{Channel, Maneuver, Unit};
use trimtab_core::job::{
    self, JobKind, JobResult, JobSpec, ManeuverUse, ModelSource, PredictedSegment, PredictionSpec,
};
use trimtab_core::simulate::Scenario;

use crate::common::estimation::{compiled, solve};
use crate::common::recordings::maneuver;

const STEP: f64 = 0.04;
const SAMPLES: usize = 201;

/// Another elevator input than was fitted, by sample: a slow push and a pull.
fn elevator() -> Vec<f64> {
    let at = |k: usize| {
        let t = k as f64 * STEP;
        -0.02 + 0.03 * (1.1 * t).sin() * (-0.1 * t).exp()
    };
    (0..SAMPLES).map(at).collect()
}

/// A recording of that input, and of what else is given.
fn recorded(others: &[(&str, Vec<f64>)]) -> Arc<Maneuver> {
    let mut channels = IndexMap::new();
    let channel = |unit: &str, values: Vec<f64>| {
        Channel::from_recorded(unit, Unit::parse(unit).expect("a unit"), values)
    };
    channels.insert("de".to_string(), channel("rad", elevator()));
    for (name, values) in others {
        let unit = if *name == "q" { "rad/s" } else { "rad" };
        channels.insert((*name).to_string(), channel(unit, values.clone()));
    }
    let time = (0..SAMPLES).map(|k| k as f64 * STEP).collect();
    Arc::new(Maneuver::new(time, channels).expect("a maneuver"))
}

fn predict(
    result: &JobResult,
    recording: &Arc<Maneuver>,
    changes: Value,
) -> Result<PredictedSegment, Vec<(String, String)>> {
    let mut wanted = json!({"maneuvers": [{"id": recording.digest(), "start": {"alpha_0": 0.06}}]});
    for (key, value) in changes.as_object().expect("an object") {
        wanted[key] = value.clone();
    }
    let wanted: PredictionSpec = serde_json::from_value(wanted).expect("a question");
    let model = ModelSource::Document(Box::new(result.model.clone()));
    let uses: Vec<ManeuverUse> = wanted.maneuvers.clone();
    let spec = JobSpec::new(JobKind::Estimate, model, uses);
    let all = std::slice::from_ref(recording);
    job::predicted(&spec, &wanted, &result.model, &result.estimate, all)
        .map(|mut segments| segments.remove(0))
        .map_err(|faults| {
            let told = faults
                .into_iter()
                .map(|fault| (fault.pointer.clone(), fault.message.clone()));
            told.collect()
        })
}

fn fitted() -> JobResult {
    let elevator = maneuver(include_bytes!("../../data/elevator.csv"));
    solve(
        "short-period",
        &elevator,
        &json!({"parameters": {"alpha_0": {"start": 0.06}}}),
    )
}

fn named(estimate: &Estimate) -> impl Fn(&str) -> f64 + '_ {
    |name| {
        let row = estimate.parameters.iter().find(|row| row.name == name);
        row.expect("the parameter").estimate
    }
}

/// α and q + q_bias at the samples for parameters by name: Heun's method, 200 steps a sample, straight inputs.
fn integrated(of: &dyn Fn(&str) -> f64) -> [Vec<f64>; 2] {
    const FINE: usize = 200;
    let [za, zq, zde, ma, mq, mde] = ["Za", "Zq", "Zde", "Ma", "Mq", "Mde"].map(of);
    let (alpha_eq, de_eq, bias) = (of("alpha_eq"), of("de_eq"), of("q_bias"));
    let input = elevator();
    let rates = |[alpha, q]: [f64; 2], de: f64| {
        let (a, d) = (alpha - alpha_eq, de - de_eq);
        [za * a + zq * q + zde * d, ma * a + mq * q + mde * d]
    };
    let mut state = [0.06, 0.0];
    let mut outputs = [vec![state[0]], vec![state[1] + bias]];
    let h = STEP / FINE as f64;
    for k in 0..SAMPLES - 1 {
        for i in 0..FINE {
            let at = |i: usize| input[k] + i as f64 / FINE as f64 * (input[k + 1] - input[k]);
            let first = rates(state, at(i));
            let moved = [state[0] + h * first[0], state[1] + h * first[1]];
            let second = rates(moved, at(i + 1));
            for (x, (a, b)) in state.iter_mut().zip(first.into_iter().zip(second)) {
                *x += 0.5 * h * (a + b);
            }
        }
        outputs[0].push(state[0]);
        outputs[1].push(state[1] + bias);
    }
    outputs
}

#[test]
fn inputs_alone_are_enough_and_bounds_are_those_of_differences() {
    let result = fitted();
    let estimate = &result.estimate;
    let found = predict(&result, &recorded(&[]), json!({})).expect("a prediction");
    assert_eq!(found.outputs, []);
    let expected = integrated(&named(estimate));
    let free: Vec<_> = estimate
        .parameters
        .iter()
        .filter(|row| !row.fixed)
        .collect();
    let errors: Vec<f64> = free
        .iter()
        .map(|row| row.standard_error.expect("a bound"))
        .collect();
    // by parameter: both outputs' slopes
    let slopes: Vec<[Vec<f64>; 2]> = free
        .iter()
        .map(|row| {
            let step = 1e-4 * (0.1 + row.estimate.abs());
            let moved = |sign: f64| {
                let of = |name: &str| {
                    let change = if name == row.name { sign * step } else { 0.0 };
                    named(estimate)(name) + change
                };
                integrated(&of)
            };
            let (above, below) = (moved(1.0), moved(-1.0));
            [0, 1].map(|output| {
                let pairs = above[output].iter().zip(&below[output]);
                pairs.map(|(a, b)| (a - b) / (2.0 * step)).collect()
            })
        })
        .collect();
    for (output, name) in ["alpha", "q"].into_iter().enumerate() {
        let series = found.output(name).expect("the output");
        assert_eq!(series.values.len(), SAMPLES);
        for k in [1, 50, 120, 200] {
            let off = (series.values[k] - expected[output][k]).abs();
            assert!(off < 1e-7, "{name} at {k}: off by {off:e}");
            let mut variance = 0.0;
            for (i, a) in slopes.iter().enumerate() {
                for (j, b) in slopes.iter().enumerate() {
                    let correlation = estimate.correlation[i][j];
                    variance += a[output][k] * b[output][k] * errors[i] * errors[j] * correlation;
                }
            }
            let found = series.standard_errors[k];
            assert!(
                (found / variance.sqrt() - 1.0).abs() < 1e-3,
                "{name} at {k}: {found}"
            );
        }
    }
}

/// The model is nearly linear over the covariance: draws range over 1.96 standard errors to both sides.
#[test]
fn draws_range_as_the_covariance_says() {
    let result = fitted();
    let question = json!({"names": ["q"], "monte_carlo": {"draws": 4000, "seed": 3}});
    let found = predict(&result, &recorded(&[]), question.clone()).expect("a prediction");
    assert_eq!(found.draws_lost, Some(0));
    let series = found.output("q").expect("the output");
    for k in [20, 60, 140, 200] {
        let width = (series.upper[k] - series.lower[k]) / (2.0 * 1.96 * series.standard_errors[k]);
        // a percentile of 4000 draws is known to 2 %
        assert!((width - 1.0).abs() < 0.06, "at {k}: {width}");
        assert!(series.lower[k] < series.values[k] && series.values[k] < series.upper[k]);
    }
    // a state of the name, and the output; the same seed, the same numbers
    let kinds: Vec<_> = found.quantities.iter().map(|series| series.kind).collect();
    assert_eq!(kinds, [QuantityKind::State, QuantityKind::Output]);
    assert_eq!(
        predict(&result, &recorded(&[]), question).expect("a prediction"),
        found
    );
}

/// Over 200 flights the truth lies within 2 standard errors, and within the range of the draws, as often as it should.
#[test]
fn bands_of_predictions_hold_the_truth() {
    const SEEDS: u64 = 200;
    let mut scenario: Scenario =
        toml::from_str(include_str!("../../data/elevator.toml")).expect("a scenario");
    scenario.duration = 16.0;
    let model = compiled("short-period");
    let truth = integrated(&|name: &str| scenario.truth[name]);
    let (mut within_errors, mut within_draws, mut all) = (0, 0, 0);
    let recording = recorded(&[]);
    for seed in 0..SEEDS {
        let flown = Scenario {
            seed,
            ..scenario.clone()
        };
        let maneuver = Arc::new(flown.fly(&model).expect("a maneuver"));
        let spec = json!({"parameters": {"alpha_0": {"start": 0.06}}});
        let result = solve("short-period", &maneuver, &spec);
        let question =
            json!({"names": ["alpha", "q"], "monte_carlo": {"draws": 400, "seed": seed}});
        let found = predict(&result, &recording, question).expect("a prediction");
        for (output, name) in ["alpha", "q"].into_iter().enumerate() {
            let series = found.output(name).expect("the output");
            for k in [30, 75, 110, 160, 200] {
                let truth = truth[output][k];
                let off = (series.values[k] - truth).abs();
                within_errors += usize::from(off < 2.0 * series.standard_errors[k]);
                within_draws += usize::from((series.lower[k]..series.upper[k]).contains(&truth));
                all += 1;
            }
        }
    }
    let [errors, draws] =
        [within_errors, within_draws].map(|n| f64::from(n as u32) / f64::from(all));
    eprintln!(
        "within 2 standard errors: {:.1} %, within the draws: {:.1} %",
        100.0 * errors,
        100.0 * draws
    );
    for share in [errors, draws] {
        assert!((0.93..=0.97).contains(&share), "{share}");
    }
}

/// What is recorded of the outputs is compared: RMS error and Theil's shares by hand, the tolerance of the pitch rate.
#[test]
fn recorded_outputs_are_compared() {
    let result = fitted();
    let [alpha, q] = integrated(&named(&result.estimate));
    // 3 deg/s beside it for a tenth of the time
    let three = 3.0_f64.to_radians();
    let measured: Vec<f64> = (q.iter().enumerate())
        .map(|(k, q)| if k < 20 { q + three } else { *q })
        .collect();
    let found = predict(&result, &recorded(&[("q", measured)]), json!({})).expect("a prediction");
    let [output] = &found.outputs[..] else {
        panic!("one recorded output: {:?}", found.outputs);
    };
    assert_eq!(
        (output.fit.name.as_str(), output.fit.samples),
        ("q", SAMPLES)
    );
    let share = 20.0 / SAMPLES as f64;
    assert!((output.fit.rms - three * share.sqrt()).abs() < 1e-7);
    assert!((output.fit.bias - three * share).abs() < 1e-7);
    assert!((output.fit.theil_shares.bias - share).abs() < 1e-5);
    let held = output.tolerance.as_ref().expect("a tolerance");
    assert_eq!(held.entry, "2.c.10");
    assert!((held.share_within - (1.0 - share)).abs() < 1e-12);
    assert!((held.largest_deviation - three).abs() < 1e-7);
    // an angle of attack has none
    let found = predict(&result, &recorded(&[("alpha", alpha)]), json!({})).expect("a prediction");
    assert_eq!(found.outputs[0].tolerance, None);
}

#[test]
fn what_cannot_be_predicted_says_why() {
    let result = fitted();
    let ask = |changes: Value| match predict(&result, &recorded(&[]), changes) {
        Ok(_) => panic!("no refusal"),
        Err(faults) => faults,
    };
    let unknown = ask(json!({"names": ["beta"]}));
    assert_eq!(unknown[0].0, "/names/0");
    assert!(unknown[0].1.contains("it has alpha, q"), "{unknown:?}");
    let few = ask(json!({"monte_carlo": {"draws": 3}}));
    assert_eq!(few[0].0, "/monte_carlo/draws");
    // without the angle of attack nobody knows where it began
    let id = recorded(&[]).digest();
    let elevator = maneuver(include_bytes!("../../data/elevator.csv"));
    let by_data = solve("short-period", &elevator, &json!({}));
    let question = json!({"maneuvers": [{"id": id}]});
    let open = match predict(&by_data, &recorded(&[]), question) {
        Ok(_) => panic!("no refusal"),
        Err(faults) => faults,
    };
    assert!(open[0].0.ends_with("/parameters/alpha_0/start"), "{open:?}");
    let unmapped = ask(json!({"channels": {"de": "stick/2"}}));
    assert!(unmapped[0].1.contains("stick"), "{unmapped:?}");
}
