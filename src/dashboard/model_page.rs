//! The page of one model: its equations, its quantities, and how another differs from it.

use maud::{Markup, html};

use super::layout::{Frame, page};
use super::mathml::{Left, equation};
use super::model_diff::{Comparison, comparison};
use super::model_tables as tables;
use super::models_page::short;
use super::notation::Notation;
use crate::model::{Element, ModelDocument};

/// What the page shows.
pub struct ModelView {
    /// A catalog name, or the id of a stored model.
    pub id: String,
    pub document: ModelDocument,
    /// What it can be compared with.
    pub others: Vec<OtherModel>,
    pub against: Option<Comparison>,
}

/// A model that can be chosen.
pub struct OtherModel {
    pub reference: String,
    pub name: String,
    /// RFC 3339, UTC; absent of a catalog model.
    pub created: Option<String>,
}

/// The whole page as HTML.
pub fn model_page(view: &ModelView) -> String {
    let document = &view.document;
    let notation = Notation::of(document);
    let content = html! {
        h1 { (document.name) }
        @if !document.title.is_empty() { p { strong { (document.title) } } }
        @if !document.source.is_empty() { p.soft { "Source: " (document.source) } }
        (actions(&view.id))
        @if let Some(against) = &view.against { (comparison(document, against)) }
        @for paragraph in document.description.split("\n\n").filter(|text| !text.trim().is_empty()) { p { (paragraph) } }
        p.soft { "Point at a symbol for the name that it has in the document." }
        (equations(document, &notation))
        (quantities(document, &notation))
        (choice(view))
    };
    let frame = Frame {
        title: &document.name,
        under: "/models",
        scripts: &[],
    };
    page(&frame, &content)
}

fn actions(id: &str) -> Markup {
    html! {
        div.row.center.actions {
            a.button.main href={ "/new?model=" (id) } { "New job with this model" }
            a.button href="#compare" { "Compare with another" }
            a.button href={ "/models?from=" (id) "#own" } { "Change a copy" }
            a href={ "/v1/models/" (id) "?format=toml" } download={ (id) ".toml" } { "TOML" }
            a href={ "/v1/models/" (id) "?format=json" } download={ (id) ".json" } { "JSON" }
        }
    }
}

pub(super) fn equations(document: &ModelDocument, notation: &Notation) -> Markup {
    let inputs = document.inputs.iter().map(|(name, one)| (name, one.path()));
    let outputs = document
        .outputs
        .iter()
        .map(|(name, one)| (name, one.path()));
    let mut paths = Vec::new();
    for (name, path) in inputs.chain(outputs) {
        let passed = path.into_iter();
        paths
            .extend(passed.map(|(element, size)| (Left::Size(element, name), size, what(element))));
    }
    let states = || document.states.iter();
    let dynamics = states().map(|(name, state)| {
        let (text, description) = (state.derivative.as_str(), state.description.as_str());
        (Left::Rate(name), text, description)
    });
    let initial = states().map(|(name, state)| (Left::Initial(name), state.initial.as_str(), ""));
    let definitions = document.definitions.iter().map(|(name, definition)| {
        let (text, description) = (
            definition.equation.as_str(),
            definition.description.as_str(),
        );
        (Left::Value(name), text, description)
    });
    let outputs = document.outputs.iter().map(|(name, output)| {
        let (text, description) = (output.equation.as_str(), output.description.as_str());
        (Left::Output(name), text, description)
    });
    html! {
        (list("State equations", notation, dynamics))
        (list("Initial values", notation, initial))
        (list("Definitions", notation, definitions))
        (list("Output equations", notation, outputs))
        (list("Signal paths", notation, paths.into_iter()))
    }
}

fn what(element: Element) -> &'static str {
    match element {
        Element::Play => "half the width of the dead band",
        Element::RateLimit => "largest rate",
        Element::Lag => "time constant, in seconds",
        Element::Delay => "in seconds",
    }
}

/// Equations with what they describe, under a heading; nothing of none.
fn list<'a>(
    heading: &str,
    notation: &Notation,
    equations: impl Iterator<Item = (Left<'a>, &'a str, &'a str)>,
) -> Markup {
    let mut equations = equations.peekable();
    html! {
        @if equations.peek().is_some() {
            h2 { (heading) }
            div.scroll tabindex="0" role="region" aria-label=(heading) {
                ul.equations {
                    @for (left, text, description) in equations {
                        li { (equation(notation, left, text)) @if !description.is_empty() { span.soft { (description) } } }
                    }
                }
            }
        }
    }
}

pub(super) fn quantities(document: &ModelDocument, notation: &Notation) -> Markup {
    let sections = [
        (
            "Parameters",
            document.parameters.is_empty(),
            tables::parameters(document, notation),
        ),
        (
            "Inputs",
            document.inputs.is_empty(),
            tables::inputs(document, notation),
        ),
        (
            "Outputs",
            document.outputs.is_empty(),
            tables::outputs(document, notation),
        ),
        (
            "Constants",
            document.constants.is_empty(),
            tables::constants(document, notation),
        ),
    ];
    html! {
        @for (heading, is_empty, table) in sections {
            @if !is_empty {
                h2 { (heading) }
                div.scroll tabindex="0" role="region" aria-label={ (heading) " of the model" } { (table) }
            }
        }
    }
}

fn choice(view: &ModelView) -> Markup {
    let chosen = view
        .against
        .as_ref()
        .map(|against| against.reference.as_str());
    let is_listed = view
        .others
        .iter()
        .any(|other| Some(other.reference.as_str()) == chosen);
    html! {
        h2 id="compare" { "Compare with another" }
        form.row method="get" {
            label { "Other model"
                select name="against" {
                    @if let Some(against) = view.against.as_ref().filter(|_| !is_listed) {
                        option value=(against.reference) selected { (against.name) }
                    }
                    @for other in &view.others {
                        option value=(other.reference) selected[chosen == Some(other.reference.as_str())] {
                            (other.name)
                            @if let Some(created) = &other.created { ", stored " (created.split('.').next().unwrap_or_default().replace('T', " ")) ", " (short(&other.reference)) }
                        }
                    }
                }
            }
            button { "Compare" }
            @if chosen.is_some() { a href={ "/models/" (view.id) } { "End the comparison" } }
        }
    }
}
