//! What data cannot show must not be called absent: invisible effects, and the units that no residual reveals.

mod common;

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use common::estimation::solve;
use common::recordings::elevator;
use serde_json::json;
use trimtab::diagnose::{Case, Flight, Refusal, diagnose};
use trimtab::estimate::{Options, Role};
use trimtab::flight::{Channel, Finding, Maneuver, Unit};
use trimtab::ingest::{self, Format, Limits};
use trimtab::model::{Model, ModelDocument, catalog};
use trimtab::simulate::{Scenario, Steps};

/// The short period with its initial angle of attack free, and with a vertical accelerometer or without.
fn document(accelerometer: bool) -> ModelDocument {
    let mut document = catalog::find("short-period").unwrap();
    document.parameters.get_mut("alpha_0").unwrap().fixed = false;
    let text = r#"
        unit = "m/s^2"
        equation = "130*(Za*(alpha - alpha_eq) + (Zq - 1)*q + Zde*(de - de_eq)) + az_bias"
    "#;
    if accelerometer {
        let output = toml::from_str(&text.replace("130*", "V_e*")).unwrap();
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
    let mut scenario: Scenario = toml::from_str(include_str!("../data/elevator.toml")).unwrap();
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
    };
    let case = Case {
        document,
        flights: vec![flight],
        options: Options::default(),
        candidates: Vec::new(),
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

/// Degrees that a header calls radians: the fit is as good as ever, since the control derivatives take up the scale.
#[test]
fn a_slipped_unit_of_an_input_is_told() {
    let recorded = ingest::read(elevator().as_bytes(), Format::Csv, &Limits::default());
    let recorded = Arc::new(recorded.unwrap());
    let right = solve("short-period", &recorded, &json!({}));
    let mut channels = recorded.channels().clone();
    let radian = Unit::parse("rad").unwrap();
    let elevator = &mut channels["de"];
    *elevator = Channel {
        recorded_unit: "rad".to_string(),
        unit: radian,
        values: elevator.values.iter().map(|v| v.to_degrees()).collect(),
    };
    let slipped = Arc::new(Maneuver::new(recorded.time().to_vec(), channels).unwrap());
    let wrong = solve("short-period", &slipped, &json!({}));
    let ratio = wrong.estimate.det_r / right.estimate.det_r;
    assert!((ratio - 1.0).abs() < 1e-4, "{ratio}");

    let findings = |maneuver: &Arc<Maneuver>| {
        let spec = json!({"model": "short-period", "maneuvers": [{"id": maneuver.digest()}]});
        let spec = serde_json::from_value(spec).unwrap();
        let document = catalog::find("short-period").unwrap();
        let plan = trimtab::job::prepare(&spec, &document, std::slice::from_ref(maneuver));
        plan.unwrap().prepared.findings
    };
    let odd = |f: &&Finding| f.code == "implausible";
    assert!(!findings(&recorded).iter().any(|f| odd(&f)));
    let found = findings(&slipped);
    let found = found.iter().find(odd).expect("a finding");
    assert_eq!(found.channel.as_deref(), Some("de"));
    assert!(
        found.message.contains("degrees declared as radians"),
        "{}",
        found.message
    );
}
