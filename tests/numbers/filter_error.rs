//! Filter error on simulated turbulence: recovers parameters and process noise, and says why where it cannot.

use std::ops::ControlFlow;
use std::sync::Arc;

use indexmap::IndexMap;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde_json::{Value, json};
use trimtab_core::estimate::{Bound, FilterEvaluator, Outcome};
use trimtab_core::flight::{Channel, Maneuver, Unit};
use trimtab_core::job::{self, Faults, JobResult, JobSpec, ModelSource, Plan};
use trimtab_core::model::{Model, ModelDocument};
use trimtab_core::simulate::Scenario;

const STEP: f64 = 0.025;

/// A short-period motion; its start values are 0.8 times the truth.
fn model() -> Value {
    json!({
        "name": "short-period-in-turbulence",
        "inputs": {"de": {"unit": "rad"}},
        "parameters": {
            "Za": {"unit": "1/s", "start": -0.72}, "Ma": {"unit": "1/s^2", "start": -3.2},
            "Mq": {"unit": "1/s", "start": -1.44}, "Mde": {"unit": "1/s^2", "start": -4.0},
        },
        "states": {
            "alpha": {"unit": "rad", "initial": "0", "derivative": "Za*alpha + q"},
            "q": {"unit": "rad/s", "initial": "0", "derivative": "Ma*alpha + Mq*q + Mde*de"},
        },
        "outputs": {
            "alpha": {"unit": "rad", "equation": "alpha"}, "q": {"unit": "rad/s", "equation": "q"},
            "qdot": {"unit": "rad/s^2", "equation": "Ma*alpha + Mq*q + Mde*de"},
        },
    })
}

const TRUTH: [(&str, f64); 4] = [("Za", -0.9), ("Ma", -4.0), ("Mq", -1.8), ("Mde", -5.0)];

/// In the states' units per √s.
const TURBULENCE: [(&str, f64); 2] = [("alpha", 0.01), ("q", 0.03)];

fn flown(seed: u64, duration: f64, process_noise: Value) -> Arc<Maneuver> {
    let scenario = json!({
        "model": "the test's own", "seed": seed, "step": STEP, "duration": duration,
        "truth": TRUTH.into_iter().collect::<IndexMap<_, _>>(), "process_noise": process_noise,
        "inputs": {"de": {"unit": "rad", "design": {"shape": "3-2-1-1", "start": 1.0, "unit_time": 0.7, "amplitude": 0.05}}},
        "outputs": {
            "alpha": {"unit": "rad", "noise": 0.003}, "q": {"unit": "rad/s", "noise": 0.005},
            "qdot": {"unit": "rad/s^2", "noise": 0.05},
        },
    });
    let scenario: Scenario = serde_json::from_value(scenario).expect("a scenario");
    let document: ModelDocument = serde_json::from_value(model()).expect("a document");
    let model = Model::compile(&document).expect("a model");
    Arc::new(scenario.fly(&model).expect("a maneuver"))
}

fn turbulence() -> Value {
    json!(TURBULENCE.into_iter().collect::<IndexMap<_, _>>())
}

fn prepare(model: Value, options: Value, maneuvers: &[Arc<Maneuver>]) -> Result<Plan, Faults> {
    let uses: Vec<Value> = maneuvers
        .iter()
        .map(|m| json!({"id": m.digest()}))
        .collect();
    let spec = json!({"model": model, "options": options, "maneuvers": uses});
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    let ModelSource::Document(document) = &spec.model else {
        panic!("a document")
    };
    job::prepare(&spec, document, maneuvers)
}

fn solve(model: Value, options: Value, maneuvers: &[Arc<Maneuver>]) -> JobResult {
    let plan = prepare(model, options, maneuvers).unwrap_or_else(|faults| panic!("{faults:#?}"));
    job::run(&plan, &mut |_| ControlFlow::Continue(()))
        .unwrap_or_else(|faults| panic!("{faults:#?}"))
}

fn filter_error() -> Value {
    json!({"estimator": "filter_error"})
}

