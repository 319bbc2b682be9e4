//! Large jobs end within a second of being cancelled, wherever they are. What a solver does in small jobs that are stopped
//! between iterations is shown beside each of them.

use std::sync::Arc;

use serde_json::{Value, json};
use trimtab_core::flight::Maneuver;

use crate::common::large_jobs::{LargeJob, ends_within_a_second, long_elevator};
use crate::common::plans::recording;

fn ends(name: &str, (model, flown): (Value, Arc<Maneuver>), changes: &Value, after: &[f64]) {
    ends_within_a_second(name, &LargeJob::new(&model, flown, changes), after);
}

#[test]
fn a_diagnosis() {
    let flown = long_elevator(249_000);
    for after in [1.0, 5.0, 12.0] {
        let kind = json!({"kind": "diagnose"});
        ends(
            "diagnosis, 249 000 rows",
            (json!("short-period"), flown.clone()),
            &kind,
            &[after],
        );
    }
}

#[test]
fn a_structure_determination() {
    let samples = 20_000;
    let time: Vec<f64> = (0..samples).map(|k| 0.02 * k as f64).collect();
    let wave = |speed: f64| -> Vec<f64> { time.iter().map(|t| (speed * t).sin()).collect() };
    let names = ["v0", "v1", "v2", "v3", "v4", "v5", "v6", "v7"];
    let mut channels: Vec<(&str, Vec<f64>)> = (names.iter().enumerate())
        .map(|(i, name)| (*name, wave(0.31 + 0.17 * i as f64)))
        .collect();
    let response = (0..samples).map(|k| {
        let product: f64 = channels.iter().map(|(_, values)| 1.0 + values[k]).product();
        product.ln_1p()
    });
    let response = response.collect();
    channels.push(("Cm", response));
    let inputs: Value = names
        .iter()
        .map(|name| (name.to_string(), json!({})))
        .collect();
    let model = json!({"name": "moment", "inputs": inputs, "outputs": {"Cm": {"equation": "0"}}});
    let flown = recording(time.clone(), &channels);
    for method in ["stepwise", "orthogonal"] {
        let structure = json!({"output": "Cm", "method": method, "variables": names, "order": 4});
        let kind = json!({"kind": "structure", "structure": structure});
        let name = format!("structure, {method}, 20 000 x 494");
        ends(&name, (model.clone(), flown.clone()), &kind, &[1.0, 6.0]);
    }
}
