//! The published estimation cases of `published_cases.json`, turned into model documents and jobs.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::preprocessing::{Table, argument};

/// One case: what to send, and what the reference found.
pub(crate) struct Case {
    /// Recordings, with first and last row to use.
    pub segments: Vec<(String, [usize; 2])>,
    /// The model document, as JSON.
    pub model: Value,
    /// How inputs and outputs are made from channels.
    pub channels: Value,
    pub det_r: f64,
    /// Name, segment (from 1) where each has its own, estimate, standard deviation at the final estimate.
    pub reference: Vec<(String, Option<String>, f64, f64)>,
}

/// Reads a case from the directory of flight data.
pub(crate) fn read(directory: &Path, name: &str) -> Case {
    let case = &find(directory, name);
    let reference = &case["reference_results"]["gauss_newton"];
    let number = |value: &Value| value.as_f64().expect("a number");
    let files = list(&case["segments"]).map(|s| {
        let rows = [0, 1].map(|i| s["rows"][i].as_u64().expect("row") as usize);
        let file = directory.join(text_of(&s["file"]));
        (std::fs::read_to_string(file).expect("a data file"), rows)
    });
    // where columns are smoothed, or segments start from states of their own, the recordings are made here
    let made = case["preprocessing_steps"].is_array() || case["segments"][1].is_object();
    let segments: Vec<(String, [usize; 2])> = if made {
        let segment = |(i, (csv, rows)): (usize, (String, [usize; 2]))| {
            let recording = recording(case, i, &csv, rows);
            let count = recording.lines().count() - 1;
            (recording, [1, count])
        };
        files.enumerate().map(segment).collect()
    } else {
        files.collect()
    };
    Case {
        segments,
        model: model(case),
        channels: if made { json!({}) } else { channels(case) },
        det_r: number(&reference["det_R"]),
        reference: list(&reference["estimates"])
            .map(|e| {
                let name = text_of(&e["name"]);
                let (name, segment) = match name.split_once("_seg") {
                    Some((name, segment)) => (name.to_string(), Some(segment.to_string())),
                    None => (name, None),
                };
                (
                    name,
                    segment,
                    number(&e["value"]),
                    number(&e["std_dev_at_final_estimate"]),
                )
            })
            .collect(),
    }
}

/// A case as the file has it.
pub(crate) fn find(directory: &Path, name: &str) -> Value {
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

/// Inputs, outputs and initial states of one segment, in the units of the model.
fn recording(case: &Value, segment: usize, csv: &str, rows: [usize; 2]) -> String {
    let step = case["dt_s"].as_f64().expect("a step");
    let mut table = Table::read(csv, rows, step);
    let count = table.len();
    for (name, value) in case["constants"].as_object().expect("constants") {
        table.set(name, vec![value.as_f64().expect("a number"); count]);
    }
    for line in case["preprocessing_steps"].as_array().into_iter().flatten() {
        let line = text_of(line);
        let (name, formula) = line.split_once('=').expect("name = formula");
        let values = table.evaluate(formula.trim());
        table.set(name.trim(), values);
    }
    let quantities: Vec<&Value> = list(&case["inputs"])
        .chain(list(&case["outputs"]))
        .collect();
    let made: Vec<Vec<f64>> = quantities
        .iter()
        .map(|q| table.evaluate(&text_of(&q["from_columns"])))
        .collect();
    let mut columns = Vec::new();
    for (quantity, values) in quantities.iter().zip(made) {
        let name = text_of(&quantity["name"]);
        table.set(&name, values);
        columns.push((name, unit(&quantity["unit"])));
    }
    for state in list(&case["states"]) {
        let name = text_of(&state["name"]);
        let start = &case["initial_states"][segment]["start"][&name];
        let column = format!("x0_{name}");
        table.set(&column, vec![start.as_f64().expect("a number"); count]);
        columns.push((column, unit(&state["unit"])));
    }
    table.to_csv(&columns)
}

/// `a*delay(x, tau) + b` is `a*(x) + b`, later by `tau`.
fn without_delay(equation: &str) -> (String, Option<String>) {
    let Some(begin) = equation.find("delay(") else {
        return (equation.to_string(), None);
    };
    let (inner, end) = argument(equation, begin + "delay".len());
    let (signal, delay) = inner.rsplit_once(',').expect("delay(x, tau)");
    let prompt = format!("{}({signal}){}", &equation[..begin], &equation[end..]);
    (prompt, Some(delay.trim().to_string()))
}

pub(crate) fn model(case: &Value) -> Value {
    let units = |list_of: &str| -> Map<String, Value> {
        list(&case[list_of])
            .map(|q| (text_of(&q["name"]), json!({"unit": unit(&q["unit"])})))
            .collect()
    };
    let equations = case["equations"].to_string();
    let constants: Map<String, Value> = (case["constants"].as_object().expect("constants").iter())
        .filter(|(name, _)| equations.contains(name.as_str()))
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
        let own = case["initial_states"][1].is_object();
        let own = own.then(|| json!(format!("first({parameter})")));
        let start = own.unwrap_or_else(|| initial["start"][name].clone());
        let start =
            json!({"unit": state["unit"], "start": start, "fixed": fixed, "per": "maneuver"});
        state["initial"] = json!(parameter);
        state["derivative"] = case["equations"]["xdot"][name].clone();
        parameters.insert(parameter, start);
    }
    let mut outputs = units("outputs");
    for (name, output) in &mut outputs {
        let (equation, delay) = without_delay(&text_of(&case["equations"]["y"][name]));
        output["equation"] = json!(equation);
        if let Some(delay) = delay {
            output["delay"] = json!(delay);
        }
    }
    for own in case["segment_parameters"].as_array().into_iter().flatten() {
        let parameter =
            json!({"unit": unit(&own["unit"]), "start": own["start"], "per": "maneuver"});
        parameters.insert(text_of(&own["name"]), parameter);
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
        "p" | "q" | "r" => "rad/s",
        "ax" | "ay" | "az" => "m/s^2",
        "u_nb" | "v_nb" | "w_nb" => "m/s",
        "tau2_eff" => "s",
        _ => "-",
    }
}

/// Columns are converted to SI when they are uploaded: the factors `pi/180` of the cases fall away.
pub(crate) fn channels(case: &Value) -> Value {
    let quantities = list(&case["inputs"]).chain(list(&case["outputs"]));
    let formula = |q: &Value| text_of(&q["from_columns"]).replace("*pi/180", "");
    Value::Object(
        quantities
            .map(|q| (text_of(&q["name"]), json!(formula(q))))
            .collect(),
    )
}
