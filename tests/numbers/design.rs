//! Designed maneuvers: predicted bounds against numpy and against the scatter of simulated fits, multisines against their definition,
//! D-optimal inputs against a 3-2-1-1.

use std::sync::Arc;

use serde_json::{Value, json};
use trimtab_core::design::{DesignSpec, DesignedManeuver, Designs, design};
use trimtab_core::model::{Model, Prior, catalog};
use trimtab_core::simulate::Scenario;

use crate::common::estimation::{compiled, fly, scenario, solve_all};
use crate::common::repository;

fn plan() -> Value {
    let text = std::fs::read_to_string(repository::path("data/design/short-period.toml"));
    let plan: toml::Value = toml::from_str(&text.expect("the plan")).expect("TOML");
    serde_json::to_value(plan).expect("JSON")
}

fn designed(plan: Value) -> Designs {
    let spec: DesignSpec = serde_json::from_value(plan).expect("a plan");
    let model = compiled(&spec.scenario.model);
    design(&spec, model, f64::INFINITY).unwrap_or_else(|faults| panic!("{faults:#?}"))
}

/// The plan with these maneuvers alone, and without limits.
fn only(maneuvers: Value) -> Value {
    let mut plan = plan();
    plan["maneuvers"] = maneuvers;
    plan["rate_limits"] = json!({});
    plan["response_limits"] = json!({});
    plan
}

fn three_two_one_one() -> Value {
    json!({"name": "3-2-1-1", "design": {"kind": "multistep", "input": "de", "amplitude": 2.0, "start": 1.0, "natural_frequency": 2.0}})
}

fn error(maneuver: &DesignedManeuver, name: &str) -> f64 {
    let mut all = maneuver.parameters.iter();
    let bound = all.find(|bound| bound.name == name).expect("a parameter");
    bound.standard_error.expect("a bound")
}

/// By `tests/python/design.py`: numpy, central differences of a finer integration.
const BY_NUMPY: [(&str, f64); 9] = [
    ("Za", 7.067694e-03),
    ("Zq", 6.748578e-03),
    ("Zde", 1.030100e-02),
    ("Ma", 1.459565e-02),
    ("Mq", 1.259070e-02),
    ("Mde", 1.889788e-02),
    ("alpha_eq", 5.890013e-04),
    ("de_eq", 5.767238e-04),
    ("q_bias", 4.706356e-04),
];

#[test]
fn predicted_bounds_are_those_of_numpy() {
    let maneuver = &designed(only(json!([three_two_one_one()]))).maneuvers[0];
    assert_eq!(maneuver.unit_time, Some(0.8));
    assert_eq!(maneuver.parameters.len(), BY_NUMPY.len());
    for (name, expected) in BY_NUMPY {
        let found = error(maneuver, name);
        assert!(
            (found / expected - 1.0).abs() < 1e-4,
            "{name}: {found} for {expected}"
        );
    }
}

/// Fits of 200 maneuvers flown as they were designed: the scatter of a standard deviation over 200 is 5 %.
#[test]
fn predicted_bounds_are_the_scatter_of_200_fits() {
    let maneuver = &designed(only(json!([three_two_one_one()]))).maneuvers[0];
    let mut errors = vec![Vec::new(); BY_NUMPY.len()];
    for seed in 0..200 {
        let flown = fly(&Scenario {
            seed,
            ..maneuver.scenario.clone()
        });
        let held = json!({"start": 0.06, "fixed": true});
        let spec = json!({"model": "short-period", "maneuvers": [{"id": flown.digest()}], "parameters": {"alpha_0": held}});
        let result = solve_all("short-period", &[Arc::clone(&flown)], &spec);
        for ((name, _), errors) in BY_NUMPY.iter().zip(&mut errors) {
            let row = result
                .estimate
                .parameters
                .iter()
                .find(|row| row.name == *name);
            errors.push(row.expect("a row").estimate - maneuver.scenario.truth[*name]);
        }
    }
    for ((name, _), errors) in BY_NUMPY.iter().zip(&errors) {
        let scatter = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
        let ratio = scatter / error(maneuver, name);
        assert!(
            (0.85..1.15).contains(&ratio),
            "{name}: scatter {ratio} of what was predicted"
        );
    }
}

