//! Who knows the truth: whether another name explains the flights as well as the right one.

use serde_json::json;
use trimtab_core::diagnose::{Effect, EffectParameter};
use trimtab_core::model::{EditKind, ModelDocument, Start};

use crate::case::Setting;
use crate::fault::Fault;
use crate::likelihood::{Residuals, ln_likelihood};
use crate::polish;
use crate::record::Recording;

/// Units of ln L within which two names are one and the same to these data.
const ALIKE: f64 = 3.0;

/// ln L that the true model reaches on the flights of the fit: with its own noise, and what its parameters absorb.
pub(crate) fn of_truth(setting: &Setting, recordings: &[Recording], faults: usize) -> f64 {
    let outputs = setting.noises.len();
    let noise: Residuals = (0..outputs)
        .map(|i| {
            recordings
                .iter()
                .filter(|r| r.fitted)
                .map(|r| r.noise[i].clone())
                .collect()
        })
        .collect();
    let flights = recordings.iter().filter(|r| r.fitted).count();
    let free = |per_flight: bool| {
        let each = setting.document.parameters.values().filter(|p| !p.fixed);
        each.filter(|p| (p.per == trimtab_core::model::Per::Maneuver) == per_flight)
            .count()
    };
    let unknowns = free(false) + flights * free(true) + faults;
    ln_likelihood(&noise, &setting.noises) + 0.5 * unknowns as f64
}

/// ln L of the declared model with an effect in it, from the values that the diagnosis has for it.
pub(crate) fn of_effect(
    setting: &Setting,
    recordings: &[Recording],
    effect: &Effect,
    parameters: &[EffectParameter],
) -> Option<f64> {
    if effect.edits.is_empty() {
        return None;
    }
    let mut document = effect.apply(&setting.document).ok()?.document;
    for value in parameters.iter().filter(|p| p.segment.is_none()) {
        start_at(&mut document, &value.name, value.estimate);
    }
    fitted(setting, recordings, &document)
}

fn fitted(setting: &Setting, recordings: &[Recording], document: &ModelDocument) -> Option<f64> {
    let options = json!({"error_bounds": "conventional"});
    let left = polish::fitted(document, recordings, &options, &setting.noises, None).ok()?;
    Some(ln_likelihood(&left, &setting.noises))
}

/// A value in SI as a parameter's start.
fn start_at(document: &mut ModelDocument, name: &str, value: f64) {
    if let Some(parameter) = document.parameters.get_mut(name)
        && let Ok(unit) = trimtab_core::flight::Unit::parse(&parameter.unit)
    {
        parameter.start = Start::Value(unit.from_si(value));
    }
}

/// How far the catalogue's own edit of a truth falls short of it, from the best of the names that it has; `None` where
/// none of them can be written into the document.
pub(crate) fn shortfall(
    setting: &Setting,
    recordings: &[Recording],
    fault: &Fault,
    size: f64,
) -> Option<f64> {
    let truth = of_truth(setting, recordings, 1);
    let of = |answer: &crate::fault::Answer| {
        let kind = EditKind::find(answer.kind)?;
        let term = answer.term.as_deref().map(|term| setting.renamed(term));
        let effect = Effect::edit(kind, setting.renamed(&answer.target), term.as_deref());
        let edited = effect.apply(&setting.document).ok()?;
        let added = edited.added.first().map(|added| &added.name);
        let edited = &edited.document;
        let start = |size: f64| {
            let mut edited = edited.clone();
            if let Some(added) = added {
                start_at(&mut edited, added, size);
            }
            fitted(setting, recordings, &edited)
        };
        let size = if kind == EditKind::ActuatorRateLimit {
            1.0 / size
        } else {
            size
        };
        start(size)
            .into_iter()
            .chain(fitted(setting, recordings, edited))
            .reduce(f64::max)
    };
    let best = fault.answers.iter().filter_map(of).reduce(f64::max)?;
    Some(truth - best)
}

/// The catalogue's own edit is the truth's model where it falls no shorter of it than this: what its own noise lets the
/// true model reach scatters by some units.
const ITS_MODEL: f64 = 10.0;

/// ln L that the true model must be thought to reach, of flights that do not tell it to rounding: inputs have noise too,
/// and are sampled. What the declared model loses by that on the same flights without any fault, the truth loses as well.
fn reached(setting: &Setting, recordings: &[Recording], faults: usize) -> f64 {
    let lost = setting.flown(&Vec::new(), true).and_then(|calm| {
        let found = fitted(setting, &calm, &setting.document)?;
        Some(of_truth(setting, &calm, 0) - found)
    });
    of_truth(setting, recordings, faults) - lost.unwrap_or(0.0).max(0.0)
}

/// Whether a named effect is an alias of the truth: it fits within three units of ln L of what the truth reaches.
pub(crate) fn is_alias(
    setting: &Setting,
    recordings: &[Recording],
    (fault, size): (&Fault, f64),
    effect: &Effect,
    parameters: &[EffectParameter],
) -> bool {
    let Some(found) = of_effect(setting, recordings, effect, parameters) else {
        return false;
    };
    let expected = reached(setting, recordings, 1);
    let own = shortfall(setting, recordings, fault, size);
    let own = own.map(|shortfall| of_truth(setting, recordings, 1) - shortfall);
    let truth = own.filter(|own| fault.known && (own - expected).abs() < ITS_MODEL);
    found > truth.unwrap_or(expected) - ALIKE
}

/// Whether a document explains the flights as well as the truth with its faults does.
pub(crate) fn explains(
    setting: &Setting,
    recordings: &[Recording],
    document: &ModelDocument,
    faults: usize,
) -> bool {
    let expected = reached(setting, recordings, faults);
    fitted(setting, recordings, document).is_some_and(|found| found > expected - ALIKE)
}