/// Errors over 50 seeds, in standard errors. The deviation of 50 errors is known to 10 %, their mean to 0.14: three of
/// those. R is full: the error of a predicted state is in all outputs that show it, so that innovations are correlated
/// even where the measurement noises are not. With a diagonal R, as the field's programs have it, Mq and the intensity
/// of q come out 0.7 standard errors off in the mean.
#[test]
fn recovers_parameters_and_process_noise_within_their_error_bounds() {
    const SEEDS: u64 = 50;
    let truth: IndexMap<&str, f64> = TRUTH.into_iter().chain(TURBULENCE).collect();
    let mut errors: IndexMap<String, Vec<f64>> = IndexMap::new();
    for seed in 0..SEEDS {
        let full = json!({"kind": "estimated", "structure": "full"});
        let options = json!({"estimator": "filter_error", "noise": full});
        let result = solve(model(), options, &[flown(seed, 20.0, turbulence())]);
        let estimate = result.estimate;
        assert_eq!(
            estimate.outcome,
            Outcome::Converged,
            "seed {seed}: {}",
            estimate.reason
        );
        let filter = estimate.filter.expect("a filter");
        let parameters = estimate.parameters.into_iter();
        let parameters = parameters.map(|p| (p.name, p.estimate, p.standard_error));
        let noises = filter.process_noise.into_iter();
        let noises = noises.map(|p| (p.state, p.estimate, p.standard_error));
        for (name, value, bound) in parameters.chain(noises) {
            let error = (value - truth[&*name]) / bound.expect("a bound");
            errors.entry(name).or_default().push(error);
        }
    }
    assert_eq!(errors.len(), 6);
    for (name, errors) in errors {
        let count = errors.len() as f64;
        let mean = errors.iter().sum::<f64>() / count;
        let squares: f64 = errors.iter().map(|e| (e - mean).powi(2)).sum();
        let deviation = (squares / (count - 1.0)).sqrt();
        let covered = errors.iter().filter(|e| e.abs() < 2.0).count();
        println!(
            "{name:6} error over bound: mean {mean:+.2}, deviation {deviation:.2}, {covered} of {SEEDS} within 2"
        );
        assert!(
            mean.abs() < 0.45 && (0.7..1.3).contains(&deviation),
            "{name}: {mean} {deviation}"
        );
    }
}

/// The steady gain of one state has a closed form: P = (a + √(a² + g f²)) / g with g = c²/(r Δt).
#[test]
fn the_gain_of_one_state_is_the_closed_form() {
    let one = json!({
        "name": "one", "inputs": {"de": {"unit": "rad"}},
        "parameters": {"a": {"unit": "1/s", "start": -1.0}, "b": {"unit": "1/s^2", "start": -4.0}},
        "states": {"q": {"unit": "rad/s", "initial": "0", "derivative": "a*q + b*de"}},
        "outputs": {"q": {"unit": "rad/s", "equation": "2*q"}},
    });
    let result = solve(one, filter_error(), &[flown(1, 20.0, turbulence())]);
    let filter = result.estimate.filter.expect("a filter");
    let (a, f) = (
        result.estimate.parameters[0].estimate,
        filter.process_noise[0].estimate,
    );
    let r = filter.gain_covariance[0][0];
    let g = 4.0 / (r * STEP);
    let p = (a + (a * a + g * f * f).sqrt()) / g;
    let gain = filter.gains[0].gain[0][0];
    assert!(
        (gain / (2.0 * p / r) - 1.0).abs() < 1e-10,
        "{gain} {}",
        2.0 * p / r
    );
    // RK4's map of one step, behind the correction
    let pole = (a * STEP).exp() * (1.0 - 2.0 * gain);
    assert!((filter.gains[0].poles[0].real - pole).abs() < 1e-8);
    // at the optimum R in the gain is that of the innovations
    let innovations = result.estimate.noise_covariance[0][0];
    assert!((r / innovations - 1.0).abs() < 1e-5);
}

