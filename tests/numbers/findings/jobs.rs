//! What a job asks for and what its fit comes to: constants, inputs between samples, budgets.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::{codes, fit, normal, short_period};
use crate::common::plans::{parameter, plan, recording, scatter, solve, try_plan};
use serde_json::{Value, json};
use trimtab_core::flight::{Channel, Maneuver, Severity, Unit};
use trimtab_core::job;

/// y = m a u with a mass of each maneuver's own; a by linear regression, in closed form: Σ m u z / Σ (m u)².
#[test]
fn constants_formulas_and_starts_hold_for_one_maneuver() {
    let model = json!({
        "name": "heavy-and-light", "inputs": {"u": {}},
        "constants": {"m": {"value": 1.0}},
        "parameters": {"a": {"start": 0.0}, "b": {"start": 0.0, "fixed": true, "per": "maneuver"}},
        "outputs": {"y": {"equation": "m*a*u + b"}},
    });
    let u = |k: usize| (0.1 * k as f64).sin();
    let flown = |m: f64, b: f64, seed: f64| {
        let time = (0..200).map(|k| k as f64 * 0.1).collect();
        let z = |k: usize| m * 0.7 * u(k) + b + 0.1 * scatter(k, seed);
        recording(
            time,
            &[
                ("u", (0..200).map(u).collect()),
                ("y", (0..200).map(z).collect()),
            ],
        )
    };
    let maneuvers = [flown(1.25, 0.5, 1.0), flown(-1.08, 0.0, 2.0)];
    let changes = json!({"maneuvers": [
        {"id": "heavy", "label": "heavy", "constants": {"m": 1.25}, "start": {"b": 0.5}},
        {"id": "light", "label": "light", "constants": {"m": 1.08}, "channels": {"u": "-u"}},
    ], "options": {"noise": {"kind": "given", "variance": [0.01]}, "tolerance": 1e-10}});
    let result = solve(model.clone(), changes.clone(), &maneuvers);
    let (mut up, mut down) = (0.0, 0.0);
    for (maneuver, m, b, sign) in [
        (&maneuvers[0], 1.25, 0.5, 1.0),
        (&maneuvers[1], 1.08, 0.0, -1.0),
    ] {
        for k in 0..200 {
            let x = m * sign * u(k);
            up += x * (maneuver.channels()["y"].values[k] - b);
            down += x * x;
        }
    }
    assert!((parameter(&result, "a").estimate - up / down).abs() < 1e-9);
    let masses = result
        .estimate
        .parameters
        .iter()
        .filter(|row| row.name == "m");
    let masses: Vec<(Option<&str>, f64)> = masses
        .map(|row| (row.segment.as_deref(), row.estimate))
        .collect();
    assert_eq!(masses, [(Some("heavy"), 1.25), (Some("light"), 1.08)]);
    // a diagnosis takes whatever a fit takes: with masses of their own nothing is left to be explained
    let mut asked = changes;
    asked["kind"] = json!("diagnose");
    let diagnosed = plan(model.clone(), asked, &maneuvers);
    let diagnosed = job::run_diagnosis(&diagnosed, &mut |_| ControlFlow::Continue(()));
    let diagnosed = diagnosed.unwrap_or_else(|faults| panic!("{faults:#?}"));
    assert!((parameter(&diagnosed, "a").estimate - up / down).abs() < 1e-6);
    let rows = diagnosed.estimate.parameters.iter();
    let masses: Vec<f64> = rows
        .filter(|row| row.name == "m")
        .map(|row| row.estimate)
        .collect();
    assert_eq!(masses, [1.25, 1.08]);
    for (field, name, code) in [
        ("constants", "n", "unknown_constant"),
        ("channels", "n", "unknown_channel"),
        ("start", "a", "unknown_parameter"),
    ] {
        let value = if field == "channels" {
            json!("u")
        } else {
            json!(1.0)
        };
        let wrong = json!({"maneuvers": [{"id": "heavy", field: {name: value}}]});
        let faults = try_plan(model.clone(), wrong, &maneuvers[..1])
            .err()
            .expect("a fault");
        assert_eq!(
            (&*faults[0].code, faults[0].pointer.as_str()),
            (code, format!("/maneuvers/0/{field}/{name}").as_str())
        );
    }
}

