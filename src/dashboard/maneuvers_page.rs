//! The page of all maneuvers: what is recorded, and how more of it gets here.

use maud::{Markup, html};

use super::jobs_page::moment;
use super::layout::{Frame, page};
use super::search::search_form;
use super::unit_list::unit_list;
use crate::estimate::five_digits as number;
use crate::flight::{Finding, Severity};
use crate::ingest::Summary;

/// What the page shows.
pub struct ManeuversView {
    /// Newest first.
    pub maneuvers: Vec<ManeuverRow>,
    /// Names of the mappings that an upload can have, and which recordings each is for.
    pub mappings: Vec<(String, String)>,
    /// Not the newest: reached by way of `older`.
    pub is_later_page: bool,
    /// What is searched for.
    pub q: String,
    /// The address of the page of older ones.
    pub older: Option<String>,
}

/// A maneuver in a line.
pub struct ManeuverRow {
    pub id: String,
    pub name: String,
    /// RFC 3339, UTC.
    pub created: String,
    /// `None`: what is kept of it cannot be read.
    pub summary: Option<Summary>,
}

/// The whole page as HTML.
pub fn maneuvers_page(view: &ManeuversView) -> String {
    let content = html! {
        h1 { "Maneuvers" }
        (upload(view))
        h2 { "Recorded" }
        @if !view.maneuvers.is_empty() || view.is_later_page || !view.q.is_empty() {
            (search_form("/maneuvers", "maneuvers", &view.q, "name, tag, flight or notes"))
        }
        p.soft id="live" role="status" {}
        div id="maneuvers" { (list(view)) }
    };
    let frame = Frame {
        title: "Maneuvers",
        under: "/maneuvers",
        scripts: &["maneuvers.js"],
    };
    page(&frame, &content)
}

fn upload(view: &ManeuversView) -> Markup {
    html! {
        div.drop id="drop" {
            label { "Drop recordings here, or choose them"
                input type="file" id="choose" multiple accept=".csv,.txt,.tsv,.log,.dat,.out,.asc,.lvm,.vbo,.ict,.json,.mat,.xlsx,.xlsm,.parquet,.h5,.hdf5,.nc,.tdms,.mf4,.ulg,.ulog,.bin,.gz,.zip";
            }
            p.soft { "CSV with names and units, Excel workbooks, Parquet, logs of PX4 and ArduPilot, TDMS, MDF 4, MAT, HDF5, JSON, or a matrix as text; any of them packed with gzip or zip. Columns and units of CSV are shown before anything is stored." }
        }
        div id="files" {}
        button.main type="button" id="all" hidden { "Upload all" }
        template id="file" { (file(&view.mappings)) }
        (unit_list())
    }
}

/// A chosen file, before it is sent: scripts fill in what is in it.
fn file(mappings: &[(String, String)]) -> Markup {
    html! {
        section.file {
            h2 data-part="title" tabindex="-1" {}
            p.soft data-part="about" {}
            div data-part="form" {
                div.row {
                    label { "Name" input data-part="name" maxlength="200" autocomplete="off"; }
                    label data-part="mappings" { "Mapping"
                        select data-part="mapping" {
                            option value="" { "none" }
                            @for (name, about) in mappings { option value=(name) title=(about) { (name) } }
                        }
                    }
                }
                div data-part="columns" {}
                details data-part="document" hidden {
                    summary { "The mapping, written out" }
                    label { "Where time and channels are, and in which units"
                        textarea data-part="text" rows="10" cols="72" spellcheck="false"
                            placeholder=r#"{"time": {"from": "data(:,1)", "unit": "s"}, "channels": {"alpha": {"from": "data(:,2)", "unit": "deg"}}}"# {}
                    }
                }
                div.row.center data-part="keeping" hidden {
                    label.beside { input type="checkbox" data-part="keep"; "Keep this mapping for other files, as" }
                    input data-part="kept" aria-label="Name of the mapping" maxlength="64" pattern="[A-Za-z0-9_.\\-]+" autocomplete="off";
                }
                div.row.center {
                    button.main type="button" data-part="send" { "Upload" }
                    button type="button" data-part="drop" { "Remove" }
                    progress data-part="progress" max="1" value="0" aria-label="Upload" hidden {}
                }
            }
            div data-part="told" role="status" {}
        }
    }
}

fn list(view: &ManeuversView) -> Markup {
    html! {
        @if view.maneuvers.is_empty() {
            p { @if view.is_later_page { "There are no older ones." } @else if !view.q.is_empty() { "No maneuver matches." } @else { "Nothing is recorded here yet." } }
        } @else {
            form method="get" action="/new" {
                div.scroll tabindex="0" role="region" aria-label="Maneuvers" {
                    table {
                        thead { tr {
                            th scope="col" { "use" } th scope="col" { "maneuver" }
                            th.number scope="col" { "duration, s" } th.number scope="col" { "samples" } th.number scope="col" { "rate, Hz" }
                            th scope="col" { "channels" } th scope="col" { "findings" } th scope="col" { "uploaded" }
                        } }
                        tbody { @for maneuver in &view.maneuvers { (row(maneuver)) } }
                    }
                }
                p { button { "New job with the chosen" } }
            }
        }
        @if let Some(older) = &view.older { p { a href=(older) rel="next" { "Older maneuvers" } } }
    }
}

fn row(maneuver: &ManeuverRow) -> Markup {
    let ManeuverRow { id, summary, .. } = maneuver;
    let title = title(&maneuver.name, id);
    html! {
        tr {
            td { input type="checkbox" name="estimation" value=(id) aria-label={ "use " (title) }; }
            th scope="row" { a href={ "/maneuvers/" (id) } { (title) } }
            @if let Some(summary) = summary {
                td.number { (number(summary.duration)) }
                td.number { (summary.samples) }
                td.number { (number(summary.rate)) }
                td.soft.names { (channels(summary)) }
                td { (count(&summary.findings)) }
            } @else {
                td colspan="5" { "what was summed up of it cannot be read; upload it again" }
            }
            td { (moment(&maneuver.created)) }
        }
    }
}

/// What a maneuver is called: one without a name by the beginning of its id.
pub(super) fn title<'a>(name: &'a str, id: &'a str) -> &'a str {
    if name.is_empty() {
        id.get(..12).unwrap_or(id)
    } else {
        name
    }
}

/// The first channels by name, and how many more there are.
fn channels(summary: &Summary) -> String {
    const FIRST: usize = 8;
    let names = summary.channels.iter().map(|channel| channel.name.as_str());
    let first: Vec<&str> = names.take(FIRST).collect();
    let more = summary.channels.len() - first.len();
    let first = first.join(", ");
    if more > 0 {
        format!("{first} and {more} more")
    } else {
        first
    }
}

fn count(findings: &[Finding]) -> String {
    let warnings = (findings.iter())
        .filter(|finding| finding.severity == Severity::Warning)
        .count();
    let notes = findings.len() - warnings;
    let words = [(warnings, "warning"), (notes, "note")];
    let words = words.into_iter().filter(|(count, _)| *count > 0);
    let words = words.map(|(count, word)| {
        let plural = if count == 1 { "" } else { "s" };
        format!("{count} {word}{plural}")
    });
    words.collect::<Vec<_>>().join(", ")
}
