//! Trim against balances of forces by hand, kinematics of a turn, and trims at other parameters.

use serde_json::{Value, json};
use trimtab_core::dynamics::{Trim, TrimOutcome, TrimSpec, trim, trim_of_estimate};
use trimtab_core::estimate::Estimate;
use trimtab_core::model::{Model, Start, catalog};

use crate::common::estimation::{compiled, fly, scenario};
use crate::source_code::fitted;

fn starts(model: &Model) -> Vec<f64> {
    let start = |info: &trimtab_core::model::ParameterInfo| match info.document.start {
        Start::Value(value) => info.unit.to_si(value),
        Start::FromData(_) => 0.0,
    };
    model.parameters.iter().map(start).collect()
}

fn conditions(spec: Value) -> TrimSpec {
    serde_json::from_value(spec).expect("conditions")
}

fn trimmed(model: &str, spec: Value) -> Trim {
    let model = compiled(model);
    trim(&model, &starts(&model), &conditions(spec)).unwrap_or_else(|faults| panic!("{faults:#?}"))
}

fn value(trim: &Trim, name: &str) -> f64 {
    let mut all = trim.quantities.iter();
    all.find(|quantity| quantity.name == name)
        .expect(name)
        .value
}

/// The catalog's HFB-320 in level flight: lift and thrust carry the weight, thrust along the path is drag, moments cancel; alpha by
/// bisection.
#[test]
fn level_flight_is_the_balance_of_forces() {
    let document = catalog::find("longitudinal-nonlinear").expect("a model");
    let k = |name: &str| document.constants[name].value;
    let p = |name: &str| match document.parameters[name].start {
        Start::Value(value) => value,
        Start::FromData(_) => panic!("{name} has a number"),
    };
    let v = 120.0;
    let force = 0.5 * k("rho") * v * v * k("S");
    let thrust = |alpha: f64| {
        let drag = p("CD0") + p("CDV") * v / k("V_ref") + p("CDalpha") * alpha;
        force * drag / (alpha + k("sigma_T")).cos()
    };
    let surplus = |alpha: f64| {
        let lift = p("CL0") + p("CLV") * v / k("V_ref") + p("CLalpha") * alpha;
        force * lift + thrust(alpha) * (alpha + k("sigma_T")).sin() - k("m") * k("g")
    };
    let (mut low, mut high) = (-0.2, 0.4);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if surplus(middle) > 0.0 {
            high = middle
        } else {
            low = middle
        }
    }
    let moment = p("Cm0")
        + p("CmV") * v / k("V_ref")
        + p("Cmalpha") * low
        + k("z_T") * thrust(low) / (force * k("c"));
    // at another thrust it would climb or descend: without one the path is open
    let open = trimmed("longitudinal-nonlinear", json!({"hold": {"V": v}}));
    let names: Vec<&str> = open
        .undetermined
        .iter()
        .flatten()
        .map(String::as_str)
        .collect();
    assert!(names.contains(&"thrust"), "{names:?}");
    let spec = json!({"hold": {"V": v, "thrust": thrust(low)}});
    let found = trimmed("longitudinal-nonlinear", spec);
    assert_eq!(found.outcome, TrimOutcome::Trimmed);
    assert!(found.undetermined.is_empty(), "{:?}", found.undetermined);
    let expected = [
        ("alpha", low),
        ("theta", low),
        ("q", 0.0),
        ("thrust", thrust(low)),
        ("de", -moment / p("Cmde")),
    ];
    for (name, expected) in expected {
        let off = value(&found, name) - expected;
        assert!(
            off.abs() < 1e-9 * (1.0 + expected.abs()),
            "{name}: {off} of {expected}"
        );
    }
    // the specific force along the body's z is that of the weight
    let az = -k("g") * low.cos();
    assert!(
        (value(&found, "az") - az).abs() < 1e-8,
        "{}",
        value(&found, "az")
    );
}

/// Rates of a steady turn at constant altitude are those of its heading, seen in body axes; its heading and altitude are open.
#[test]
fn a_steady_turn_has_the_rates_of_its_heading() {
    let turn = json!({"hold": {"V": "60[m/s]", "beta": 0}, "rates": {"psi": "3[deg/s]"}});
    let found = trimmed("six-degrees-of-freedom", turn);
    assert_eq!(found.outcome, TrimOutcome::Trimmed, "{found:#?}");
    let rate = 3.0_f64.to_radians();
    let (phi, theta) = (value(&found, "phi"), value(&found, "theta"));
    let expected = [
        ("p", -rate * theta.sin()),
        ("q", rate * phi.sin() * theta.cos()),
        ("r", rate * phi.cos() * theta.cos()),
    ];
    for (name, expected) in expected {
        assert!((value(&found, name) - expected).abs() < 1e-9, "{name}");
    }
    // coordinated but for the side force of the fin: tan phi near V psi'/g
    assert!((phi.tan() - 60.0 * rate / 9.80665).abs() < 0.02, "{phi}");
    let mut open = found.undetermined.clone();
    open.sort();
    assert_eq!(open, [["h"], ["psi"]]);
    let level = trimmed(
        "six-degrees-of-freedom",
        json!({"hold": {"V": 60, "beta": 0}}),
    );
    assert!(value(&level, "phi").abs() < 1e-9 && value(&level, "thrust") < value(&found, "thrust"));
}