/// A roll that follows commands which are held between samples; exact by the exponential of its one mode.
#[test]
fn held_inputs_that_are_taken_as_straight_lines_are_told() {
    let model = json!({
        "name": "roll", "inputs": {"da": {"unit": "rad"}},
        "parameters": {
            "Lp": {"unit": "1/s", "start": -5.0}, "Lda": {"unit": "1/s^2", "start": 3.0},
        },
        "states": {"p": {"unit": "rad/s", "initial": "0", "derivative": "Lp*p + Lda*da"}},
        "outputs": {"p": {"unit": "rad/s", "equation": "p"}},
    });
    let command = |k: usize| 0.05 * scatter(k / 2, 3.0);
    let (mut p, mut series) = (0.0, vec![]);
    for k in 0..200 {
        series.push(p + 2e-4 * normal(k, 9.0));
        let decay = (-2.0 * 0.05_f64).exp();
        p = decay * p + (1.0 - decay) / 2.0 * 6.0 * command(k);
    }
    let channel = |unit: &str, values: Vec<f64>| {
        Channel::from_recorded(unit, Unit::parse(unit).unwrap(), values)
    };
    let channels = [
        (
            "da".to_string(),
            channel("rad", (0..200).map(command).collect()),
        ),
        ("p".to_string(), channel("rad/s", series)),
    ];
    let time = (0..200).map(|k| k as f64 * 0.05).collect();
    let maneuver = Arc::new(Maneuver::new(time, channels.into_iter().collect()).unwrap());
    let straight = solve(model.clone(), json!({}), std::slice::from_ref(&maneuver));
    assert!(
        codes(&straight.estimate.findings).contains(&"input_interpolation"),
        "{:?}",
        straight.estimate.findings
    );
    let hold = json!({"options": {"input_interpolation": "hold"}});
    let held = solve(model, hold, &[maneuver]);
    for code in ["input_interpolation", "held_channel"] {
        assert!(!codes(&held.estimate.findings).contains(&code), "{code}");
    }
    for (name, truth) in [("Lp", -2.0), ("Lda", 6.0)] {
        let row = parameter(&held, name);
        assert!(
            (row.estimate - truth).abs() < 4.0 * row.standard_error.unwrap(),
            "{row:?}"
        );
    }
}

