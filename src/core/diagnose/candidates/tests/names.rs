//! Names do not matter: what quantities are is declared, or told by the equations.

use std::collections::{BTreeMap, BTreeSet};

use indexmap::IndexMap;

use super::{BESIDE, beside, case, names, offered};
use crate::diagnose::candidates::taken_for;
use crate::diagnose::effect::{Effect, EffectKind};
use crate::flight::PhysicalQuantity;
use crate::model::{EditKind, ModelDocument, Quantities, Start, catalog};

/// Each name in a text by another.
fn renamed(text: &str, by: &BTreeMap<String, String>) -> String {
    let mut result = String::new();
    let mut word = String::new();
    for c in text.chars().chain([' ']) {
        if c.is_ascii_alphanumeric() || c == '_' {
            word.push(c);
            continue;
        }
        // the rate of a state is called after it
        let rate = || Some(format!("{}dot", by.get(word.strip_suffix("dot")?)?));
        let other = by.get(&word).cloned().or_else(rate);
        result.push_str(other.as_ref().unwrap_or(&word));
        word.clear();
        result.push(c);
    }
    result.trim_end().to_string()
}

fn with_other_names(document: &ModelDocument, by: &BTreeMap<String, String>) -> ModelDocument {
    fn section<T: Clone>(
        entries: &IndexMap<String, T>,
        by: &BTreeMap<String, String>,
        change: impl Fn(&mut T),
    ) -> IndexMap<String, T> {
        let renamed = |(name, entry): (&String, &T)| {
            let mut entry = entry.clone();
            change(&mut entry);
            (by[name].clone(), entry)
        };
        entries.iter().map(renamed).collect()
    }
    let text = |text: &mut String| *text = renamed(text, by);
    let delay = |delay: &mut Option<String>| delay.iter_mut().for_each(text);
    ModelDocument {
        constants: section(&document.constants, by, |_| {}),
        inputs: section(&document.inputs, by, |x| delay(&mut x.delay)),
        parameters: section(&document.parameters, by, |x| {
            if let Start::FromData(start) = &mut x.start {
                text(start);
            }
        }),
        definitions: section(&document.definitions, by, |x| text(&mut x.equation)),
        states: section(&document.states, by, |x| {
            text(&mut x.initial);
            text(&mut x.derivative);
        }),
        outputs: section(&document.outputs, by, |x| {
            text(&mut x.equation);
            delay(&mut x.delay);
        }),
        ..document.clone()
    }
}

/// Every name of a document and of what is recorded beside it, by one that says nothing.
fn opaque_names(document: &ModelDocument) -> BTreeMap<String, String> {
    let all = (document.constants.keys())
        .chain(document.inputs.keys())
        .chain(document.parameters.keys())
        .chain(document.definitions.keys())
        .chain(document.states.keys())
        .chain(document.outputs.keys())
        .cloned()
        .chain(BESIDE.map(|(name, ..)| name.to_string()));
    let all: BTreeSet<String> = all.collect();
    all.into_iter()
        .enumerate()
        .map(|(i, name)| (name, format!("n{i}")))
        .collect()
}

#[test]
fn names_do_not_matter() {
    for document in catalog::all() {
        let by = opaque_names(&document);
        let other = with_other_names(&document, &by);
        let renamed_beside: Vec<_> = (beside().into_iter())
            .map(|(name, unit, is)| (by[&name].clone(), unit, is))
            .collect();
        // the arms of a sensor are axes, not names
        let said = |effect: &Effect, by: &BTreeMap<String, String>| {
            let is_arm = effect.kind == EffectKind::Edit(EditKind::SensorPosition);
            let term = effect.term.as_deref().unwrap_or_default();
            let term = if is_arm {
                term.to_string()
            } else {
                renamed(term, by)
            };
            let target = renamed(&effect.target, by);
            format!(
                "{} of {target} ({term}) {:?}",
                effect.word(),
                effect.plausible
            )
        };
        let wanted: BTreeSet<String> = (offered(&case(&document, &beside())).iter())
            .map(|effect| said(effect, &by))
            .collect();
        let found: BTreeSet<String> = (offered(&case(&other, &renamed_beside)).iter())
            .map(|effect| said(effect, &BTreeMap::new()))
            .collect();
        let missing: Vec<&String> = wanted.difference(&found).collect();
        let new: Vec<&String> = found.difference(&wanted).collect();
        assert!(
            missing.is_empty() && new.is_empty(),
            "{}: {missing:#?} {new:#?}",
            document.name
        );
    }
}

/// Only the flow angle is declared; all else by equations.
#[test]
fn structure_tells_what_names_do_not() {
    let mut document = catalog::find("short-period").unwrap();
    let by = opaque_names(&document);
    for state in document.states.values_mut() {
        state.quantity = state.quantity.filter(|quantity| quantity.is_flow_angle());
    }
    document
        .inputs
        .values_mut()
        .for_each(|input| input.quantity = None);
    document
        .outputs
        .values_mut()
        .for_each(|output| output.quantity = None);
    let found = names(&offered(&case(&with_other_names(&document, &by), &[])));
    let declared = catalog::find("short-period").unwrap();
    let wanted = names(&offered(&case(&declared, &[])));
    let wanted: BTreeSet<String> = wanted.iter().map(|name| renamed(name, &by)).collect();
    assert_eq!(found, wanted);
}

#[test]
fn the_answer_says_what_was_taken_for_what() {
    let mut document = catalog::find("short-period").unwrap();
    document
        .outputs
        .values_mut()
        .for_each(|output| output.quantity = None);
    let quantities = Quantities::of(&document);
    assert_eq!(quantities.output("q"), Some(PhysicalQuantity::PitchRate));
    let told = taken_for(&case(&document, &beside()));
    let of = |name: &str| told.iter().find(|taken| taken.name == name).unwrap();
    assert_eq!(of("de").quantity, PhysicalQuantity::Elevator);
    assert_eq!(of("de").reason, "the model says so");
    assert_eq!(of("V").reason, "the job says so");
}
