//! Model documents that are wrong: each fault with its place, a stable word, and the remedy.

use serde_json::{Value, json};
use trimtab_core::flight::Faults;
use trimtab_core::model::{Edit, Model, ModelDocument};

fn document() -> Value {
    json!({
        "name": "short",
        "constants": {"V0": {"value": 100.0, "unit": "m/s"}},
        "inputs": {"de": {"unit": "rad"}},
        "parameters": {
            "Ma": {"unit": "1/s^2", "start": -1.0},
            "Mq": {"unit": "1/s", "start": -1.0, "lower": -5.0, "upper": 0.0},
            "Mde": {"unit": "1/s^2", "start": -1.0},
        },
        "definitions": {"moment": {"unit": "rad/s^2", "equation": "Ma*alpha + Mde*de"}},
        "states": {
            "alpha": {"unit": "rad", "initial": "0", "derivative": "q"},
            "q": {"unit": "rad/s", "initial": "0", "derivative": "moment + Mq*q"},
        },
        "outputs": {"q": {"unit": "rad/s", "equation": "q"}},
    })
}

fn changed(pointer: &str, value: Value) -> Value {
    let mut document = document();
    *document
        .pointer_mut(pointer)
        .unwrap_or_else(|| panic!("no {pointer}")) = value;
    document
}

fn compile(document: Value) -> Result<Model, Faults> {
    Model::compile(
        &serde_json::from_value::<ModelDocument>(document).expect("the shape of a document"),
    )
}

/// Pointer, code and message of the only fault.
fn fault(document: Value) -> (String, String, String) {
    let faults = compile(document).expect_err("a fault");
    assert_eq!(faults.len(), 1, "{faults:#?}");
    let fault = faults[0].clone();
    (fault.pointer, fault.code.into_owned(), fault.message)
}

#[test]
fn the_document_itself_is_right() {
    let model = compile(document()).expect("a model");
    assert_eq!(model.dynamics_jacobian.by_state, [(1, 0), (0, 1), (1, 1)]);
}

#[test]
fn every_kind_of_fault_names_its_place_and_the_remedy() {
    let cases = [
        (
            changed("/inputs/de/unit", json!("furlong")),
            "/inputs/de/unit",
            "unknown_unit",
            "unknown unit 'furlong'",
        ),
        (
            changed("/states/q/derivative", json!("moment + Mq*alpha")),
            "/states/q/derivative",
            "unit_mismatch",
            "column 1: cannot add 1/s^2 and 1/s: 'moment' and 'Mq*alpha'",
        ),
        (
            changed("/outputs/q/equation", json!("alpha")),
            "/outputs/q/equation",
            "unit_mismatch",
            "'alpha' is in - where 1/s is needed (unit 'rad/s')",
        ),
        (
            changed("/states/q/derivative", json!("moment + Mq*qq")),
            "/states/q/derivative",
            "unknown_symbol",
            "column 13: 'qq' is not defined; did you mean",
        ),
        (
            changed("/definitions/moment/equation", json!("Ma*alpha + 2*moment")),
            "/definitions/moment/equation",
            "cyclic_definition",
            "moment -> moment",
        ),
        (
            changed("/states/q/derivative", json!("moment + (Mq*q")),
            "/states/q/derivative",
            "syntax_error",
            "column 15: the expression ends where ')' should be",
        ),
        (
            changed("/states/q/derivative", json!("(".repeat(100_000))),
            "/states/q/derivative",
            "syntax_error",
            "the expression has 100000 bytes, at most 8192 are allowed",
        ),
        (
            changed("/states/alpha/initial", json!("de")),
            "/states/alpha/initial",
            "initial_depends_on_data",
            "'de' is not a parameter or constant; make a parameter with start = \"first(<channel>)\"",
        ),
        (
            changed("/outputs", json!({})),
            "/outputs",
            "no_outputs",
            "at least one output",
        ),
        (
            changed("/parameters/Mq/lower", json!(1.0)),
            "/parameters/Mq",
            "bad_bounds",
            "lower bound 1 is not below upper bound 0",
        ),
        (
            changed(
                "/parameters/Mq",
                json!({"unit": "1/s", "start": -1.0, "only_in": ["flight 2"]}),
            ),
            "/parameters/Mq",
            "bad_only_in",
            "give it per = \"maneuver\"",
        ),
        (
            changed("/parameters/Mq/start", json!(2.0)),
            "/parameters/Mq/start",
            "bad_bounds",
            "start 2 is outside the bounds",
        ),
        (
            changed("/outputs/q/equation", json!("q + mean(q, 5)")),
            "/outputs/q/equation",
            "syntax_error",
            "may stand only in a parameter's start",
        ),
        (
            changed("/inputs", json!({"de": {"unit": "rad"}, "sin": {}})),
            "/inputs/sin",
            "invalid_name",
            "has a meaning of its own",
        ),
        (
            changed("/inputs", json!({"de": {"unit": "rad"}, "a b": {}})),
            "/inputs/a b",
            "invalid_name",
            "a name is a letter",
        ),
        (
            changed("/inputs", json!({"de": {"unit": "rad"}, "V0": {}})),
            "/inputs/V0",
            "duplicate_name",
            "'V0' is defined twice",
        ),
        (
            changed("/inputs", json!({"de": {"unit": "rad"}, "q": {}})),
            "/states/q",
            "duplicate_name",
            "'q' is defined twice",
        ),
    ];
    for (document, pointer, code, words) in cases {
        let faults = compile(document).expect_err(code);
        let found = faults
            .iter()
            .find(|f| f.pointer == pointer && f.code == code);
        let found = found.unwrap_or_else(|| panic!("no {code} at {pointer} in {faults:#?}"));
        assert!(found.message.contains(words), "{}", found.message);
    }
}