/// Simulated from there, nothing moves.
#[test]
fn nothing_moves_at_a_trim() {
    let found = trimmed(
        "six-degrees-of-freedom",
        json!({"hold": {"V": 60, "beta": 0}}),
    );
    let mut scenario = scenario("six-degrees-of-freedom");
    let model = compiled("six-degrees-of-freedom");
    scenario.truth.clear();
    for (info, start) in model.parameters.iter().zip(starts(&model)) {
        let own = info.name.strip_suffix("_0").map(|name| value(&found, name));
        scenario
            .truth
            .insert(info.name.clone(), own.unwrap_or(start));
    }
    for (name, input) in &mut scenario.inputs {
        input.design = serde_json::from_value(json!({"shape": "constant"})).expect("a design");
        let degrees = if input.unit == "deg" {
            1_f64.to_degrees()
        } else {
            1.0
        };
        input.trim = value(&found, name) * degrees;
    }
    scenario
        .outputs
        .values_mut()
        .for_each(|output| output.noise = 0.0);
    let flown = fly(&scenario);
    for (name, channel) in flown.channels() {
        let first = channel.values[0];
        let most = channel
            .values
            .iter()
            .map(|y| (y - first).abs())
            .fold(0.0, f64::max);
        assert!(most < 1e-6 * (1.0 + first.abs()), "{name} moves by {most}");
    }
}

#[test]
fn what_cannot_be_reached_is_said_with_the_limit() {
    let spec = json!({"hold": {"V": 120, "theta": "10[deg]"}, "limits": {"thrust": [0, 2000]}});
    let found = trimmed("longitudinal-nonlinear", spec);
    assert_eq!(found.outcome, TrimOutcome::NotReached);
    let thrust = found
        .quantities
        .iter()
        .find(|q| q.name == "thrust")
        .expect("thrust");
    assert!(thrust.held && thrust.value == 2000.0, "{thrust:?}");
    // a climb is beyond what it can balance: some rate is left
    let missed = (found.conditions.iter()).map(|c| (c.reached - c.wanted).abs());
    let most = missed.fold(0.0, f64::max);
    assert!(most > 1e-3, "{:#?}", found.conditions);
    // a descent at the same thrust is there
    let spec =
        json!({"hold": {"V": 120, "thrust": 2000}, "limits": {"de": ["-25[deg]", "15[deg]"]}});
    let glide = trimmed("longitudinal-nonlinear", spec);
    assert_eq!(glide.outcome, TrimOutcome::Trimmed);
    assert!(value(&glide, "theta") < value(&glide, "alpha"));
}

#[test]
fn names_and_units_that_do_not_fit_are_told_by_pointer() {
    let model = compiled("longitudinal-nonlinear");
    let spec = conditions(json!({
        "hold": {"v": 1, "alpha": "2[m]", "V": 120}, "rates": {"de": 0}, "free_rates": ["x"],
        "start": {"CL": 1}, "limits": {"de": [1, -1], "thrust": [0, "1e400"]},
    }));
    let faults = trim(&model, &starts(&model), &spec).expect_err("faults");
    let pointers: Vec<&str> = faults.iter().map(|fault| fault.pointer.as_str()).collect();
    let expected = [
        "/rates/de",
        "/free_rates/x",
        "/hold/v",
        "/hold/alpha",
        "/start/CL",
        "/limits/de",
        "/limits/thrust/1",
    ];
    assert_eq!(pointers, expected, "{faults:#?}");
    let body = compiled("six-degrees-of-freedom");
    let faults = trim(&body, &starts(&body), &TrimSpec::default()).expect_err("no start");
    assert_eq!(
        (faults[0].pointer.as_str(), faults[0].code.as_ref()),
        ("/start", "no_start")
    );
}

