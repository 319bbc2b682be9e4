//! The page of all jobs: what waits, what runs, and what came of the rest.

use maud::{Markup, html};

use super::layout::{Frame, page};
use super::search::search_field;
use crate::estimate::FitSummary;
use crate::job::{JobKind, Status};

/// What the page shows.
pub struct JobsView {
    /// Newest first.
    pub jobs: Vec<JobRow>,
    pub chosen: Chosen,
    /// The address of the page of older ones.
    pub older: Option<String>,
}

/// A job in a line.
pub struct JobRow {
    pub id: String,
    /// Its name, or else its model and maneuvers.
    pub title: String,
    /// Its model and maneuvers, where it has a name of its own.
    pub about: String,
    /// As the API names it.
    pub kind: String,
    pub tags: Vec<String>,
    pub status: Status,
    /// RFC 3339, UTC.
    pub created: String,
    /// Seconds from the first claim to the end, or to now.
    pub seconds: Option<f64>,
    /// Whether there is an estimate to compare.
    pub has_result: bool,
    /// How well the output is reproduced that is reproduced worst.
    pub fit: Option<FitSummary>,
    /// Findings of the result that are warnings or worse.
    pub warnings: usize,
    /// The reason in a line.
    pub outcome: String,
    /// Why the solver stopped, or what failed.
    pub reason: String,
}

/// Which jobs are shown.
#[derive(Default)]
pub struct Chosen {
    pub status: Option<Status>,
    pub kind: Option<JobKind>,
    pub tag: String,
    /// What is searched for.
    pub q: String,
    /// Not the newest: reached by way of `older`.
    pub is_later_page: bool,
}

impl Chosen {
    fn is_everything(&self) -> bool {
        self.status.is_none()
            && self.kind.is_none()
            && self.tag.is_empty()
            && self.q.is_empty()
            && !self.is_later_page
    }
}

/// The whole page as HTML.
pub fn jobs_page(view: &JobsView) -> String {
    let content = html! {
        div.row.center {
            h1 { "Jobs" }
            a.button.main href="/new" { "New job" }
        }
        @if view.jobs.is_empty() && view.chosen.is_everything() {
            (first_visit())
        } @else {
            (filters(&view.chosen))
            p.soft id="live" role="status" {}
            div.row.center id="ticked" hidden {
                span role="status" {}
                a.button href="/" { "Compare" }
                button.link type="button" { "Untick all" }
            }
            div id="jobs" data-live=(!view.chosen.is_later_page) { (table(view)) }
        }
    };
    let frame = Frame {
        title: "Jobs",
        under: "/",
        scripts: &["jobs.js"],
    };
    page(&frame, &content)
}

fn first_visit() -> Markup {
    html! {
        p { "Nothing has been estimated here yet. A job fits a model of the aircraft to recorded maneuvers by the output-error method, and can find what the model lacks." }
        ol {
            li { "Upload a recorded maneuver, as CSV, MAT or JSON." }
            li { "Choose a model, and submit." }
            li { "Look at the parameters, the fit, and what is left over." }
        }
        div.row {
            a.button.main href="/maneuvers" { "Upload a maneuver" }
            button type="button" id="examples" { "Try it with flights that come with Trimtab" }
        }
        p.soft id="live" role="status" {}
    }
}

fn filters(chosen: &Chosen) -> Markup {
    html! {
        form.row method="get" action="/" role="search" aria-label="Search jobs" {
            (search_field(&chosen.q, "name, tag, model or maneuver"))
            label { "Status"
                select name="status" {
                    option value="" { "any" }
                    @for status in Status::ALL {
                        option value=(status.name()) selected[chosen.status == Some(status)] { (status.name()) }
                    }
                }
            }
            label { "Kind"
                select name="kind" {
                    option value="" { "any" }
                    @for kind in JobKind::ALL {
                        option value=(kind.name()) selected[chosen.kind == Some(kind)] { (kind_text(kind.name())) }
                    }
                }
            }
            label { "Tag" input name="tag" value=(chosen.tag) autocomplete="off"; }
            button { "Search" }
            @if !chosen.is_everything() { a href="/" { "Show all" } }
        }
    }
}

fn table(view: &JobsView) -> Markup {
    html! {
        @if view.jobs.is_empty() {
            p { "No job matches." }
        } @else {
            div.scroll tabindex="0" role="region" aria-label="Jobs" {
                table {
                    thead { tr {
                        td { input type="checkbox" id="tick-all" aria-label="compare all jobs of this list"; } th scope="col" { "job" } th scope="col" { "kind" } th scope="col" { "state" }
                        th scope="col" { "submitted" } th.number scope="col" { "time, s" }
                        th.number scope="col" { "lowest R²" } th.number scope="col" { "warnings" } th scope="col" { "outcome" }
                    } }
                    tbody {
                        @for job in &view.jobs {
                            tr {
                                td { @if job.has_result { input type="checkbox" data-tick=(job.id) aria-label={ "compare " (job.title) }; } }
                                th.names scope="row" {
                                    a href={ "/jobs/" (job.id) } { (job.title) }
                                    @for tag in &job.tags { " " span.soft { "#" (tag) } }
                                    @if !job.about.is_empty() { br; span.soft { (job.about) } }
                                }
                                td { (kind_text(&job.kind)) }
                                td { (badge(job.status)) }
                                td { (moment(&job.created)) }
                                td.number { @if let Some(seconds) = job.seconds { (duration(seconds)) } }
                                td.number { @if let Some(fit) = &job.fit { (fit_text(fit)) } }
                                td.number { @if job.warnings > 0 { (job.warnings) } }
                                td.soft.words title=(job.reason) { (job.outcome) }
                            }
                        }
                    }
                }
            }
        }
        @if let Some(older) = &view.older { p { a href=(older) rel="next" { "Older jobs" } } }
    }
}

/// A kind in a word for people.
pub(super) fn kind_text(kind: &str) -> &str {
    match kind {
        "diagnose" => "diagnosis",
        "derivative_study" => "derivative study",
        "structure" => "structure determination",
        _ => kind,
    }
}

/// A job's status, told by word and colour.
pub(super) fn badge(status: Status) -> Markup {
    html! { span class={ "state " (status.name()) } { (status.name()) } }
}

/// A moment, which the browser may show in the reader's own time.
pub(super) fn moment(text: &str) -> Markup {
    let plain = text.replace('T', " ");
    let plain = plain.split('.').next().unwrap_or_default();
    html! { time datetime=(text) { (plain) } }
}

/// The lowest R², with the output that has it.
fn fit_text(fit: &FitSummary) -> String {
    match fit.r_squared {
        Some(r_squared) => format!("{r_squared:.4} ({})", fit.output),
        None => String::new(),
    }
}

/// Seconds with as many digits as matter.
fn duration(seconds: f64) -> String {
    if seconds < 10.0 {
        format!("{seconds:.2}")
    } else {
        format!("{seconds:.0}")
    }
}