#[test]
fn a_longer_circle_is_written_out() {
    let circle = json!({
        "a": {"equation": "b + 1"}, "b": {"equation": "2*c"}, "c": {"equation": "a"},
        "moment": {"unit": "rad/s^2", "equation": "Ma*alpha + Mde*de"},
    });
    let (pointer, code, message) = fault(changed("/definitions", circle));
    assert_eq!(
        (pointer.as_str(), code.as_str()),
        ("/definitions/a/equation", "cyclic_definition")
    );
    assert!(message.contains("a -> b -> c -> a"), "{message}");
}

#[test]
fn all_faults_are_told_at_once() {
    let mut document = changed("/states/q/derivative", json!("moment + Mqq*q"));
    document["outputs"]["q"]["equation"] = json!("q +");
    document["inputs"]["de"]["unit"] = json!("furlong");
    let codes: Vec<_> = compile(document)
        .expect_err("faults")
        .iter()
        .map(|f| f.code.clone())
        .collect();
    assert_eq!(codes, ["unknown_unit", "unknown_symbol", "syntax_error"]);
}

/// A guess at what was meant is made for the first of very many, and no name is told twice.
#[test]
fn names_that_are_not_there_are_told_once_each_and_not_all() {
    let names: Vec<String> = (0..900)
        .map(|i| format!("{}{i:03}", "n".repeat(61)))
        .collect();
    let mut document = changed("/states/q/derivative", json!("Mq*(qq + qq)"));
    for name in &names[..400] {
        document["parameters"][name] = json!({"start": 1.0});
    }
    let equation = names[400..]
        .iter()
        .map(|name| &name[1..])
        .collect::<Vec<_>>();
    for i in 0..200 {
        let long = equation[i..i + 100].join("+");
        document["definitions"][format!("d{i}")] = json!({"equation": long});
    }
    document["states"]["q"]["initial"] = json!(vec!["q"; 200].join("+"));
    let faults = compile(document).expect_err("faults");
    let of = |pointer: &str| faults.iter().filter(|f| f.pointer == pointer).count();
    assert_eq!(of("/states/q/derivative"), 1);
    assert_eq!(of("/definitions/d7/equation"), 20);
    assert_eq!(of("/states/q/initial"), 1);
    let guesses = faults.iter().filter(|f| f.message.contains("did you mean"));
    assert_eq!(guesses.count(), 20);
}

/// Each of many coefficients by each of many parameters, with a pass over thousands of operations for each.
#[test]
fn very_large_linear_models_are_integrated_without_their_matrices() {
    let large = |parameters: usize| {
        let mut document =
            json!({"name": "large", "constants": {"k": {"value": 1.0, "unit": "1/s"}}});
        for i in 0..parameters {
            document["parameters"][format!("p{i}")] = json!({"start": 1.0});
        }
        let sum = |d: usize| (0..200).map(move |i| format!("sin({d}{i}.5*p0)"));
        for d in 1..11 {
            let equation = sum(d).collect::<Vec<_>>().join("+");
            document["definitions"][format!("d{d}")] = json!({"equation": equation});
        }
        let all = (1..11)
            .map(|d| format!("d{d}"))
            .collect::<Vec<_>>()
            .join("+");
        document["definitions"]["s"] = json!({"equation": all});
        for i in 0..64 {
            document["inputs"][format!("u{i}")] = json!({});
            let derivative = format!("k*(s*x{i} + p1*u{i})");
            document["states"][format!("x{i}")] = json!({"initial": "0", "derivative": derivative});
        }
        document["outputs"]["y"] = json!({"equation": "x0"});
        compile(document).expect("a model")
    };
    assert!(large(2).is_affine());
    assert!(!large(500).is_affine());
}

#[test]
fn a_model_of_500_states_is_refused_with_the_bound() {
    let states: serde_json::Map<String, Value> = (0..500)
        .map(|i| (format!("x{i}"), json!({"initial": "0", "derivative": "0"})))
        .collect();
    let (pointer, code, message) = fault(changed("/states", Value::Object(states)));
    assert_eq!(
        (pointer.as_str(), code.as_str()),
        ("/states", "model_too_large")
    );
    assert_eq!(message, "500 states; at most 64 are allowed");
}