/// What is held stays where it is held; limits that exclude the value are refused.
#[test]
fn what_is_held_beyond_its_limits_is_refused() {
    let model = compiled("longitudinal-nonlinear");
    for limits in [json!([0, 100]), json!(["130[m/s]", "200[m/s]"])] {
        let spec = conditions(json!({"hold": {"V": 120}, "limits": {"V": limits}}));
        let faults = trim(&model, &starts(&model), &spec).expect_err("a fault");
        assert_eq!(faults.len(), 1, "{faults:#?}");
        assert_eq!(faults[0].pointer, "/limits/V");
        let message = &faults[0].message;
        assert!(
            message.contains("held at 120")
                && message.contains("change what is held or the limits"),
            "{message}"
        );
    }
    let spec = json!({"hold": {"V": 120}, "limits": {"V": [0, 120]}});
    let found = trimmed("longitudinal-nonlinear", spec);
    assert_eq!(found.outcome, TrimOutcome::Trimmed);
    assert_eq!(value(&found, "V"), 120.0);
}

/// An angle in degrees: a text without a unit means what the same number means, and arithmetic needs a unit.
#[test]
fn a_number_in_a_text_is_in_the_unit_of_the_model() {
    let mut document = catalog::find("longitudinal-nonlinear").expect("a model");
    let at = |model: &Model, alpha: &Value| {
        let spec = conditions(json!({"hold": {"alpha": alpha}, "start": {"V": 100, "theta": 0}}));
        trim(model, &starts(model), &spec)
    };
    let in_radians = Model::compile(&document).expect("a model");
    document.states["alpha"].unit = "deg".to_string();
    let in_degrees = Model::compile(&document).expect("a model");
    let five = 5.0_f64.to_radians();
    let cases = [
        (&in_degrees, json!(5)),
        (&in_degrees, json!("5")),
        (&in_degrees, json!(" 5.0 ")),
        (&in_degrees, json!("5[deg]")),
        (&in_degrees, json!("2[deg] + 3[deg]")),
        // in SI both readings are the same
        (&in_radians, json!("pi/36")),
    ];
    for (model, alpha) in cases {
        let found = at(model, &alpha).unwrap_or_else(|faults| panic!("{alpha}: {faults:#?}"));
        assert_eq!(found.outcome, TrimOutcome::Trimmed, "{alpha}");
        let off = value(&found, "alpha") - five;
        assert!(off.abs() < 1e-15, "{alpha}: {off}");
    }
    for alpha in ["2+3", "pi/36", "5*1"] {
        let faults = at(&in_degrees, &json!(alpha)).expect_err(alpha);
        assert_eq!(faults[0].pointer, "/hold/alpha");
        let message = &faults[0].message;
        assert!(
            message.contains("write its unit in square brackets"),
            "{message}"
        );
    }
}

/// √(dᵀ P d) with d by central differences of trims at other parameters, P from standard errors and correlations.
#[test]
fn standard_errors_of_a_trim_are_those_of_its_parameters() {
    let flown = fly(&scenario("longitudinal-nonlinear"));
    let (plan, result) = fitted("longitudinal-nonlinear", &flown, json!({}));
    let estimate: &Estimate = &result.estimate;
    let spec = conditions(json!({"hold": {"V": 120, "thrust": 9000}}));
    let found = trim_of_estimate(&plan.problem, estimate, None, &spec).expect("a trim");
    let model = &plan.problem.model;
    let free: Vec<_> = estimate
        .parameters
        .iter()
        .filter(|row| !row.fixed)
        .collect();
    let at = |moved: &str, by: f64| {
        let parameters: Vec<f64> = (model.parameters.iter())
            .map(|info| {
                let row = estimate
                    .parameters
                    .iter()
                    .find(|row| row.name == info.name)
                    .expect("a row");
                info.unit.to_si(row.estimate) + if info.name == moved { by } else { 0.0 }
            })
            .collect();
        trim(model, &parameters, &spec).expect("a trim")
    };
    for name in ["alpha", "de", "theta", "CL", "az"] {
        let slopes: Vec<f64> = (free.iter())
            .map(|row| {
                let step = 0.1 * row.standard_error.expect("an error");
                let of = |by: f64| value(&at(&row.name, by), name);
                (of(step) - of(-step)) / 0.2
            })
            .collect();
        let mut variance = 0.0;
        for (i, a) in slopes.iter().enumerate() {
            for (j, b) in slopes.iter().enumerate() {
                variance += a * b * estimate.correlation[i][j];
            }
        }
        let quantity = found
            .quantities
            .iter()
            .find(|q| q.name == name)
            .expect("it");
        let error = quantity.standard_error.expect("an error");
        assert!(
            (error / variance.sqrt() - 1.0).abs() < 1e-3,
            "{name}: {error} for {}",
            variance.sqrt()
        );
    }
    // what is held is known
    let speed = found.quantities.iter().find(|q| q.name == "V").expect("V");
    assert_eq!(speed.standard_error, Some(0.0));
}