/// The same numbers, whether a maneuver says them or the recording does.
#[test]
fn constants_stand_in_what_was_flown() {
    let model = json!({
        "name": "heavy-and-light", "inputs": {"u": {}},
        "constants": {"m": {"value": 1.0, "unit": "kg"}},
        "parameters": {"a": {"start": 0.0, "unit": "1/kg"}},
        "outputs": {"y": {"equation": "m*a*u"}},
    });
    let u = |k: usize| (0.1 * k as f64).sin();
    let flown = |m: f64, seed: f64| {
        let time = (0..200).map(|k| k as f64 * 0.1).collect();
        let z = |k: usize| m * 0.7 * u(k) + 0.1 * scatter(k, seed);
        let channels = [
            ("u", (0..200).map(u).collect()),
            ("y", (0..200).map(z).collect()),
        ];
        recording(time, &channels)
    };
    let maneuvers = [flown(1250.0, 1.0), flown(1080.0, 2.0)];
    let mass = |value: f64, unit: &str| json!({"mass": {"value": value, "unit": unit}});
    let by_number = json!({"maneuvers": [
        {"id": "heavy", "constants": {"m": 1250.0}}, {"id": "light", "constants": {"m": 1080.0}},
    ]});
    let by_recording = json!({"constants": {"m": "recording.mass"}, "maneuvers": [
        {"id": "heavy", "flown": mass(1250.0 / 0.453_592_37, "lb")}, {"id": "light", "flown": mass(1080.0, "kg")},
    ]});
    let estimate = |changes: &serde_json::Value| {
        let result = solve(model.clone(), changes.clone(), &maneuvers);
        parameter(&result, "a").estimate
    };
    let (number, recorded) = (estimate(&by_number), estimate(&by_recording));
    assert!(
        (recorded / number - 1.0).abs() < 1e-12,
        "{recorded} {number}"
    );
    // what a maneuver says of itself holds
    let mut own = by_recording.clone();
    own["maneuvers"][0]["constants"] = json!({"m": 1250.0});
    own["maneuvers"][0]["flown"] = mass(1.0, "kg");
    assert_eq!(estimate(&by_number), estimate(&own));
    let refused = |changes: serde_json::Value| {
        let faults = try_plan(model.clone(), changes, &maneuvers)
            .err()
            .expect("a fault");
        let fault = &faults[0];
        (fault.code.to_string(), fault.pointer.clone())
    };
    let mut wrong = by_recording.clone();
    wrong["maneuvers"][1]["flown"] = mass(1080.0, "m");
    assert_eq!(
        refused(wrong),
        (
            "bad_flown".to_string(),
            "/maneuvers/1/flown/mass".to_string()
        )
    );
    let mut wrong = by_recording.clone();
    wrong["maneuvers"][1]["flown"] = json!({});
    assert_eq!(
        refused(wrong),
        ("unknown_quantity".to_string(), "/constants/m".to_string())
    );
    let mut wrong = by_recording.clone();
    wrong["maneuvers"][1]["constants"] = json!({"m": "mass"});
    assert_eq!(
        refused(wrong),
        (
            "unknown_quantity".to_string(),
            "/maneuvers/1/constants/m".to_string()
        )
    );
    // a diagnosis takes them, too
    let mut diagnosis = by_recording;
    diagnosis["kind"] = json!("diagnose");
    let diagnosis = plan(model.clone(), diagnosis, &maneuvers);
    let masses = diagnosis
        .problem
        .unknowns
        .all
        .iter()
        .filter(|unknown| unknown.fixed);
    let masses: Vec<f64> = masses.map(|unknown| unknown.start).collect();
    assert!(
        (masses[0] / 1250.0 - 1.0).abs() < 1e-12 && masses[1] == 1080.0,
        "{masses:?}"
    );
}

#[test]
fn constants_of_another_aircraft_are_told() {
    let document = trimtab_core::model::catalog::find("longitudinal-nonlinear").unwrap();
    assert_eq!(document.constants["m"].value, 7472.0);
    let scenario = include_str!("../catalog/longitudinal-nonlinear.toml");
    let scenario: trimtab_core::simulate::Scenario = toml::from_str(scenario).unwrap();
    let model = trimtab_core::model::Model::compile(&document).unwrap();
    let flown = Arc::new(scenario.fly(&model).unwrap());
    let assumed = |changes: Value| {
        let plan = plan(
            json!("longitudinal-nonlinear"),
            changes,
            std::slice::from_ref(&flown),
        );
        let findings = plan.prepared.findings.into_iter();
        findings
            .filter(|finding| finding.code == "assumed_constants")
            .collect::<Vec<_>>()
    };
    let all = assumed(json!({}));
    assert!(
        all[0].message.contains("m = 7472 kg") && !all[0].message.contains("g = "),
        "{}",
        all[0].message
    );
    let given: Value = document
        .constants
        .iter()
        .map(|(name, constant)| (name.clone(), json!(constant.value)))
        .collect();
    assert_eq!(assumed(json!({"constants": given.clone()})), []);
    let own = json!({"maneuvers": [{"id": "a", "constants": given}]});
    assert_eq!(assumed(own), []);
}

/// What was stopped by its budget is no estimate, and says so in every row.
#[test]
fn a_budget_that_is_used_up_is_a_fault() {
    let short = fit(
        json!({"options": {"max_iterations": 1}}),
        &short_period(1.0),
    );
    let fault = short
        .estimate
        .findings
        .iter()
        .find(|finding| finding.code == "not_converged");
    assert_eq!(fault.expect("it").severity, Severity::Fault);
    assert!(
        short
            .estimate
            .parameters
            .iter()
            .all(|row| row.provisional != row.fixed)
    );
    let zero = fit(
        json!({"options": {"max_iterations": 0}}),
        &short_period(1.0),
    );
    assert!(!codes(&zero.estimate.findings).contains(&"not_converged"));
}
