//! Terms that an aerodynamic equation may lack.

use std::collections::BTreeSet;

use crate::flight::{is_control, is_flow_angle};
use crate::model::{Model, ModelDocument, expression};

fn is_sideslip(name: &str) -> bool {
    name.starts_with("beta") || name.starts_with("aos")
}

fn is_rate(name: &str) -> bool {
    matches!(name, "p" | "q" | "r")
}

/// Equations that carry aerodynamics: named coefficients where the document has them (C..), else the state equations
/// with a free parameter in them.
pub(super) fn aerodynamic(document: &ModelDocument) -> Vec<String> {
    let has_free = |text: &str| {
        names(text)
            .iter()
            .any(|name| document.parameters.get(name).is_some_and(|p| !p.fixed))
    };
    let coefficients: Vec<String> = (document.definitions.iter())
        .filter(|(name, definition)| name.starts_with('C') && has_free(&definition.equation))
        .map(|(name, _)| name.clone())
        .collect();
    if !coefficients.is_empty() {
        return coefficients;
    }
    let of_states = document
        .states
        .iter()
        .filter(|(_, state)| has_free(&state.derivative));
    of_states.map(|(name, _)| name.clone()).collect()
}

fn names(text: &str) -> BTreeSet<String> {
    let parsed = expression::parse(text).ok();
    let names = parsed.iter().flat_map(|tree| tree.names());
    names.map(|(name, _)| name.to_string()).collect()
}

/// Pairs of an equation and a term that it does not have.
pub(super) fn of(model: &Model) -> Vec<(String, String)> {
    let document = &model.document;
    let known =
        |name: &String| document.states.contains_key(name) || document.inputs.contains_key(name);
    let all: Vec<String> = document
        .states
        .keys()
        .chain(document.inputs.keys())
        .filter(|name| known(name))
        .cloned()
        .collect();
    let angles: Vec<&String> = all.iter().filter(|name| is_flow_angle(name)).collect();
    let rates: Vec<&String> = all.iter().filter(|name| is_rate(name)).collect();
    let controls: Vec<&String> = document
        .inputs
        .keys()
        .filter(|name| is_control(name))
        .collect();
    let mut found = Vec::new();
    for target in aerodynamic(document) {
        let text = match (
            document.definitions.get(&target),
            document.states.get(&target),
        ) {
            (Some(definition), _) => &definition.equation,
            (None, Some(state)) => &state.derivative,
            (None, None) => continue,
        };
        let present = names(text);
        let mut add = |term: String| found.push((target.clone(), term));
        for name in angles.iter().chain(&rates).chain(&controls) {
            if !present.contains(*name) {
                add((*name).clone());
            }
        }
        for angle in &angles {
            if is_sideslip(angle) {
                add(format!("{angle}*abs({angle})"));
            } else {
                add(format!("{angle}^2"));
            }
            add(format!("{angle}^3"));
        }
        for control in &controls {
            add(format!("{control}*abs({control})"));
        }
        for angle in &angles {
            for rate in &rates {
                add(format!("{angle}*{rate}"));
            }
            for control in &controls {
                add(format!("{angle}*{control}"));
            }
        }
        for (i, a) in angles.iter().enumerate() {
            angles[i + 1..].iter().for_each(|b| add(format!("{a}*{b}")));
        }
        for (i, a) in rates.iter().enumerate() {
            add(format!("{a}*abs({a})"));
            rates[i + 1..].iter().for_each(|b| add(format!("{a}*{b}")));
        }
    }
    found
}
