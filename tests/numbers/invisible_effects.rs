//! What data cannot show must not be called absent: invisible effects, and the units that no residual reveals.

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use crate::common::estimation::solve;
use crate::common::recordings::{elevator, maneuver};
use serde_json::json;
use trimtab_core::diagnose::{Case, Flight, Refusal, diagnose};
use trimtab_core::estimate::{Options, Role};
use trimtab_core::flight::{Channel, Finding, Maneuver, Unit};
use trimtab_core::model::{Model, ModelDocument, catalog};
use trimtab_core::simulate::{Scenario, Steps};

/// The short period with its initial angle of attack free, and with a vertical accelerometer or without.
fn document(accelerometer: bool) -> ModelDocument {
    let mut document = catalog::find("short-period").unwrap();
    document.parameters.get_mut("alpha_0").unwrap().fixed = false;
    let az = r#"
        unit = "m/s^2"
        equation = "V_e*(Za*(alpha - alpha_eq) + (Zq - 1)*q + Zde*(de - de_eq)) + az_bias"
    "#;
    if accelerometer {
        let output = toml::from_str(az).unwrap();
        document.outputs.insert("az".to_string(), output);
        let speed = toml::from_str("value = 130.0\nunit = \"m/s\"").unwrap();
        document.constants.insert("V_e".to_string(), speed);
        let bias = toml::from_str("start = 0.0\nunit = \"m/s^2\"").unwrap();
        document.parameters.insert("az_bias".to_string(), bias);
    }
    document
}

/// Why each candidate was refused, by name, on a flight that lacks nothing.
fn refused(document: ModelDocument) -> HashMap<String, Refusal> {
    let mut scenario: Scenario = toml::from_str(include_str!("../../data/elevator.toml")).unwrap();
    if document.outputs.contains_key("az") {
        let az = r#"{"unit": "m/s^2", "noise": 0.02}"#;
        let az = serde_json::from_str(az).unwrap();
        scenario.outputs.insert("az".to_string(), az);
        scenario.truth.insert("az_bias".to_string(), 0.0);
    }
    let maneuver = scenario.fly(&Model::compile(&document).unwrap()).unwrap();
    let channels = maneuver.channels().iter();
    let flight = Flight {
        label: "elevator".to_string(),
        role: Role::Estimation,
        time: maneuver.time().to_vec(),
        steps: Steps::Even(scenario.step),
        channels: channels
            .map(|(name, c)| (name.clone(), (c.values.clone(), c.unit.dimension)))
            .collect(),
        own: Default::default(),
    };
    let case = Case {
        document,
        flights: vec![flight],
        options: Options::default(),
        candidates: Vec::new(),
        knowledge: Default::default(),
        consumed: Vec::new(),
    };
    let Ok(conclusion) = diagnose(&case, &mut |_| ControlFlow::Continue(())) else {
        panic!("no conclusion");
    };
    assert!(conclusion.diagnosis.effects.is_empty());
    (conclusion.diagnosis.refused.iter())
        .map(|refused| (refused.effect.name(), refused.reason))
        .collect()
}

/// With alpha and q alone the derivatives imitate a scale factor of either and the vane's lever arm wholly; an
/// accelerometer, which knows the path, tells them apart.
#[test]
fn an_accelerometer_makes_the_vane_visible() {
    let without = refused(document(false));
    let with = refused(document(true));
    for name in [
        "sensor_scale of alpha",
        "sensor_scale of q",
        "sensor_position of alpha (x)",
    ] {
        assert_eq!(without[name], Refusal::Invisible, "{name} without");
        assert_eq!(with[name], Refusal::NotSignificant, "{name} with");
    }
}

/// The maneuver with another unit declared for its elevator.
fn slipped(maneuver: &Maneuver, unit: &str, factor: f64) -> Arc<Maneuver> {
    let mut channels = maneuver.channels().clone();
    let elevator = &mut channels["de"];
    *elevator = Channel {
        recorded_unit: unit.to_string(),
        unit: Unit::parse(unit).unwrap(),
        values: elevator.values.iter().map(|v| v * factor).collect(),
    };
    Arc::new(Maneuver::new(maneuver.time().to_vec(), channels).unwrap())
}

fn implausible(maneuver: &Arc<Maneuver>) -> Option<Finding> {
    let spec = json!({"model": "short-period", "maneuvers": [{"id": maneuver.digest()}]});
    let spec = serde_json::from_value(spec).unwrap();
    let document = catalog::find("short-period").unwrap();
    let plan = trimtab_core::job::prepare(&spec, &document, std::slice::from_ref(maneuver));
    let mut findings = plan.unwrap().prepared.findings.into_iter();
    findings.find(|finding| finding.code == "implausible")
}

/// A header that calls degrees radians, or the reverse: the fit is as good as ever, since the control derivatives take
/// up the scale; so the range must tell, and the remedy must be the right one.
#[test]
fn a_slipped_unit_of_an_input_is_told() {
    let recorded = maneuver(elevator().as_bytes());
    assert!(implausible(&recorded).is_none());
    let right = solve("short-period", &recorded, &json!({}));
    let degree = 1f64.to_radians();
    for (unit, factor, looks, remedy) in [
        (
            "rad",
            1.0 / degree,
            "degrees declared as radians",
            "de*pi/180",
        ),
        ("deg", degree, "radians declared as degrees", "de*180/pi"),
    ] {
        let slipped = slipped(&recorded, unit, factor);
        let wrong = solve("short-period", &slipped, &json!({}));
        // the same optimum to the accuracy that both stop at
        let ratio = wrong.estimate.det_r / right.estimate.det_r;
        assert!((ratio - 1.0).abs() < 1e-4, "{ratio}");
        let found = implausible(&slipped).expect("a finding");
        assert_eq!(found.channel.as_deref(), Some("de"));
        assert!(found.message.contains(looks), "{}", found.message);
        assert!(found.remedy.contains(remedy), "{}", found.remedy);
    }
}