/// Each input of a lateral multisine against its harmonics by a transform written out, and against the other input.
#[test]
fn multisines_are_orthogonal_and_have_low_peaks() {
    let (period, step) = (20.0, 0.05);
    let mut scenario = scenario("lateral-directional-2");
    (scenario.duration, scenario.step) = (period + 2.0, step);
    let amplitudes = json!({"da": 3.0, "dr": 5.0});
    let plan = json!({
        "scenario": scenario,
        "maneuvers": [{"name": "both", "design": {"kind": "multisine", "amplitudes": amplitudes, "band": [0.1, 2.0], "start": 1.0, "period": period}}],
    });
    let maneuver = &designed(plan).maneuvers[0];
    let inputs = ["da", "dr"].map(|name| {
        let mut all = maneuver.inputs.iter();
        all.find(|input| input.name == name).expect(name)
    });
    let samples = (period / step) as usize;
    let first = (1.0 / step) as usize;
    let of = |place: usize| {
        let input = inputs[place];
        let trim = input.values[0];
        // one period, its end left out
        input.values[first..first + samples]
            .iter()
            .map(|u| u - trim)
            .collect::<Vec<f64>>()
    };
    let (a, b) = (of(0), of(1));
    let product: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
    let sizes: f64 = [&a, &b]
        .map(|u| u.iter().map(|u| u * u).sum::<f64>().sqrt())
        .iter()
        .product();
    assert!((product / sizes).abs() < 1e-12, "{}", product / sizes);
    for (input, (samples_of, amplitude)) in inputs.iter().zip([(&a, 3.0), (&b, 5.0)]) {
        assert!(input.harmonics.len() >= 19, "{:?}", input.harmonics);
        // power at its own harmonics, the same at each, and at no other
        let power = |k: usize| {
            let (mut c, mut s) = (0.0, 0.0);
            for (n, u) in samples_of.iter().enumerate() {
                let angle = std::f64::consts::TAU * (k * n) as f64 / samples as f64;
                c += u * angle.cos();
                s += u * angle.sin();
            }
            (c * c + s * s).sqrt() / samples as f64 * 2.0
        };
        let own = power(input.harmonics[0]);
        for k in 1..50 {
            let expected = if input.harmonics.contains(&k) {
                own
            } else {
                0.0
            };
            assert!(
                (power(k) - expected).abs() < 1e-10,
                "{k}: {} for {expected}",
                power(k)
            );
        }
        assert!((input.peak - amplitude).abs() < 1e-9 && samples_of[0].abs() < 1e-6);
        // by its definition
        let most = samples_of.iter().fold(f64::MIN, |m, u| m.max(*u));
        let least = samples_of.iter().fold(f64::MAX, |m, u| m.min(*u));
        let rms = (samples_of.iter().map(|u| u * u).sum::<f64>() / samples as f64).sqrt();
        let factor = (most - least) / (2.0 * 2.0_f64.sqrt() * rms);
        let told = input.relative_peak_factor.expect("it moves");
        assert!((told / factor - 1.0).abs() < 0.02, "{told} for {factor}");
        // Schroeder's phases give about 1.2; a sine has 1
        assert!(factor < 1.05, "{factor}");
    }
    assert!(
        maneuver.inputs[0]
            .harmonics
            .iter()
            .all(|k| !maneuver.inputs[1].harmonics.contains(k))
    );
}

