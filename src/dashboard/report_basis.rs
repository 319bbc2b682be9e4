//! What the numbers of a report rest on: the model, the recordings and their channels, the method.

use maud::{Markup, html};
use serde::Serialize;

use super::diagnosis::part;
use super::maneuver_page::what_was_flown;
use super::model_page::{equations, quantities};
use super::notation::Notation;
use crate::estimate::{Estimate, Noise, Options, five_digits as number};
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
                    td.soft { (recorded_units(recordings, name)) }
                } }
                @for (name, formula) in others { tr {
                    th scope="row" { (name) } td {} td {} td { code { (formula) } } td.soft { (recorded_units(recordings, name)) }
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

/// Units in which the recordings have a channel, each once.
fn recorded_units(recordings: &[ReportRecording], name: &str) -> String {
    let mut units: Vec<&str> = Vec::new();
    let summaries = recordings.iter().filter_map(|one| one.summary.as_ref());
    for channel in summaries.flat_map(|summary| &summary.channels) {
        if channel.name == name && !units.contains(&channel.unit.as_str()) {
            units.push(&channel.unit);
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

/// Estimator, integration, noise, bounds: the options of the job, defaults included.
pub(super) fn method(options: &Options, estimate: Option<&Estimate>) -> Markup {
    let integration = estimate.and_then(|estimate| estimate.integration.as_ref());
    html! {
        h2 id="method" { "Method" }
        dl.facts {
            dt { "estimator" } dd { (words(options.estimator.name())) }
            dt { "start" } dd { (words(&kind(&options.start))) }
            dt { "optimiser" } dd { (word(&options.method)) ", " (words(&kind(&options.derivatives))) }
            dt { "convergence" } dd { "a further step below " (plain(&options.tolerance)) " standard errors; at most " (options.max_iterations) " iterations" }
            dt { "integrator" } dd { (word(&options.integrator)) ", steps between samples: " (word(&options.steps_per_sample))
                @if let Some(integration) = integration {
                    " (" (integration.most_steps()) " used"
                    @if let Some(halved) = &integration.halved { "; halving the steps moves no estimate by more than " (number(halved.most)) " standard errors" }
                    ")"
                }
            }
            dt { "inputs between samples" } dd { (word(&options.input_interpolation)) }
            dt { "measurement noise" } dd { (noise(&options.noise)) }
            dt { "standard errors" } dd { (word(&options.error_bounds)) }
            @if !options.process_noise.is_empty() { dt { "process noise" } dd { code { (plain(&options.process_noise)) } } }
            @if let Some(band) = &options.frequency { dt { "frequencies" } dd { code { (plain(band)) } } }
        }
        @if let Some(estimate) = estimate { (noise_table(estimate)) }
    }
}

fn noise(noise: &Noise) -> &'static str {
    match noise {
        Noise::Given { .. } => "known, from the job",
        estimated if estimated.is_full() => {
            "estimated with the parameters, correlated between outputs"
        }
        _ => "estimated with the parameters, independent between outputs",
    }
}

/// Standard deviations of the noise, and correlations where there are any.
fn noise_table(estimate: &Estimate) -> Markup {
    let r = &estimate.noise_covariance;
    let sd = |at: usize| {
        r.get(at)
            .and_then(|row| row.get(at))
            .map_or(f64::NAN, |variance| variance.sqrt())
    };
    let correlation = |i: usize, j: usize| {
        r.get(i)
            .and_then(|row| row.get(j))
            .map(|c| c / (sd(i) * sd(j)))
    };
    let is_full = (0..r.len()).any(|i| (0..i).any(|j| correlation(i, j).is_some_and(|c| c != 0.0)));
    html! {
        @if r.len() == estimate.outputs.len() && !r.is_empty() {
            h3 id="noise" { "Noise of the outputs" }
            div.scroll tabindex="0" role="region" aria-labelledby="noise" { table {
                thead { tr {
                    th scope="col" { "output" } th scope="col" { "unit" } th.number scope="col" { "standard deviation" }
                    @if is_full { @for output in &estimate.outputs { th.number scope="col" { "correlation with " (output.name) } } }
                } }
                tbody { @for (at, output) in estimate.outputs.iter().enumerate() {
                    @let shown = shown_in(&output.unit);
                    tr {
                        th scope="row" { (output.name) } td.soft { (shown.unit) } td.number { (number(sd(at) * shown.scale)) }
                        @if is_full { @for other in 0..r.len() { td.number { @if let Some(c) = correlation(at, other) { (format!("{c:.2}")) } } } }
                    }
                } }
            } }
        }
    }
}

/// An option as people read it: of a word in JSON the word, without underscores.
fn word(option: &impl Serialize) -> String {
    words(&plain(option))
}

/// The kind of an option that has more to say; where it has, all of it follows.
fn kind(option: &impl Serialize) -> String {
    let Ok(serde_json::Value::Object(mut fields)) = serde_json::to_value(option) else {
        return plain(option);
    };
    let names = ["kind", "technique"];
    let name = names.iter().find_map(|name| fields.remove(*name));
    let name = name.map_or_else(String::new, |name| plain(&name));
    let rest: Vec<String> = (fields.iter().filter(|(_, value)| !value.is_null()))
        .map(|(field, value)| format!("{field} {}", plain(value)))
        .collect();
    if rest.is_empty() {
        name
    } else {
        format!("{name} ({})", rest.join(", "))
    }
}

fn words(name: &str) -> String {
    name.replace('_', " ")
}

/// As JSON, a text without its quotes.
fn plain(value: &impl Serialize) -> String {
    match serde_json::to_value(value) {
        Ok(serde_json::Value::String(text)) => text,
        Ok(other) => other.to_string(),
        Err(_) => String::new(),
    }
}
