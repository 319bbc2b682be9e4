//! The page of all models: the catalog, what was stored here, and a form to store one more.

use maud::{Markup, html};

use super::jobs_page::moment;
use super::layout::{Frame, page};
use super::search::search_form;

/// What the page shows.
pub struct ModelsView {
    /// The catalog, then what was stored, newest first.
    pub models: Vec<ModelRow>,
    pub is_later_page: bool,
    /// What is searched for.
    pub q: String,
    /// The address of the page behind this one.
    pub older: Option<String>,
    /// What the form begins with.
    pub draft: Option<Draft>,
}

/// A model in a line.
pub struct ModelRow {
    pub id: String,
    pub name: String,
    pub title: String,
    /// RFC 3339, UTC; absent of a catalog model.
    pub created: Option<String>,
    pub states: Vec<String>,
    pub inputs: Vec<String>,
    pub outputs: Vec<String>,
    /// Parameters that are estimated unless a job says otherwise.
    pub free: usize,
}

/// A model to begin with, as TOML.
pub struct Draft {
    pub name: String,
    pub text: String,
}

/// The whole page as HTML.
pub fn models_page(view: &ModelsView) -> String {
    let content = html! {
        div.row.center {
            h1 { "Models" }
            a.button.main href="#own" { "Add a model" }
        }
        p { "A model is a document: states, inputs, outputs and parameters with their units, and equations as text. Those of the catalog come with Trimtab, each with its source." }
        (search_form("/models", "models", &view.q, "name or title"))
        p.soft id="live" role="status" {}
        (table(view))
        (form(view.draft.as_ref()))
    };
    let frame = Frame {
        title: "Models",
        under: "/models",
        scripts: &["models.js"],
    };
    page(&frame, &content)
}

fn table(view: &ModelsView) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label="Models" {
            table.models {
                thead { tr {
                    th scope="col" { "model" } th scope="col" { "states" } th scope="col" { "inputs" } th scope="col" { "outputs" }
                    th.number scope="col" { "free parameters" } th scope="col" { "origin" }
                } }
                tbody {
                    @for model in &view.models {
                        tr {
                            th scope="row" {
                                a href={ "/models/" (model.id) } { (model.name) }
                                @if !model.title.is_empty() { br; span.soft { (model.title) } }
                            }
                            td { (model.states.join(", ")) }
                            td { (model.inputs.join(", ")) }
                            td { (model.outputs.join(", ")) }
                            td.number { (model.free) }
                            td { @match &model.created {
                                Some(created) => {
                                    "stored " (moment(created)) ", " code title=(model.id) { (short(&model.id)) } " "
                                    button type="button" data-delete=(model.id) data-name=(model.name) aria-label={ "Delete " (model.name) " " (short(&model.id)) } { "Delete" }
                                }
                                None => { "catalog" }
                            } }
                        }
                    }
                }
            }
        }
        @if view.models.is_empty() { p { @if view.q.is_empty() { "There are no more models." } @else { "No model matches." } } }
        p.row {
            @if view.is_later_page { a href="/models" { "First models" } }
            @if let Some(older) = &view.older { a href=(older) rel="next" { "More models" } }
        }
    }
}

/// The end of an id: what tells models of one name apart. Those stored in one minute begin alike.
pub(super) fn short(id: &str) -> &str {
    id.len()
        .checked_sub(8)
        .and_then(|from| id.get(from..))
        .unwrap_or(id)
}

fn form(draft: Option<&Draft>) -> Markup {
    html! {
        h2 id="own" { "Add a model" }
        p {
            "Write it, paste it, or drop a file. TOML and JSON say the same; "
            a href="/v1/models/short-period?format=toml" { "short-period" }
            " shows what a document looks like. It is checked before it is kept: names, units and equations."
        }
        @if let Some(draft) = draft { p { "The text below is a copy of " strong { (draft.name) } ": change it, and give it a name of its own." } }
        form id="add" {
            div.drop.text id="drop" {
                label { "Model document, TOML or JSON"
                    textarea id="document" rows="18" spellcheck="false" autocomplete="off" autocapitalize="off" required aria-describedby="faults" {
                        // the first line break of a text area is not part of it
                        "\n" @if let Some(draft) = draft { (draft.text) }
                    }
                }
            }
            div.row {
                label { "or a file" input type="file" id="file" accept=".toml,.json,application/json,application/toml"; }
                button.main { "Check and store" }
            }
        }
        p id="said" role="status" {}
        div id="faults" role="alert" {}
    }
}
