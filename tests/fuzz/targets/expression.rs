//! The text of an equation: as a tree, as part of a model, as a formula over recorded channels.
#![no_main]

use indexmap::IndexMap;
use libfuzzer_sys::fuzz_target;
use trimtab_core::flight::Dimension;
use trimtab_core::model::expression::{self, LONGEST};
use trimtab_core::model::{ChannelFormula, Model, ModelDocument, Output, Recorded};

#[path = "common/evaluate.rs"]
mod evaluate;

fuzz_target!(|text: &str| {
    let Ok(tree) = expression::parse(text) else {
        return;
    };
    let printed = tree.to_string();
    if printed.len() <= LONGEST {
        assert_eq!(expression::parse(&printed).as_ref(), Ok(&tree), "{printed}");
    }
    if let Ok(model) = Model::compile(&document(text)) {
        evaluate::once(&model);
    }
    if let Ok(formula) = ChannelFormula::parse(text) {
        let samples = formula.samples(&Two);
        assert!(samples.is_err() || samples.is_ok_and(|values| values.len() == TIME.len()));
        let _ = formula.number(&Two);
    }
});

/// A small model with the equation in it; all is without units, so that more of them agree.
fn document(equation: &str) -> ModelDocument {
    let mut document: ModelDocument = serde_json::from_str(
        r#"{"name": "one-equation",
            "constants": {"c": {"value": 3}},
            "inputs": {"u": {}},
            "parameters": {"a": {"start": 0.5}, "b": {"start": -2}},
            "definitions": {"d": {"equation": "a*x + c"}},
            "states": {"x": {"initial": "b", "derivative": "u - x"}}}"#,
    )
    .expect("a document");
    let equation = equation.to_string();
    document.outputs = IndexMap::from([(
        "y".to_string(),
        Output {
            equation,
            ..Default::default()
        },
    )]);
    document
}

/// Two channels of four samples, one missing.
struct Two;

const TIME: [f64; 4] = [0.0, 0.5, 1.0, 2.0];

impl Recorded for Two {
    fn time(&self) -> &[f64] {
        &TIME
    }

    fn channel(&self, name: &str) -> Option<(&[f64], Dimension)> {
        match name {
            "u" | "a" => Some((&[1.0, -2.0, 0.0, 4.0], Dimension::NONE)),
            "x" | "b" => Some((&[f64::NAN, 2.0, f64::NAN, 1e300], Dimension::NONE)),
            _ => None,
        }
    }

    fn names(&self) -> Vec<String> {
        ["u", "x"].map(String::from).to_vec()
    }
}