#[test]
fn a_model_whose_derivatives_explode_is_refused() {
    // each definition squares the number of ways to get to the first; shared nodes keep it small,
    // so that only the sheer number of operations can pass the bound
    let mut document = document();
    let long = (0..180)
        .map(|i| format!("sin(alpha*{i}.5)*cos(de*{i}.25)"))
        .collect::<Vec<_>>()
        .join(" + ");
    let definitions: serde_json::Map<String, Value> = (0..250)
        .map(|i| {
            (
                format!("d{i}"),
                json!({"equation": long.replace(".5)", &format!(".{}1)", i + 1))}),
            )
        })
        .collect();
    let sum = (0..250)
        .map(|i| format!("d{i}"))
        .collect::<Vec<_>>()
        .join(" + ");
    document["definitions"] = Value::Object(definitions);
    document["states"]["q"]["derivative"] = json!(format!("Ma*({sum})"));
    let faults = compile(document).expect_err("a fault");
    assert_eq!(
        (&*faults[0].code, faults[0].pointer.as_str()),
        ("model_too_large", "")
    );
}

#[test]
fn edits_add_one_parameter_whose_unit_follows() {
    let declared: ModelDocument = serde_json::from_value(document()).expect("a document");
    let edit = |text: Value| serde_json::from_value::<Edit>(text).expect("an edit");
    let edited = edit(json!({"kind": "missing_term", "target": "q", "term": "alpha^2*V0"}))
        .apply(&declared)
        .expect("edited")
        .document;
    assert_eq!(
        edited.states["q"].derivative,
        "moment + Mq*q + q_term*(alpha^2*V0)"
    );
    assert_eq!(edited.parameters["q_term"].unit, "1/(m*s)");
    Model::compile(&edited).expect("a model");
    let scaled = edit(json!({"kind": "input_scale", "target": "de"}))
        .apply(&declared)
        .expect("edited")
        .document;
    assert_eq!(
        scaled.definitions["moment"].equation,
        "Ma*alpha + Mde*((1 + de_scale)*de)"
    );
    let drifting = edit(json!({"kind": "sensor_drift", "target": "q"}))
        .apply(&declared)
        .expect("edited")
        .document;
    Model::compile(&drifting).expect("a model");

    let refused = |text: Value| edit(text).apply(&declared).expect_err("a refusal");
    assert_eq!(
        refused(json!({"kind": "sensor_bias", "target": "beta"})).code(),
        "unknown_target"
    );
    assert_eq!(
        refused(json!({"kind": "missing_term", "target": "q"})).code(),
        "missing_term_absent"
    );
    assert_eq!(
        refused(json!({"kind": "missing_term", "target": "q", "term": "alpha^"})).code(),
        "syntax_error"
    );
    assert_eq!(
        refused(json!({"kind": "sensor_bias", "target": "q", "parameter": "Mq"})).code(),
        "duplicate_name"
    );
    assert_eq!(
        refused(json!({"kind": "sensor_bias", "target": "q", "parameter": "b".repeat(65)}))
            .to_string(),
        "\"parameter\" has 65 bytes, at most 64 are allowed"
    );
}

/// Deep trees must not overflow the stack of a thread: that would end the whole process.
#[test]
fn the_longest_chain_of_operators_fits_on_a_small_stack() {
    let chain = |operator: &str| format!("q{}", format!("{operator}q").repeat(990));
    let check = move || {
        for operator in ["+", "-"] {
            let text = format!("moment + Mq*({})", chain(operator));
            compile(changed("/states/q/derivative", json!(text))).expect("a model");
        }
        let deep = format!("{}q{}", "sin(".repeat(60), ")".repeat(60));
        compile(changed(
            "/states/q/derivative",
            json!(format!("moment*{}", deep.replace("q", "alpha"))),
        ))
        .expect("a model");
    };
    let thread = std::thread::Builder::new()
        .stack_size(1 << 20)
        .spawn(check)
        .expect("a thread");
    thread.join().expect("no fault");
}

#[test]
fn an_edit_keeps_its_promise_on_units_with_an_offset_or_a_root() {
    let mut document = document();
    document["inputs"]["V"] = json!({"unit": "m/s"});
    document["outputs"]["T"] = json!({"unit": "degC", "equation": "T0"});
    document["parameters"]["T0"] = json!({"unit": "degC", "start": 15.0});
    let declared: ModelDocument = serde_json::from_value(document).expect("a document");
    let edit = |text: Value| {
        serde_json::from_value::<Edit>(text)
            .expect("an edit")
            .apply(&declared)
            .expect("edited")
            .document
    };
    let biased = edit(json!({"kind": "sensor_bias", "target": "T"}));
    let model = Model::compile(&biased).expect("a model");
    let bias = model
        .parameters
        .iter()
        .find(|p| p.name == "T_bias")
        .expect("the parameter");
    assert_eq!(bias.unit.to_si(0.0), 0.0);
    let rooted = edit(json!({"kind": "missing_term", "target": "q", "term": "sqrt(V)"}));
    Model::compile(&rooted).expect("a model");
}

#[test]
fn a_name_that_stands_twice_is_refused() {
    let text = document().to_string().replacen("\"Ma\":", "\"Mq\":", 1);
    let refused = serde_json::from_str::<ModelDocument>(&text).expect_err("a refusal");
    assert!(
        refused.to_string().contains("'Mq' is defined twice"),
        "{refused}"
    );
}
