//! The page of one maneuver: what was recorded, and what is odd about it.

use maud::{Markup, html};

use super::jobs_page::moment;
use super::layout::{Frame, page};
use super::maneuvers_page::title;
use crate::estimate::five_digits as number;
use crate::flight::{Finding, Flown, Severity, Shown, shown_in};
use crate::ingest::{ChannelSummary, Summary};

/// What the page shows.
pub struct ManeuverView {
    pub id: String,
    pub name: String,
    /// RFC 3339, UTC.
    pub created: String,
    pub summary: Summary,
    pub flown: Flown,
}

/// Channels that are plotted unless others are asked for.
const PLOTTED: usize = 8;

/// The whole page as HTML.
pub fn maneuver_page(view: &ManeuverView) -> String {
    let ManeuverView { id, summary, .. } = view;
    let title = title(&view.name, id);
    let content = html! {
        div id="maneuver" data-maneuver=(id) data-samples=(summary.samples) data-step=(summary.step) {
            h1 { (title) }
            (facts(view))
            (actions(id, title))
            (flown(&view.flown))
            (findings(&summary.findings))
            h2 { "Over time" }
            (choice(&summary.channels))
            form.row id="stretch" {
                label { "From, s" input type="number" name="from" step="any" required; }
                label { "To, s" input type="number" name="to" step="any" required; }
                button { "Show" }
                button type="reset" { "Show all" }
                span id="stretch-told" role="status" {}
            }
            p.soft id="plotted" role="status" { "Loading ..." }
            figure id="plot" {
                figcaption { "Drag in the plot to zoom, too; double click to see all." }
            }
            h2 { "Channels" }
            (channels(&summary.channels))
        }
    };
    let frame = Frame {
        title,
        under: "/maneuvers",
        scripts: &["maneuver.js"],
    };
    page(&frame, &content)
}

fn facts(view: &ManeuverView) -> Markup {
    let summary = &view.summary;
    html! {
        dl.facts {
            dt { "duration" } dd {
                (number(summary.duration)) " s"
                @if summary.segments > 1 { " in " (summary.segments) " stretches with gaps between them" }
            }
            dt { "samples" } dd { (summary.samples) " at " (number(summary.rate)) " Hz" }
            dt { "channels" } dd { (summary.channels.len()) }
            dt { "uploaded" } dd { (moment(&view.created)) }
            dt { "id" } dd { code { (view.id) } }
        }
    }
}

fn actions(id: &str, title: &str) -> Markup {
    html! {
        div.row.center.actions {
            a.button.main href={ "/new?estimation=" (id) } { "New job with it" }
            a.button href={ "/v1/maneuvers/" (id) "/data?format=csv" } download={ (title) ".csv" } { "Download as CSV" }
            button type="button" id="delete" { "Delete" }
            span id="acted" role="status" {}
        }
        dialog id="sure" aria-labelledby="sure-title" {
            h2 id="sure-title" { "Delete this maneuver?" }
            p { "The recording cannot be brought back. A maneuver that a job uses is not deleted." }
            form.row method="dialog" {
                button value="keep" autofocus { "Keep it" }
                button.main value="delete" { "Delete it" }
            }
        }
    }
}

fn findings(findings: &[Finding]) -> Markup {
    html! {
        h2 { "Quality" }
        @if findings.is_empty() {
            p { "Nothing is odd about the data." }
        } @else {
            ul.findings {
                @for finding in findings {
                    li {
                        (severity(finding.severity)) " "
                        @if let Some(channel) = &finding.channel { strong { (channel) } ": " }
                        (finding.message)
                        div.soft { (finding.remedy) (rows(finding)) }
                    }
                }
            }
        }
    }
}

/// What was flown, as far as it was said.
fn flown(flown: &Flown) -> Markup {
    html! {
        @if !flown.is_empty() {
            h2 { "What was flown" }
            (what_was_flown(flown))
        }
    }
}

/// As a list of names and values.
pub(super) fn what_was_flown(flown: &Flown) -> Markup {
    html! {
        dl.facts {
            @for (name, text) in flown.texts().filter(|(name, _)| *name != "notes") {
                dt { (name.replace('_', " ")) } dd { (text) }
            }
            @for (name, quantity) in flown.quantities() {
                dt { (called(&name)) } dd { (number(quantity.value)) " " (quantity.unit) }
            }
            @if !flown.tags.is_empty() { dt { "tags" } dd { (flown.tags.join(", ")) } }
            @if let Some(notes) = &flown.notes { dt { "notes" } dd { (notes) } }
        }
    }
}

/// What people call a quantity: `centre of gravity x`, `Iy`, `fuel`.
fn called(name: &str) -> String {
    let name = name
        .trim_start_matches("inertia.")
        .trim_start_matches("quantities.");
    match name.strip_prefix("centre_of_gravity.") {
        Some(axis) => format!("centre of gravity {axis}"),
        None => name.to_string(),
    }
}

/// Where it is, as far as that is listed.
fn rows(finding: &Finding) -> String {
    let rows: Vec<String> = finding.rows.iter().map(ToString::to_string).collect();
    let more = if finding.count > rows.len() {
        ", ..."
    } else {
        ""
    };
    match rows.as_slice() {
        [] => String::new(),
        [row] if more.is_empty() => format!(" (row {row})"),
        rows => format!(" (rows {}{more})", rows.join(", ")),
    }
}

fn severity(severity: Severity) -> Markup {
    html! {
        @match severity {
            Severity::Fault => { span.state.failed { "fault" } }
            Severity::Warning => { span.state.failed { "warning" } }
            Severity::Note => { span.state.queued { "note" } }
        }
    }
}

fn choice(channels: &[ChannelSummary]) -> Markup {
    html! {
        fieldset id="choice" {
            legend { "Channels in the plot" }
            div.row.center {
                @for (at, channel) in channels.iter().enumerate() {
                    label.beside { input type="checkbox" value=(channel.name) checked[at < PLOTTED]; (channel.name) }
                }
            }
        }
    }
}

fn channels(channels: &[ChannelSummary]) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label="Channels" {
            table {
                thead { tr {
                    th scope="col" { "channel" } th scope="col" { "unit" }
                    th.number scope="col" { "least" } th.number scope="col" { "greatest" } th.number scope="col" { "mean" }
                    th.number scope="col" { "missing" } th scope="col" { "recorded in" }
                } }
                tbody {
                    @for channel in channels {
                        @let Shown { scale, unit } = shown_in(&channel.si_unit);
                        tr {
                            th scope="row" { (channel.name) }
                            td { (unit) }
                            @for value in [channel.min, channel.max, channel.mean] {
                                td.number { @if let Some(value) = value { (number(value * scale)) } }
                            }
                            td.number { @if channel.missing > 0 { (channel.missing) } }
                            td.soft { (channel.unit) }
                        }
                    }
                }
            }
        }
    }
}
