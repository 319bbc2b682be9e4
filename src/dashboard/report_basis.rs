//! What the numbers of a report rest on: the model, the recordings and their channels.

use maud::{Markup, html};
use serde::Serialize;

use super::diagnosis::part;
use super::maneuver_page::what_was_flown;
use super::model_page::{equations, quantities};
use super::notation::Notation;
use crate::estimate::five_digits as number;
use crate::flight::{Flown, shown_in};
use crate::ingest::Summary;
use crate::job::{JobSpec, ManeuverUse};
use crate::model::{ModelDocument, Start};

/// A recording, as a report tells of it.
pub struct ReportRecording {
    /// What the job calls it.
    pub label: String,
    pub used: ManeuverUse,
    /// What it was called when it was uploaded; nothing of one that was deleted since.
    pub name: String,
    pub summary: Option<Summary>,
    /// What was flown, as the job took it.
    pub flown: Flown,
}

/// Equations and quantities of the model that was estimated.
pub(super) fn model(document: &ModelDocument) -> Markup {
    let notation = Notation::of(document);
    let document = &rounded(document);
    html! {
        section {
            h2 id="model" { "Model: " (document.name) }
            @if !document.title.is_empty() { p { strong { (document.title) } } }
            @if !document.source.is_empty() { p.soft { "Source: " (document.source) } }
            p.soft { "As it was estimated: with the edits of the job and the effects that a diagnosis found. The estimates stand in the table of parameters above." }
            (equations(document, &notation))
            (quantities(document, &notation))
        }
    }
}

/// With start values of five digits: those of a diagnosis are estimates, with all that they have.
fn rounded(document: &ModelDocument) -> ModelDocument {
    let mut document = document.clone();
    for parameter in document.parameters.values_mut() {
        if let Start::Value(value) = &mut parameter.start {
            *value = number(*value).parse().unwrap_or(*value);
        }
    }
    document
}

/// The recordings: the part of each that was used, how it was sampled, what was flown.
pub(super) fn recordings(all: &[ReportRecording]) -> Markup {
    html! {
        h2 id="recordings" { "Recordings" }
        div.scroll tabindex="0" role="region" aria-labelledby="recordings" { table {
            thead { tr {
                th scope="col" { "maneuver" } th scope="col" { "recording" } th scope="col" { "role" } th scope="col" { "window" } th scope="col" { "gaps" }
                th.number scope="col" { "samples recorded" } th.number scope="col" { "rate, Hz" }
            } }
            tbody { @for one in all { tr {
                th scope="row" { (one.label) } td { (one.name) } td { (part(one.used.role)) } td { (window(&one.used)) } td { (word(&one.used.gaps)) }
                td.number { @if let Some(summary) = &one.summary { (summary.samples) } }
                td.number { @if let Some(summary) = &one.summary { (number(summary.rate)) } }
            } } }
        } }
        @for one in all.iter().filter(|one| !one.flown.is_empty()) {
            h3 { (one.label) }
            (what_was_flown(&one.flown))
        }
    }
}

fn window(used: &ManeuverUse) -> String {
    match (used.seconds, used.rows) {
        (Some([from, to]), _) => format!("{from} to {to} s"),
        (None, Some([from, to])) => format!("rows {from} to {to}"),
        (None, None) => "all of it".to_string(),
    }
}

/// From which channels the model's inputs and outputs were made.
pub(super) fn channels(
    spec: &JobSpec,
    document: &ModelDocument,
    recordings: &[ReportRecording],
) -> Markup {
    let inputs = (document.inputs.iter()).map(|(name, input)| ("input", name, &input.unit));
    let outputs = (document.outputs.iter()).map(|(name, output)| ("output", name, &output.unit));
    let rows: Vec<_> = inputs.chain(outputs).collect();
    let names: Vec<&String> = rows.iter().map(|(_, name, _)| *name).collect();
    let others = spec
        .channels
        .iter()
        .filter(|(name, _)| !names.contains(name));
    html! {
        h2 id="channels" { "Channels" }
        p.soft { "From which recorded channels the inputs and outputs of the model were made; units as they were recorded." }
        div.scroll tabindex="0" role="region" aria-labelledby="channels" { table {
            thead { tr { th scope="col" { "quantity" } th scope="col" { "of the model" } th scope="col" { "unit" } th scope="col" { "made from" } th scope="col" { "recorded in" } } }
            tbody {
                @for (what, name, unit) in &rows { tr {
                    th scope="row" { (name) } td { (what) } td.soft { (shown_in(unit).unit) }
                    td { @match spec.channels.get(*name) { Some(formula) => code { (formula) }, None => "the channel of this name" } }
                    td.soft { (recorded_units(spec, recordings, name)) }
                } }
                @for (name, formula) in others { tr {
                    th scope="row" { (name) } td {} td {} td { code { (formula) } } td.soft { (recorded_units(spec, recordings, name)) }
                } }
            }
        } }
        @for one in recordings.iter().filter(|one| !one.used.channels.is_empty()) {
            p { "In " (one.label) ": "
                @for (at, (name, formula)) in one.used.channels.iter().enumerate() { @if at > 0 { ", " } (name) " = " code { (formula) } }
            }
        }
        (constants(spec, recordings))
    }
}

/// Units in which the recordings have the channel that a quantity is, each once; nothing where it is made by a formula of several.
fn recorded_units(spec: &JobSpec, recordings: &[ReportRecording], name: &str) -> String {
    let mut units: Vec<&str> = Vec::new();
    for one in recordings {
        let formula = one.used.channels.get(name).or(spec.channels.get(name));
        let channel = formula.map_or(name, |formula| formula.trim());
        let channels = one.summary.iter().flat_map(|summary| &summary.channels);
        for found in channels.filter(|found| found.name == channel) {
            if !units.contains(&found.unit.as_str()) {
                units.push(&found.unit);
            }
        }
    }
    units.join(", ")
}

/// Values that the job gives the model's constants, for all maneuvers or for one.
fn constants(spec: &JobSpec, recordings: &[ReportRecording]) -> Markup {
    let of_all = spec.constants.iter().map(|pair| ("all", pair));
    let of_one = recordings.iter().flat_map(|one| {
        let pairs = one.used.constants.iter();
        pairs.map(move |pair| (one.label.as_str(), pair))
    });
    let rows: Vec<_> = of_all.chain(of_one).collect();
    html! {
        @if !rows.is_empty() {
            h3 id="constants" { "Constants that the job gave" }
            div.scroll tabindex="0" role="region" aria-labelledby="constants" { table {
                thead { tr { th scope="col" { "constant" } th scope="col" { "maneuvers" } th.number scope="col" { "value, in its own unit" } } }
                tbody { @for (of, (name, value)) in rows { tr { th scope="row" { (name) } td { (of) } td.number { (plain(value)) } } } }
            } }
        }
    }
}

/// An option as people read it: of a word in JSON the word, without underscores.
pub(super) fn word(option: &impl Serialize) -> String {
    words(&plain(option))
}

pub(super) fn words(name: &str) -> String {
    name.replace('_', " ")
}

/// As JSON, a text without its quotes.
pub(super) fn plain(value: &impl Serialize) -> String {
    match serde_json::to_value(value) {
        Ok(serde_json::Value::String(text)) => text,
        Ok(other) => other.to_string(),
        Err(_) => String::new(),
    }
}
