//! What a diagnosis is told before the data, checked against the candidates that there are.

use std::collections::BTreeSet;

use crate::diagnose::{Case, Effect, Knowledge, KnownSize, candidates};
use crate::flight::{Fault, Unit, escape};
use crate::model::Model;

/// Names in a message: there may be hundreds of candidates.
const TOLD: usize = 30;

/// Longest lists of `exclude`, `known` and `clocks`.
const MOST: usize = 200;

pub(super) fn check(case: &Case, model: &Model, faults: &mut Vec<Fault>) {
    let knowledge = &case.knowledge;
    if *knowledge == Knowledge::default() {
        return;
    }
    for (list, len) in [
        ("exclude", knowledge.exclude.len()),
        ("known", knowledge.known.len()),
        ("clocks", knowledge.clocks.len()),
    ] {
        if len > MOST {
            let message = format!("{len} entries, at most {MOST} are allowed");
            faults.push(Fault::new(
                format!("/knowledge/{list}"),
                super::bounds::JOB_TOO_LARGE,
                message,
            ));
            return;
        }
    }
    quantities(case, faults);
    clocks(case, faults);
    // everything that there would be to exclude
    let all = Case {
        knowledge: Knowledge {
            exclude: Vec::new(),
            known: Vec::new(),
            ..knowledge.clone()
        },
        ..case.clone()
    };
    let effects = candidates(&all, model);
    for (i, entry) in knowledge.exclude.iter().enumerate() {
        if !effects
            .iter()
            .any(|effect| Knowledge::excludes(entry, effect))
        {
            let message = format!(
                "no candidate is '{entry:.80}'; write a kind, a target, or \"kind of target\": kinds are {}, targets are {}",
                told(effects.iter().map(Effect::word)),
                told(effects.iter().map(|effect| effect.target.clone())),
            );
            faults.push(Fault::new(
                format!("/knowledge/exclude/{i}"),
                "unknown_effect",
                message,
            ));
        }
    }
    for (i, known) in knowledge.known.iter().enumerate() {
        let pointer = format!("/knowledge/known/{i}");
        size(&pointer, known, faults);
        let meant: Vec<&Effect> = effects
            .iter()
            .filter(|effect| known.means(effect))
            .collect();
        if meant.is_empty() {
            let kind = known.kind.name();
            let of_kind = effects.iter().filter(|effect| effect.word() == kind);
            let message = format!(
                "no candidate is this {kind}; there are {}",
                told(of_kind.map(Effect::name))
            );
            faults.push(Fault::new(pointer, "unknown_effect", message));
            continue;
        }
        unit(case, &pointer, known, &meant, faults);
    }
}

fn told(names: impl Iterator<Item = String>) -> String {
    let names: BTreeSet<String> = names.collect();
    let more = names.len().saturating_sub(TOLD);
    let mut told: Vec<String> = names.into_iter().take(TOLD).collect();
    if more > 0 {
        told.push(format!("and {more} more"));
    }
    match told.is_empty() {
        true => "none".to_string(),
        false => told.join(", "),
    }
}

fn quantities(case: &Case, faults: &mut Vec<Fault>) {
    for (name, quantity) in &case.knowledge.quantities {
        let pointer = format!("/knowledge/quantities/{}", escape(name));
        let mut channels = case
            .flights
            .iter()
            .filter_map(|flight| flight.channels.get(name));
        match channels.next() {
            None => {
                let recorded = case
                    .flights
                    .iter()
                    .flat_map(|flight| flight.channels.keys());
                let message = format!(
                    "no channel '{name}' is recorded; recorded are {}",
                    told(recorded.cloned())
                );
                faults.push(Fault::new(pointer, "unknown_channel", message));
            }
            Some((_, dimension)) if !quantity.measures(*dimension) => {
                let message = format!(
                    "'{name}' is recorded in {dimension}, which no {} is measured in; correct the unit in the recording's header",
                    quantity.name()
                );
                faults.push(Fault::new(pointer, "unit_mismatch", message));
            }
            Some(_) => {}
        }
    }
}

fn clocks(case: &Case, faults: &mut Vec<Fault>) {
    let document = &case.document;
    for (i, group) in case.knowledge.clocks.iter().enumerate() {
        let pointer = format!("/knowledge/clocks/{i}");
        for (j, name) in group.iter().enumerate() {
            let pointer = format!("{pointer}/{j}");
            if !document.inputs.contains_key(name) && !document.outputs.contains_key(name) {
                let known = document.inputs.keys().chain(document.outputs.keys());
                let message = format!(
                    "the model has no input or output '{name:.80}'; it has {}",
                    told(known.cloned())
                );
                faults.push(Fault::new(pointer, "unknown_channel", message));
            } else if group[..j].contains(name) {
                let message = format!("'{name}' stands in the group twice; leave one out");
                faults.push(Fault::new(pointer, "duplicate_name", message));
            }
        }
        if group.len() < 2 {
            let message = "a clock is shared by two or more inputs or outputs; a single one is a candidate anyway";
            faults.push(Fault::new(pointer, "bad_option", message));
        }
    }
}

fn size(pointer: &str, known: &KnownSize, faults: &mut Vec<Fault>) {
    let mut fault = |field: &str, message: &str| {
        faults.push(Fault::new(
            format!("{pointer}/{field}"),
            "bad_option",
            message,
        ));
    };
    if known
        .size_sd
        .is_some_and(|sd| !(sd >= 0.0 && sd.is_finite()))
    {
        fault(
            "size_sd",
            "a standard deviation is 0 or more; 0 means that it is not there",
        );
    }
    if known
        .lower
        .is_some_and(|lower| lower > 0.0 || lower.is_nan())
    {
        fault("lower", "it must be 0 or less: no effect is in the range");
    }
    if known
        .upper
        .is_some_and(|upper| upper < 0.0 || upper.is_nan())
    {
        fault("upper", "it must be 0 or more: no effect is in the range");
    }
    if known.size_sd.is_none() && known.lower.is_none() && known.upper.is_none() {
        faults.push(Fault::new(
            pointer,
            "bad_option",
            "say what is known of its size: \"size_sd\", \"lower\" or \"upper\"; to leave it out altogether use \"exclude\"",
        ));
    }
}

/// The unit must be that of the effect's size.
fn unit(case: &Case, pointer: &str, known: &KnownSize, meant: &[&Effect], faults: &mut Vec<Fault>) {
    let Some(text) = &known.unit else { return };
    let pointer = format!("{pointer}/unit");
    let unit = match Unit::parse(text) {
        Ok(unit) => unit,
        Err(error) => {
            faults.push(Fault::new(pointer, "unknown_unit", error.to_string()));
            return;
        }
    };
    for effect in meant {
        let Ok(edited) = effect.apply(&case.document) else {
            continue;
        };
        let size = edited.added.first();
        let size = size.and_then(|added| edited.document.parameters.get(&added.name));
        let measured = size.and_then(|size| Unit::parse(&size.unit).ok());
        if let Some(measured) = measured.filter(|measured| measured.dimension != unit.dimension) {
            let message = format!(
                "the size of {} is in {}, not in {}",
                effect.name(),
                measured.dimension,
                unit.dimension
            );
            faults.push(Fault::new(pointer, "unit_mismatch", message));
            return;
        }
    }
}