/// Several segments with samples missing, each with an initial state of its own that is unknown, and one or several integration steps
/// from each sample to the next; central differences whose truncation error is below 1e-7 of the gradient.
#[test]
fn the_gradient_is_that_of_the_likelihood() {
    let mut own = model();
    own["parameters"]["alpha_0"] = json!({"unit": "rad", "start": 0.01, "per": "maneuver"});
    own["states"]["alpha"]["initial"] = json!("alpha_0");
    // curved, so that the gain depends on the initial state too
    own["states"]["q"]["derivative"] = json!("Ma*sin(3*alpha)/3 + Mq*q + Mde*de*cos(alpha)");
    own["outputs"]["qdot"]["equation"] = json!("Ma*sin(3*alpha)/3 + Mq*q + Mde*de*cos(alpha)");
    let maneuvers = [flown(5, 5.0, turbulence()), flown(6, 3.0, turbulence())];
    for structure in ["diagonal", "full"] {
        // with correlated noise all outputs at once, else each at samples of its own
        let is_lost = |output: usize, k: usize| match structure {
            "full" => k % 5 == 1,
            _ => (k + output) % 5 == 1,
        };
        let maneuvers = maneuvers.each_ref().map(|whole| sparse(whole, is_lost));
        for (integrator, steps) in [
            ("rk4", 1),
            ("rk2", 1),
            ("euler", 1),
            ("rk4", 3),
            ("euler", 2),
        ] {
            let noise = json!({"kind": "estimated", "structure": structure});
            let options = json!({
                "estimator": "filter_error", "noise": noise,
                "integrator": integrator, "steps_per_sample": steps,
            });
            let plan = prepare(own.clone(), options, &maneuvers).expect("a plan");
            let mut evaluator = FilterEvaluator::new(&plan.problem).expect("start values");
            let z = evaluator.start();
            assert_eq!(z.len(), 8);
            let descent = evaluator.at(&z).expect("a cost").descent;
            let scaled = |place: usize| descent[place] * z[place];
            let largest = (0..z.len()).map(|i| scaled(i).abs()).fold(0.0, f64::max);
            for place in 0..z.len() {
                let mut cost = |change: f64| {
                    let mut moved = z.clone();
                    moved[place] *= 1.0 + change;
                    evaluator.at(&moved).expect("a cost").cost
                };
                let difference = (cost(1e-5) - cost(-1e-5)) / 2e-5;
                let error = (difference + scaled(place)).abs() / largest;
                assert!(
                    error < 1e-6,
                    "{structure} {integrator} {steps}, unknown {place}: {error:e}"
                );
            }
        }
    }
}

/// Without process noise the gain is 0, and the estimate that of output error. So are the conventional error bounds:
/// output error's own are corrected for the colour of its residuals.
#[test]
fn without_process_noise_it_is_output_error() {
    let calm = flown(3, 20.0, json!({}));
    let none = json!({"start": 0.0, "fixed": true});
    let options = json!({"estimator": "filter_error", "process_noise": {"alpha": none, "q": none}});
    let filter = solve(model(), options, std::slice::from_ref(&calm)).estimate;
    let output = solve(model(), json!({}), &[calm]).estimate;
    assert_eq!(filter.outcome, Outcome::Converged);
    assert!((filter.cost - output.cost).abs() < 1e-6);
    for (a, b) in filter.parameters.iter().zip(&output.parameters) {
        let error = b.conventional_standard_error.expect("a bound");
        assert!((a.estimate - b.estimate).abs() < 1e-4 * error, "{}", a.name);
        assert!((a.standard_error.expect("a bound") / error - 1.0).abs() < 1e-6);
    }
}

/// `maneuver` without the values that `is_lost` picks, by output and sample.
fn sparse(maneuver: &Maneuver, is_lost: impl Fn(usize, usize) -> bool) -> Arc<Maneuver> {
    let mut channels = maneuver.channels().clone();
    for (i, name) in ["alpha", "q", "qdot"].into_iter().enumerate() {
        let values = channels[name].values.iter_mut().enumerate();
        values
            .filter(|&(k, _)| is_lost(i, k))
            .for_each(|(_, value)| *value = f64::NAN);
    }
    Arc::new(Maneuver::new(maneuver.time().to_vec(), channels).expect("a maneuver"))
}

