//! Models and recordings of any size: a chain of states that move each other.

use std::fmt::Write as _;
use std::sync::Arc;

use indexmap::IndexMap;
use serde_json::{Value, json};
use trimtab_core::flight::{Channel, Maneuver, Unit};

/// A document of `states` states that are moved by `inputs` inputs and by `coupled` states behind them, each by a parameter,
/// and of as many outputs, the states with a bias.
pub(crate) fn chain(states: usize, coupled: usize) -> Value {
    let (mut parameters, mut all, mut outputs) = (json!({}), json!({}), json!({}));
    for i in 0..states {
        let mut derivative = String::new();
        for j in 0..=coupled {
            let name = format!("a{i}_{j}");
            let start = if j == 0 { -1.0 - 0.01 * i as f64 } else { 0.02 };
            parameters[&name] = json!({"start": start, "unit": "1/s"});
            write!(derivative, "{name}*x{} + ", (i + j) % states).expect("memory");
        }
        write!(derivative, "b{i}*u").expect("memory");
        parameters[format!("b{i}")] = json!({"start": 1.0, "unit": "1/s"});
        parameters[format!("c{i}")] = json!({"start": 0.0});
        all[format!("x{i}")] = json!({"initial": "0", "derivative": derivative});
        outputs[format!("y{i}")] = json!({"equation": format!("x{i} + c{i}")});
    }
    json!({
        "name": "chain", "inputs": {"u": {}}, "parameters": parameters, "states": all, "outputs": outputs,
    })
}

/// What a chain could have shown, 50 samples a second.
pub(crate) fn recorded(states: usize, samples: usize) -> Arc<Maneuver> {
    let time: Vec<f64> = (0..samples).map(|k| 0.02 * k as f64).collect();
    let wave = |speed: f64| -> Vec<f64> { time.iter().map(|t| (speed * t).sin()).collect() };
    let outputs = (0..states).map(|i| (format!("y{i}"), wave(0.3 + 0.02 * i as f64)));
    let channel = |(name, values)| (name, Channel::from_recorded("-", Unit::NONE, values));
    let channels: IndexMap<String, Channel> = (outputs.chain([("u".to_string(), wave(0.7))]))
        .map(channel)
        .collect();
    Arc::new(Maneuver::new(time, channels).expect("a maneuver"))
}
