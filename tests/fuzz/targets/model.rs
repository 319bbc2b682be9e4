//! A model document, in JSON where it begins with `{`, else in TOML: read, compiled, evaluated once, written again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use trimtab_core::model::{Model, ModelDocument};

#[path = "common/evaluate.rs"]
mod evaluate;

fuzz_target!(|text: &str| {
    let document: ModelDocument = if text.trim_start().starts_with('{') {
        let Ok(document) = serde_json::from_str(text) else {
            return;
        };
        document
    } else {
        let Ok(document) = toml::from_str(text) else {
            return;
        };
        document
    };
    match Model::compile(&document) {
        Ok(model) => {
            evaluate::once(&model);
            let json = serde_json::to_string(&document).expect("a document is written");
            let again: ModelDocument = serde_json::from_str(&json).expect("and read again");
            assert_eq!(again, document, "{json}");
        }
        Err(faults) => assert!(!faults.is_empty(), "refused without a reason"),
    }
});
