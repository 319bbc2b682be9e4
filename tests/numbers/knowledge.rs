//! What a diagnosis is told before the data: what is taken, what is refused, and with which remedy.

use std::ops::ControlFlow;
use std::sync::Arc;

use serde_json::{Value, json};
use trimtab_core::flight::{Channel, Maneuver, Unit};
use trimtab_core::job::{self, JobSpec};
use trimtab_core::model::{ModelDocument, catalog};

use crate::common::recordings::{elevator, maneuver};

fn faults(knowledge: &Value) -> Vec<(String, String, String)> {
    let recorded = maneuver(elevator().as_bytes());
    let spec = json!({
        "kind": "diagnose",
        "model": "short-period",
        "maneuvers": [{"id": recorded.digest()}],
        "knowledge": knowledge,
    });
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    let document = catalog::find("short-period").unwrap();
    match job::prepare(&spec, &document, &[recorded]) {
        Ok(_) => Vec::new(),
        Err(faults) => {
            let of = |fault: trimtab_core::flight::Fault| {
                (fault.pointer, fault.code.into(), fault.message)
            };
            faults.into_iter().map(of).collect()
        }
    }
}

#[test]
fn what_is_known_of_no_candidate_is_refused_with_what_there_is() {
    let known = json!({
        "quantities": {"V": "airspeed"},
        "exclude": ["sensor_delay", "alpha", "sensor_scale of q", "missing_term alpha^2 in q"],
        "known": [{"kind": "sensor_position", "target": "alpha", "term": "x", "size_sd": 0.1, "unit": "m"}],
        "clocks": [["alpha", "q"], ["alpha", "de"]],
    });
    assert_eq!(faults(&known), []);
    for (knowledge, pointer, code, remedy) in [
        (
            json!({"exclude": ["sensor_delay", "gremlins"]}),
            "/knowledge/exclude/1",
            "unknown_effect",
            "sensor_scale",
        ),
        (
            json!({"known": [{"kind": "sensor_bias", "target": "theta", "size_sd": 0.1}]}),
            "/knowledge/known/0",
            "unknown_effect",
            "sensor_bias of q",
        ),
        (
            json!({"known": [{"kind": "sensor_bias", "target": "q"}]}),
            "/knowledge/known/0",
            "bad_option",
            "\"size_sd\"",
        ),
        (
            json!({"known": [{"kind": "sensor_bias", "target": "q", "size_sd": -1.0}]}),
            "/knowledge/known/0/size_sd",
            "bad_option",
            "0 or more",
        ),
        (
            json!({"known": [{"kind": "sensor_bias", "target": "q", "lower": 0.1}]}),
            "/knowledge/known/0/lower",
            "bad_option",
            "0 or less",
        ),
        (
            json!({"known": [{"kind": "sensor_bias", "target": "q", "size_sd": 0.1, "unit": "m"}]}),
            "/knowledge/known/0/unit",
            "unit_mismatch",
            "1/s",
        ),
        (
            json!({"clocks": [["alpha", "theta"]]}),
            "/knowledge/clocks/0/1",
            "unknown_channel",
            "alpha, de, q",
        ),
        (
            json!({"clocks": [["alpha"]]}),
            "/knowledge/clocks/0",
            "bad_option",
            "two or more",
        ),
        (
            json!({"quantities": {"boom": "angle_of_attack"}}),
            "/knowledge/quantities/boom",
            "unknown_channel",
            "recorded are",
        ),
        (
            json!({"quantities": {"V": "angle_of_attack"}}),
            "/knowledge/quantities/V",
            "unit_mismatch",
            "angle_of_attack",
        ),
    ] {
        let found = faults(&knowledge);
        let [(at, what, message)] = found.as_slice() else {
            panic!("{knowledge}: {found:#?}");
        };
        assert_eq!((at.as_str(), what.as_str()), (pointer, code), "{message}");
        assert!(message.contains(remedy), "{message}");
    }
}

#[test]
fn a_declared_quantity_is_held_against_its_unit() {
    let mut document = catalog::find("short-period").unwrap();
    let elevator = document.inputs.get_mut("de").unwrap();
    elevator.unit = "m".to_string();
    document.states["q"].quantity = Some(trimtab_core::flight::PhysicalQuantity::Airspeed);
    let faults = trimtab_core::model::Model::compile(&document).unwrap_err();
    let pointers: Vec<&str> = (faults.iter())
        .filter(|fault| fault.code == "quantity_mismatch")
        .map(|fault| fault.pointer.as_str())
        .collect();
    assert_eq!(pointers, ["/inputs/de/quantity", "/states/q/quantity"]);
}

/// A velocity that a formula makes of airspeed and sideslip, with a start that is read off the sideslip.
#[test]
fn a_diagnosis_takes_whatever_a_fit_takes() {
    let text = r#"
        name = "side-velocity"
        inputs.dr.unit = "rad"
        parameters.Yv = { unit = "1/s", start = -0.3 }
        parameters.Ydr = { unit = "m/s^2", start = 3.0 }
        parameters.v_0 = { unit = "m/s", start = "first(V)*sin(first(beta))", fixed = true, per = "maneuver" }
        states.v = { unit = "m/s", initial = "v_0", derivative = "Yv*v + Ydr*dr" }
        outputs.v = { unit = "m/s", equation = "v" }
    "#;
    let document: ModelDocument = toml::from_str(text).unwrap();
    let count = 400;
    let time: Vec<f64> = (0..count).map(|k| 0.05 * f64::from(k)).collect();
    let (mut v, mut state, mut seed) = (Vec::new(), 1.5, 1u32);
    let dr: Vec<f64> = time.iter().map(|t| 0.1 * (0.7 * t).sin()).collect();
    for &dr in &dr {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        v.push(state + 0.02 * (f64::from(seed >> 8) / f64::from(1u32 << 24) - 0.5));
        state += 0.05 * (-0.4 * state + 4.0 * dr);
    }
    let channel = |unit: &str, values: Vec<f64>| Channel {
        recorded_unit: unit.to_string(),
        unit: Unit::parse(unit).unwrap(),
        values,
    };
    let channels = [
        ("dr", channel("rad", dr)),
        ("V", channel("m/s", vec![60.0; count as usize])),
        (
            "beta",
            channel("rad", v.iter().map(|v| (v / 60.0).asin()).collect()),
        ),
    ];
    let channels = channels.map(|(name, channel)| (name.to_string(), channel));
    let recorded = Arc::new(Maneuver::new(time, channels.into_iter().collect()).unwrap());
    let spec = json!({
        "kind": "diagnose",
        "model": serde_json::to_value(&document).unwrap(),
        "maneuvers": [{"id": recorded.digest()}],
        "channels": {"v": "V*sin(beta)"},
    });
    let spec: JobSpec = serde_json::from_value(spec).unwrap();
    let plan = job::prepare(&spec, &document, &[recorded]).unwrap_or_else(|f| panic!("{f:#?}"));
    let result = job::run_diagnosis(&plan, &mut |_| ControlFlow::Continue(()));
    let diagnosis = result
        .unwrap_or_else(|f| panic!("{f:#?}"))
        .diagnosis
        .unwrap();
    // what the formula used is no input that the model lacks
    let all = diagnosis.effects.iter().map(|effect| &effect.effect);
    let all = all.chain(diagnosis.refused.iter().map(|refused| &refused.effect));
    for effect in all {
        assert!(!effect.name().contains("beta"), "{}", effect.name());
    }
}