/// Of the same amplitude and duration, and no more energy: what numpy makes of both (the same coordinate exchange, of its own
/// starts: gains of 0.234 to 0.243 in ln det), and what 60 fits realise of the prediction.
#[test]
fn an_optimal_input_tells_more_than_a_3211() {
    let optimal = json!({"name": "optimal", "design": {"kind": "optimal", "amplitudes": {"de": 2.0}, "pulse": 0.2, "start": 1.0, "end": 6.6}});
    let plan = only(json!([three_two_one_one(), optimal]));
    let designs = designed(plan.clone());
    assert_eq!(
        designs,
        designed(plan),
        "the same plan gives the same designs"
    );
    let [conventional, optimal] = designs.maneuvers.as_slice() else {
        panic!("two maneuvers");
    };
    assert!(optimal.inputs[0].energy <= conventional.inputs[0].energy * (1.0 + 1e-9));
    let ln_det = |maneuver: &DesignedManeuver| maneuver.ln_det_covariance.expect("all");
    let by_numpy = -113.299_113;
    assert!(
        (ln_det(conventional) - by_numpy).abs() < 1e-3,
        "{}",
        ln_det(conventional)
    );
    let gain = ln_det(conventional) - ln_det(optimal);
    assert!((0.2..0.3).contains(&gain), "{gain}");
    let names = ["Za", "Zq", "Zde", "Ma", "Mq", "Mde"];
    let mut sum = 0.0;
    for seed in 0..60 {
        let flown = fly(&Scenario {
            seed,
            ..optimal.scenario.clone()
        });
        let held = json!({"start": 0.06, "fixed": true});
        let spec = json!({"model": "short-period", "maneuvers": [{"id": flown.digest()}], "parameters": {"alpha_0": held}});
        let result = solve_all("short-period", &[flown], &spec);
        for name in names {
            let row = result
                .estimate
                .parameters
                .iter()
                .find(|row| row.name == name);
            let off = row.expect("a row").estimate - optimal.scenario.truth[name];
            sum += (off / error(optimal, name)).powi(2);
        }
    }
    let ratio = (sum / (60.0 * names.len() as f64)).sqrt();
    assert!(
        (0.85..1.15).contains(&ratio),
        "scatter {ratio} of what was predicted"
    );
}

/// A pattern that leaves a limit is no candidate.
#[test]
fn an_optimal_input_keeps_responses_within_their_limits() {
    let asked = json!([{"name": "optimal", "design": {"kind": "optimal", "amplitudes": {"de": 2.0}, "pulse": 0.2, "start": 1.0, "end": 6.6, "simulations": 600}}]);
    let free = designed(only(asked.clone()));
    let mut plan = only(asked);
    plan["response_limits"] = json!({"alpha": 1.5});
    let limited = designed(plan);
    let departure = |designs: &Designs| designs.maneuvers[0].responses[0].departure;
    assert!(departure(&free) > 1.5, "{}", departure(&free));
    assert!(
        departure(&limited) <= 1.5 * (1.0 + 1e-9),
        "{}",
        departure(&limited)
    );
    let ln_det = |designs: &Designs| designs.maneuvers[0].ln_det_covariance.expect("all");
    assert!(ln_det(&free) < ln_det(&limited));
}

#[test]
fn limits_of_rate_and_response_are_kept() {
    let designs = designed(plan());
    for maneuver in &designs.maneuvers {
        let input = &maneuver.inputs[0];
        assert!(
            input.peak <= 2.0 + 1e-9 && input.rate <= 40.0 * (1.0 + 1e-9),
            "{}: {}",
            maneuver.name,
            input.rate
        );
        let alpha = maneuver
            .responses
            .iter()
            .find(|response| response.name == "alpha")
            .expect("alpha");
        assert!(
            alpha.departure <= 3.0 * (1.0 + 1e-9),
            "{}: {}",
            maneuver.name,
            alpha.departure
        );
        // flown from its scenario it is the same
        let flown = fly(&maneuver.scenario);
        let channel = &flown.channels()["de"];
        for (expected, found) in input.values.iter().zip(&channel.values) {
            assert!(
                (expected.to_radians() - found).abs() < 1e-12,
                "{}",
                maneuver.name
            );
        }
    }
    // without its limit the response of a slow 3-2-1-1 is larger
    let free = designed(only(
        json!([{"name": "slow", "design": {"kind": "multistep", "input": "de", "amplitude": 2.0, "natural_frequency": 1.0}}]),
    ));
    assert!(free.maneuvers[0].responses[0].departure > 1.5);
    let mut limited = only(
        json!([{"name": "slow", "design": {"kind": "multistep", "input": "de", "amplitude": 2.0, "natural_frequency": 1.0}}]),
    );
    limited["response_limits"] = json!({"alpha": 1.5});
    let limited = designed(limited);
    let departure = limited.maneuvers[0].responses[0].departure;
    assert!(
        limited.maneuvers[0].reduced_to < 1.0 && departure <= 1.5 && departure > 1.3,
        "{departure}"
    );
}