/// At the answer's own gain, by a recursion written out here: a value that is missing corrects nothing and does not
/// count. Both outputs lack some, now and then at the same sample.
#[test]
fn missing_values_neither_correct_nor_count() {
    let one = json!({
        "name": "one", "inputs": {"de": {"unit": "rad"}},
        "parameters": {"a": {"unit": "1/s", "start": -1.0}},
        "states": {"alpha": {"unit": "rad", "initial": "0", "derivative": "a*alpha"}},
        "outputs": {"alpha": {"unit": "rad", "equation": "alpha"}, "q": {"unit": "rad/s", "equation": "-2*a*alpha"}},
    });
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let (mut alpha, mut columns) = (0.0, [vec![], vec![], vec![]]);
    for _ in 0..800 {
        for (to, value) in
            columns
                .iter_mut()
                .zip([0.0, alpha + 0.02 * normal(), 1.8 * alpha + 0.05 * normal()])
        {
            to.push(value);
        }
        alpha = alpha * (-0.9 * STEP).exp() + 0.02 * normal();
    }
    let units = [
        ("de", "rad"),
        ("alpha", "rad"),
        ("q", "rad/s"),
        ("qdot", "rad/s^2"),
    ];
    let unused = columns[0].clone();
    let channels = units.into_iter().zip(columns.into_iter().chain([unused]));
    let channels = channels.map(|((name, unit), values)| {
        let parsed = Unit::parse(unit).expect("a unit");
        (
            name.to_string(),
            Channel::from_recorded(unit, parsed, values),
        )
    });
    let time = (0..800).map(|k| k as f64 * STEP).collect();
    let whole = Maneuver::new(time, channels.collect()).expect("a maneuver");
    let maneuver = sparse(&whole, |output, k| match output {
        0 => k % 3 == 1 || (200..240).contains(&k),
        1 => k % 4 != 0,
        _ => false,
    });
    let estimate = solve(one, filter_error(), std::slice::from_ref(&maneuver)).estimate;
    assert!(estimate.outcome.is_minimum(), "{}", estimate.reason);
    let a = estimate.parameters[0].estimate;
    let gain = &estimate.filter.as_ref().expect("a filter").gains[0].gain[0];
    let ah = a * STEP;
    let step = 1.0 + ah * (1.0 + ah / 2.0 * (1.0 + ah / 3.0 * (1.0 + ah / 4.0)));
    let (mut x, mut squares, mut counts) = (0.0, [0.0; 2], [0.0_f64; 2]);
    for k in 0..800 {
        let mut correction = 0.0;
        for (j, (name, y)) in [("alpha", x), ("q", -2.0 * a * x)].into_iter().enumerate() {
            let innovation = maneuver.channels()[name].values[k] - y;
            if !innovation.is_nan() {
                correction += gain[j] * innovation;
                squares[j] += innovation * innovation;
                counts[j] += 1.0;
            }
        }
        x = step * (x + correction);
    }
    let mut cost = 0.0;
    for (j, fit) in estimate.outputs.iter().enumerate() {
        let variance = squares[j] / counts[j];
        cost += 0.5 * counts[j] * ((std::f64::consts::TAU * variance).ln() + 1.0);
        assert_eq!(fit.samples as f64, counts[j]);
        assert!((estimate.noise_covariance[j][j] / variance - 1.0).abs() < 1e-9);
    }
    assert!(
        (estimate.cost - cost).abs() < 1e-6,
        "{} {cost}",
        estimate.cost
    );
    let error = (a + 0.9) / estimate.parameters[0].standard_error.expect("a bound");
    assert!(error.abs() < 4.0, "{error}");
}

