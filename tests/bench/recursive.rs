//! The time that a sample takes in flight: 20 parameters in 5 equations of motion, 50 samples a second.
//!
//! `cargo bench --bench recursive`

use std::fmt::Write;
use std::time::Instant;

use serde_json::{Value, json};
use trimtab_core::model::{Model, ModelDocument};
use trimtab_core::recursive::{Sample, Setup, Tracker, TrackingOptions};

const STATES: usize = 5;
const SAMPLES: usize = 3000;

/// Each state decays by itself and is driven by the next one and by two inputs.
fn document() -> ModelDocument {
    let mut text =
        "name = \"bench\"\n[inputs]\nu1 = { unit = \"-\" }\nu2 = { unit = \"-\" }\n".to_string();
    let (mut states, mut outputs) = (String::new(), String::new());
    text += "[parameters]\n";
    for i in 0..STATES {
        for (name, start) in [("a", -1.0), ("b", 0.2), ("c", 0.5), ("d", -0.3)] {
            let _ = writeln!(text, "{name}{i} = {{ unit = \"1/s\", start = {start:?} }}");
        }
        let next = (i + 1) % STATES;
        let _ = writeln!(
            states,
            "[states.x{i}]\nunit = \"-\"\ninitial = \"0\"\nderivative = \"a{i}*x{i} + b{i}*x{next} + c{i}*u1 + d{i}*u2\""
        );
        let _ = writeln!(outputs, "[outputs.y{i}]\nunit = \"-\"\nequation = \"x{i}\"");
    }
    toml::from_str(&(text + &states + &outputs)).expect("a document")
}

/// Microseconds a sample: the mean, and the most.
fn timed(setup: &Setup, options: &TrackingOptions) -> (f64, f64) {
    let mut tracker = Tracker::new(setup, options).expect("a tracker");
    assert_eq!(tracker.parameters().len(), 4 * STATES);
    let (mut state, mut sum, mut most) = ([0.0; STATES], 0.0, 0.0_f64);
    for k in 0..SAMPLES {
        let t = k as f64 * 0.02;
        let inputs = [(2.1 * t).sin() + (5.3 * t).cos(), (3.3 * t).sin()];
        let noise = |i: usize| 0.01 * ((k * STATES + i) as f64 * 12.9898).sin();
        let outputs: [f64; STATES] = std::array::from_fn(|i| state[i] + noise(i));
        let sample = Sample {
            time: t,
            inputs: &inputs,
            outputs: &outputs,
        };
        let began = Instant::now();
        let found = tracker.push(&sample).expect("a sample");
        std::hint::black_box(found);
        let took = began.elapsed().as_secs_f64() * 1e6;
        (sum, most) = (sum + took, most.max(took));
        let before = state;
        for (i, x) in state.iter_mut().enumerate() {
            *x += 0.02
                * (-before[i] + 0.2 * before[(i + 1) % STATES] + 0.5 * inputs[0] - 0.3 * inputs[1]);
        }
    }
    (sum / SAMPLES as f64, most)
}

fn main() {
    let setup = Setup::of_model(Model::compile(&document()).expect("a model"));
    let noise: Value = (0..STATES)
        .map(|i| (format!("y{i}"), json!(0.01)))
        .collect::<serde_json::Map<_, _>>()
        .into();
    let band = json!({"band_hz": [0.1, 2.0]});
    for options in [
        json!({"method": "rls", "forgetting": 0.998}),
        json!({"method": "rls", "forgetting": 0.998, "half_width": 32}),
        json!({"method": "rft", "forgetting": 0.998, "frequency": band}),
        json!({"method": "ekf", "noise": noise}),
    ] {
        let asked: TrackingOptions = serde_json::from_value(options.clone()).expect("options");
        let (mean, most) = timed(&setup, &asked);
        println!(
            "{:4} {mean:8.1} µs a sample, {most:8.1} µs at most  {options}",
            asked.method.name()
        );
    }
}