/// The short period of the plan by hand: ω² = Za Mq − Ma Zq.
#[test]
fn a_multistep_is_scaled_to_the_mode_that_its_input_moves() {
    let asked = json!([{"name": "auto", "design": {"kind": "multistep", "input": "de", "shape": "doublet", "amplitude": 2.0}}]);
    let maneuver = &designed(only(asked)).maneuvers[0];
    let omega = (0.85 * 1.6 + 3.4 * 0.97_f64).sqrt();
    let found = maneuver.natural_frequency.expect("a frequency");
    assert!((found - omega).abs() < 1e-9, "{found} for {omega}");
    let expected = (2.3 / omega / 0.04).round() * 0.04;
    assert!((maneuver.unit_time.expect("a time") - expected).abs() < 1e-12);
    // of all three axes: the elevator moves the short period, the rudder the Dutch roll, each by its own frequency
    let mut six = scenario("six-degrees-of-freedom");
    six.inputs.values_mut().for_each(|input| {
        input.design = serde_json::from_value(json!({"shape": "constant"})).expect("a design");
    });
    let multistep = |input: &str| json!({"name": input, "design": {"kind": "multistep", "input": input, "amplitude": 1.0}});
    let both = designed(json!({"scenario": six, "maneuvers": [multistep("de"), multistep("dr")]}));
    let frequency = |place: usize| {
        both.maneuvers[place]
            .natural_frequency
            .expect("a frequency")
    };
    // Nelson gives 3.6 and 2.4 rad/s for this aircraft
    assert!((3.2..4.0).contains(&frequency(0)), "{}", frequency(0));
    assert!((2.0..2.7).contains(&frequency(1)), "{}", frequency(1));
    let told = |place: usize, name: &str| {
        let mut all = both.maneuvers[place].parameters.iter();
        all.find(|bound| bound.name == name)
            .expect("it")
            .standard_error
    };
    // an elevator alone says nothing of the rudder
    assert!(told(0, "Cma").is_some() && told(0, "Cndr").is_none());
    let best = both
        .together
        .iter()
        .find(|row| row.name == "Cnb")
        .expect("Cnb")
        .best
        .clone();
    assert_eq!(best.as_deref(), Some("dr"));
}

/// Two maneuvers in one plan against one of both: information adds up.
#[test]
fn maneuvers_together_tell_what_information_adds_up_to() {
    let designs = designed(only(
        json!([three_two_one_one(), {"name": "again", "design": three_two_one_one()["design"]}]),
    ));
    for row in &designs.together {
        let alone = error(&designs.maneuvers[0], &row.name);
        let both = row.standard_error.expect("a bound");
        assert!(
            (both * 2.0_f64.sqrt() / alone - 1.0).abs() < 1e-6,
            "{}: {both} of {alone}",
            row.name
        );
    }
}

/// A prior is no information of a maneuver, and not once more with each: bounds are those of the model without it, and of two small
/// maneuvers together 1/√2 of one.
#[test]
fn bounds_are_of_maneuvers_without_priors() {
    let mut small = three_two_one_one();
    small["design"]["amplitude"] = json!(0.2);
    let again = json!({"name": "again", "design": small["design"]});
    let plan = only(json!([small, again]));
    let without = designed(plan.clone());
    let spec: DesignSpec = serde_json::from_value(plan).expect("a plan");
    let mut document = catalog::find("short-period").expect("a model");
    for (name, mean) in [("Ma", -3.4), ("Za", -0.85)] {
        document.parameters[name].prior = Some(Prior { mean, sd: 0.05 });
    }
    let model = Model::compile(&document).expect("a model");
    let with = design(&spec, model, f64::INFINITY).expect("designs");
    // the priors would count: the maneuvers tell less than 0.05
    assert!(error(&without.maneuvers[0], "Ma") > 0.1);
    for row in &with.together {
        let alone = error(&with.maneuvers[0], &row.name);
        assert_eq!(alone, error(&without.maneuvers[0], &row.name));
        let both = row.standard_error.expect("a bound");
        let ratio = both * 2.0_f64.sqrt() / alone;
        assert!((ratio - 1.0).abs() < 1e-12, "{}: {ratio}", row.name);
    }
}