/// A calm flight: the likelihood falls with the noise of the states down to none, as the square of its intensity.
#[test]
fn calm_data_end_at_no_process_noise_and_at_the_estimate_of_output_error() {
    for seed in 0..6 {
        let calm = flown(seed, 20.0, json!({}));
        let filter = solve(model(), filter_error(), std::slice::from_ref(&calm)).estimate;
        assert!(filter.outcome.is_minimum(), "{seed}: {}", filter.reason);
        println!(
            "{seed}: {} iterations, {}",
            filter.iterations, filter.reason
        );
        assert!(filter.iterations <= 25, "{seed}: {}", filter.iterations);
        let noise = filter.filter.expect("a filter").process_noise;
        let none = noise
            .iter()
            .all(|noise| noise.at_bound == Some(Bound::Lower));
        if none {
            let output = solve(model(), json!({}), &[calm]).estimate;
            for (a, b) in filter.parameters.iter().zip(&output.parameters) {
                let error = b.conventional_standard_error.expect("a bound");
                assert!(
                    (a.estimate - b.estimate).abs() < 1e-3 * error,
                    "{seed} {}",
                    a.name
                );
            }
        }
    }
}

/// Turbulence that is not there is found to be negligible, or at least small.
#[test]
fn process_noise_that_is_not_there_is_found_small() {
    let result = solve(model(), filter_error(), &[flown(4, 20.0, json!({}))]);
    assert!(matches!(
        result.estimate.outcome,
        Outcome::Converged | Outcome::AtBound
    ));
    for (noise, (_, present)) in result
        .estimate
        .filter
        .expect("a filter")
        .process_noise
        .iter()
        .zip(TURBULENCE)
    {
        assert!(
            noise.estimate < 0.3 * present,
            "{}: {}",
            noise.state,
            noise.estimate
        );
        assert!(noise.at_bound != Some(Bound::Upper));
    }
}

/// An aircraft that diverges in a second without its control laws: output error cannot even simulate it for long,
/// one-step predictions can. Errors of a single run: four standard errors.
#[test]
fn an_unstable_aircraft_is_estimated() {
    let (za, ma, mq, mde) = (-0.9, 12.0, -1.8, -20.0);
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let (mut alpha, mut q) = (0.0_f64, 0.0_f64);
    let mut columns = vec![Vec::new(); 5];
    let mut de = 0.0;
    for k in 0..1600 {
        let command = if (k / 60) % 2 == 0 { 0.02 } else { -0.02 };
        // the control law works on the true state
        let next = command + 1.1 * alpha + 0.4 * q;
        let fine = 20;
        let qdot = ma * alpha + mq * q + mde * de;
        let recorded = [
            k as f64 * STEP,
            de,
            alpha + 0.002 * normal(),
            q + 0.004 * normal(),
            qdot + 0.05 * normal(),
        ];
        columns
            .iter_mut()
            .zip(recorded)
            .for_each(|(to, value)| to.push(value));
        let h = STEP / f64::from(fine);
        for i in 0..fine {
            let share = (f64::from(i) + 0.5) / f64::from(fine);
            let input = de + share * (next - de);
            // the midpoint rule: its error at this step is far below the noise
            let f = |a: f64, q: f64| (za * a + q, ma * a + mq * q + mde * input);
            let (a1, q1) = f(alpha, q);
            let (a2, q2) = f(alpha + 0.5 * h * a1, q + 0.5 * h * q1);
            alpha += h * a2 + 0.01 * h.sqrt() * normal();
            q += h * q2 + 0.03 * h.sqrt() * normal();
        }
        de = next;
    }
    let mut columns = columns.into_iter();
    let time = columns.next().expect("time");
    let units = [
        ("de", "rad"),
        ("alpha", "rad"),
        ("q", "rad/s"),
        ("qdot", "rad/s^2"),
    ];
    let channels = units
        .into_iter()
        .zip(columns)
        .map(|((name, unit), values)| {
            let parsed = Unit::parse(unit).expect("a unit");
            (
                name.to_string(),
                Channel::from_recorded(unit, parsed, values),
            )
        });
    let maneuver = Arc::new(Maneuver::new(time, channels.collect()).expect("a maneuver"));
    let mut start = model();
    start["parameters"]["Ma"]["start"] = json!(6.0);
    start["parameters"]["Mde"]["start"] = json!(-12.0);
    let result = solve(start, filter_error(), &[maneuver]).estimate;
    assert_eq!(result.outcome, Outcome::Converged, "{}", result.reason);
    for (parameter, truth) in result.parameters.iter().zip([za, ma, mq, mde]) {
        let error = (parameter.estimate - truth) / parameter.standard_error.expect("a bound");
        println!(
            "{} = {:.4}, {error:+.1} standard errors off",
            parameter.name, parameter.estimate
        );
        assert!(error.abs() < 4.0, "{}: {error}", parameter.name);
    }
    let poles = &result.filter.expect("a filter").gains[0].poles;
    assert!(
        poles.len() == 2 && poles.iter().all(|pole| pole.magnitude < 1.0),
        "{poles:?}"
    );
}

