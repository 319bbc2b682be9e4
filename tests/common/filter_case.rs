//! The published filter-error case, turned into a job.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::published_cases::{channels, find, model};

pub(crate) struct FilterCase {
    pub file: String,
    pub rows: Value,
    /// The model document without the process noise, which is no parameter of ours.
    pub model: Value,
    pub channels: Value,
    /// By state: start value of the intensity.
    pub process_noise: Value,
    pub det_r: f64,
    /// By name (`f_<state>` for intensities): estimate and standard deviation.
    pub reference: Vec<(String, f64, f64)>,
    /// K, states by outputs.
    pub gain: Vec<Vec<f64>>,
    /// The diagonal of R in the reference's gain.
    pub gain_variance: Vec<f64>,
}

pub(crate) fn read(directory: &Path, name: &str) -> FilterCase {
    let case = find(directory, name);
    let mut model = model(&case);
    let parameters = model["parameters"].as_object_mut().expect("parameters");
    let mut process_noise = Map::new();
    parameters.retain(|name, parameter| {
        let Some(state) = name.strip_prefix("f_") else {
            return true;
        };
        process_noise.insert(state.to_string(), json!({"start": parameter["start"]}));
        false
    });
    let reference = &case["reference_results"]["filter_error"];
    let number = |value: &Value| value.as_f64().expect("a number");
    let numbers = |value: &Value| -> Vec<f64> {
        value
            .as_array()
            .expect("numbers")
            .iter()
            .map(number)
            .collect()
    };
    let estimates = reference["estimates"].as_array().expect("estimates").iter();
    let estimate = |e: &Value| {
        let name = e["name"].as_str().expect("a name").to_string();
        (name, number(&e["value"]), number(&e["std_dev"]))
    };
    FilterCase {
        file: case["segments"][0]["file"]
            .as_str()
            .expect("a file")
            .to_string(),
        rows: case["segments"][0]["rows"].clone(),
        model,
        channels: channels(&case),
        process_noise: process_noise.into(),
        det_r: number(&reference["det_R"]),
        reference: estimates.map(estimate).collect(),
        gain: (reference["kalman_gain_states_by_outputs"]
            .as_array()
            .expect("a matrix")
            .iter())
        .map(numbers)
        .collect(),
        gain_variance: numbers(&reference["R_used_for_gain"]),
    }
}
