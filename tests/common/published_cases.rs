//! The published estimation cases of `published_cases.json`, turned into model documents and jobs.

use std::path::Path;

use serde_json::{Map, Value, json};

/// One case: what to send, and what the reference found.
pub struct Case {
    pub name: String,
    /// Data files with first and last row.
    pub segments: Vec<(String, [usize; 2])>,
    /// The model document, as JSON.
    pub model: Value,
    /// How inputs and outputs are made from channels.
    pub channels: Value,
    pub det_r: f64,
    /// Name, estimate, standard deviation at the final estimate.
    pub reference: Vec<(String, f64, f64)>,
    /// Diagonal of the reference's R.
    pub variance: Vec<(String, f64)>,
}

/// Reads a case from the directory of flight data.
pub fn read(directory: &Path, name: &str) -> Case {
    let case = &find(directory, name);
    let reference = &case["reference_results"]["gauss_newton"];
    let number = |value: &Value| value.as_f64().expect("a number");
    Case {
        name: name.to_string(),
        segments: list(&case["segments"])
            .map(|s| {
                (
                    text_of(&s["file"]),
                    [0, 1].map(|i| s["rows"][i].as_u64().expect("row") as usize),
                )
            })
            .collect(),
        model: model(case),
        channels: channels(case),
        det_r: number(&reference["det_R"]),
        reference: list(&reference["estimates"])
            .map(|e| {
                (
                    text_of(&e["name"]),
                    number(&e["value"]),
                    number(&e["std_dev_at_final_estimate"]),
                )
            })
            .collect(),
        variance: reference["R_diag"]
            .as_object()
            .expect("R_diag")
            .iter()
            .map(|(name, value)| (name.clone(), number(value)))
            .collect(),
    }
}

/// A case as the file has it.
pub fn find(directory: &Path, name: &str) -> Value {
    let text = std::fs::read_to_string(directory.join("published_cases.json"))
        .expect("published_cases.json");
    let all: Value = serde_json::from_str(&text).expect("valid JSON");
    let cases = all["cases"].as_array().expect("cases");
    let case = cases.iter().find(|case| case["case"] == name);
    case.unwrap_or_else(|| panic!("no case {name}")).clone()
}

fn list(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().expect("a list").iter()
}

fn text_of(value: &Value) -> String {
    value.as_str().expect("a text").to_string()
}

/// `m^2/kg (wing area / mass)` is `m^2/kg`.
fn unit(value: &Value) -> String {
    value
        .as_str()
        .unwrap_or("-")
        .split(" (")
        .next()
        .unwrap_or("-")
        .trim()
        .to_string()
}

pub fn model(case: &Value) -> Value {
    let units = |list_of: &str| -> Map<String, Value> {
        list(&case[list_of])
            .map(|q| (text_of(&q["name"]), json!({"unit": unit(&q["unit"])})))
            .collect()
    };
    let constants: Map<String, Value> = (case["constants"].as_object().expect("constants").iter())
        .map(|(name, value)| {
            (
                name.clone(),
                json!({"value": value, "unit": unit(&case["constant_units"][name])}),
            )
        })
        .collect();
    let mut parameters: Map<String, Value> = list(&case["parameters"])
        .map(|p| {
            let fixed = !p["free"].as_bool().expect("free");
            (
                text_of(&p["name"]),
                json!({"unit": unit(&p["unit"]), "start": p["start"], "fixed": fixed}),
            )
        })
        .collect();
    let mut states = units("states");
    let initial = &case["initial_states"][0];
    for (name, state) in &mut states {
        let parameter = format!("x0_{name}");
        let fixed = !initial["free"][name].as_bool().expect("free");
        let start = json!({"unit": state["unit"], "start": initial["start"][name], "fixed": fixed, "per": "maneuver"});
        state["initial"] = json!(parameter);
        state["derivative"] = case["equations"]["xdot"][name].clone();
        parameters.insert(parameter, start);
    }
    let mut outputs = units("outputs");
    for (name, output) in &mut outputs {
        output["equation"] = case["equations"]["y"][name].clone();
    }
    let definitions: Map<String, Value> = case["equations"]["auxiliary"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|line| {
            let (name, equation) = line
                .as_str()
                .expect("a text")
                .split_once('=')
                .expect("name = equation");
            (
                name.trim().to_string(),
                json!({"equation": equation.trim(), "unit": definition_unit(name.trim())}),
            )
        })
        .collect();
    json!({
        "name": case["case"].as_str().expect("a name").to_lowercase().replace('_', "-"),
        "constants": constants, "inputs": units("inputs"), "parameters": parameters,
        "definitions": definitions, "states": states, "outputs": outputs,
    })
}

/// The cases give no units for their auxiliary quantities.
fn definition_unit(name: &str) -> &'static str {
    match name {
        "qbar" => "Pa",
        _ => "-",
    }
}

/// Columns are converted to SI when they are uploaded: the factors `pi/180` of the cases fall away.
pub fn channels(case: &Value) -> Value {
    let quantities = list(&case["inputs"]).chain(list(&case["outputs"]));
    let formula = |q: &Value| text_of(&q["from_columns"]).replace("*pi/180", "");
    Value::Object(
        quantities
            .map(|q| (text_of(&q["name"]), json!(formula(q))))
            .collect(),
    )
}