/// A step at the first sample by hand: 40 deg/s over 0.04 s are 1.6 deg, and then 2 deg.
#[test]
fn a_limit_of_rate_holds_from_trim_on() {
    let mut step = three_two_one_one();
    step["design"]["start"] = json!(0.0);
    let mut plan = only(json!([step]));
    let free = designed(plan.clone());
    plan["rate_limits"] = json!({"de": 40.0});
    let limited = designed(plan);
    let of = |designs: &Designs| {
        let input = &designs.maneuvers[0].inputs[0];
        let trim = designs.maneuvers[0].scenario.inputs["de"].trim;
        (input.values[0] - trim, input.values[1] - trim, input.rate)
    };
    for (found, expected) in [(of(&free), (2.0, 2.0)), (of(&limited), (1.6, 2.0))] {
        assert!((found.0 - expected.0).abs() < 1e-9, "{found:?}");
        assert!((found.1 - expected.1).abs() < 1e-9, "{found:?}");
    }
    // from 2 deg to -2 deg without a limit
    assert!((of(&free).2 - 100.0).abs() < 1e-6, "{:?}", of(&free));
    assert!((of(&limited).2 - 40.0).abs() < 1e-6, "{:?}", of(&limited));
    // a pulse that moves most at its first sample
    let pulse = json!([{"name": "pulse", "design": {"kind": "scenario"}}]);
    let mut plan = only(pulse);
    plan["scenario"]["inputs"]["de"]["design"] =
        json!({"shape": "steps", "steps": [[0.0, 2.0], [1.0, 1.0], [2.0, 0.0]]});
    let rate = of(&designed(plan)).2;
    assert!((rate - 50.0).abs() < 1e-6, "{rate}");
}

#[test]
fn what_does_not_fit_is_told_by_pointer() {
    let refused = |change: &dyn Fn(&mut Value)| {
        let mut plan = plan();
        change(&mut plan);
        let spec: DesignSpec = serde_json::from_value(plan).expect("a plan");
        let model = compiled(&spec.scenario.model);
        let faults = design(&spec, model, 1e7).expect_err("a fault");
        (faults[0].pointer.clone(), faults[0].message.clone())
    };
    let of = |maneuver: Value| {
        move |plan: &mut Value| plan["maneuvers"] = json!([{"name": "x", "design": maneuver}])
    };
    type Change = Box<dyn Fn(&mut Value)>;
    let cases: Vec<(&str, Change)> = vec![
        (
            "/rate_limits/x",
            Box::new(|plan| plan["rate_limits"] = json!({"x": 1.0})),
        ),
        (
            "/response_limits/alpha",
            Box::new(|plan| plan["response_limits"]["alpha"] = json!(-1.0)),
        ),
        (
            "/scenario/outputs/q/noise",
            Box::new(|plan| plan["scenario"]["outputs"]["q"]["noise"] = json!(0.0)),
        ),
        (
            "/scenario/process_noise",
            Box::new(|plan| plan["scenario"]["process_noise"] = json!({"q": 0.1})),
        ),
        ("/maneuvers", Box::new(|plan| plan["maneuvers"] = json!([]))),
        (
            "/maneuvers/1/name",
            Box::new(|plan| plan["maneuvers"][1]["name"] = json!("3-2-1-1")),
        ),
        (
            "/maneuvers/0/design/input",
            Box::new(of(
                json!({"kind": "multistep", "input": "da", "amplitude": 1.0}),
            )),
        ),
        (
            "/maneuvers/0/design/start",
            Box::new(of(
                json!({"kind": "multistep", "input": "de", "amplitude": 1.0, "start": 19.0}),
            )),
        ),
        (
            "/maneuvers/0/design/band",
            Box::new(of(
                json!({"kind": "multisine", "amplitudes": {"de": 1.0}, "band": [0.1, 30.0]}),
            )),
        ),
        (
            "/maneuvers/0/design/amplitudes/de",
            Box::new(of(
                json!({"kind": "multisine", "amplitudes": {"de": 0.0}, "band": [0.1, 1.0]}),
            )),
        ),
        (
            "/maneuvers/0/design/pulse",
            Box::new(of(
                json!({"kind": "optimal", "amplitudes": {"de": 1.0}, "pulse": 0.0}),
            )),
        ),
        (
            "/maneuvers/0/design/parameters/0",
            Box::new(of(
                json!({"kind": "optimal", "amplitudes": {"de": 1.0}, "pulse": 1.0, "parameters": ["Mx"]}),
            )),
        ),
        (
            "/maneuvers",
            Box::new(of(
                json!({"kind": "optimal", "amplitudes": {"de": 1.0}, "pulse": 1.0, "simulations": 20000}),
            )),
        ),
    ];
    for (pointer, change) in cases {
        let (found, message) = refused(&*change);
        assert_eq!(found, pointer, "{message}");
    }
}