/// The predictions shown are those of the innovations, which are nearly white; of a simulation they would not be.
#[test]
fn residuals_are_innovations() {
    let maneuver = flown(2, 20.0, turbulence());
    let correlation = |result: &JobResult| {
        let e = &result.histories[0].outputs[0].residual;
        let products: f64 = e.windows(2).map(|pair| pair[0] * pair[1]).sum();
        products / e.iter().map(|e| e * e).sum::<f64>()
    };
    let filter = solve(model(), filter_error(), std::slice::from_ref(&maneuver));
    let output = solve(model(), json!({}), &[maneuver]);
    // that of 800 white numbers is 0.035
    assert!(
        correlation(&filter).abs() < 0.12,
        "{}",
        correlation(&filter)
    );
    assert!(correlation(&output) > 0.5, "{}", correlation(&output));
    let rms = filter.estimate.outputs[0].rms;
    assert!((rms * rms / filter.estimate.noise_covariance[0][0] - 1.0).abs() < 1e-9);
}

#[test]
fn what_it_cannot_have_is_refused_with_its_place() {
    let maneuver = flown(2, 5.0, turbulence());
    let refused = |options: Value| {
        let faults = prepare(model(), options, std::slice::from_ref(&maneuver)).err();
        let fault = faults.expect("a refusal")[0].clone();
        (fault.pointer, fault.code.to_string())
    };
    let with = |noise: Value| json!({"estimator": "filter_error", "process_noise": noise});
    let bad = |pointer: &str| (pointer.to_string(), "bad_option".to_string());
    assert_eq!(
        refused(json!({"process_noise": {"q": {"start": 0.1}}})),
        bad("/options/process_noise")
    );
    assert_eq!(
        refused(with(json!({"V": {"start": 0.1}}))),
        bad("/options/process_noise/V")
    );
    assert_eq!(
        refused(with(json!({"q": {"fixed": true}}))),
        bad("/options/process_noise/q")
    );
    assert_eq!(
        refused(with(json!({"q": {"start": 0.0}}))),
        bad("/options/process_noise/q/start")
    );
    assert_eq!(
        refused(with(json!({"q": {"start": -1.0}}))),
        bad("/options/process_noise/q/start")
    );

    let time = maneuver.time().iter().enumerate();
    let uneven = time.map(|(k, t)| t + 0.3 * STEP * (k % 2) as f64).collect();
    let uneven = Arc::new(Maneuver::new(uneven, maneuver.channels().clone()).expect("a maneuver"));
    let faults = prepare(model(), filter_error(), &[uneven])
        .err()
        .expect("a refusal");
    assert_eq!(faults[0].code, "uneven_sampling");
}

/// An integrator that no noise drives beside one that is driven: its variance fades for ever, there is no steady gain.
#[test]
fn no_steady_gain_is_an_answer_with_a_reason() {
    let mut with_constant = model();
    with_constant["states"]["bias"] =
        json!({"unit": "rad", "initial": "0", "derivative": "0*Za*alpha"});
    with_constant["outputs"]["alpha"]["equation"] = json!("alpha + bias");
    let noise = json!({"bias": {"start": 0.0, "fixed": true}});
    let options = json!({"estimator": "filter_error", "process_noise": noise});
    let plan = prepare(with_constant, options, &[flown(2, 5.0, turbulence())]).expect("a plan");
    let faults = job::run(&plan, &mut |_| ControlFlow::Continue(())).expect_err("a fault");
    assert_eq!(
        (&*faults[0].code, faults[0].pointer.as_str()),
        ("no_steady_gain", "/options/process_noise")
    );
}
