//! The page of one job: how it goes while it runs, and what came of it.

use maud::{Markup, html};

use super::estimate_tables::{mode_table, tables};
use super::jobs_page::{badge, kind_text, moment};
use super::layout::{Frame, page};
use super::study::study_section;
use super::{correlation, diagnosis, eigenvalues};
use crate::diagnose::Diagnosis;
use crate::estimate::study::DerivativeStudy;
use crate::estimate::{Estimate, Role};
use crate::flight::{Finding, FindingCode, Severity};
use crate::job::{Fault, Status};

/// What the page shows.
pub struct JobView {
    pub id: String,
    /// Its name, or else its model and maneuvers.
    pub title: String,
    /// As the API names it.
    pub kind: String,
    pub model: NamedModel,
    pub maneuvers: Vec<UsedManeuver>,
    pub tags: Vec<String>,
    pub status: Status,
    /// RFC 3339, UTC.
    pub created: String,
    /// When a worker first took it.
    pub started: Option<String>,
    /// When the page was made.
    pub now: String,
    /// At which length of step, in standard errors, the solver stops.
    pub tolerance: f64,
    pub attempt: u32,
    /// Why it failed.
    pub faults: Vec<Fault>,
    /// What is odd about the data in use, and of a result all that a reader should know.
    pub findings: Vec<Finding>,
    pub estimate: Option<Estimate>,
    /// Of a derivative study.
    pub study: Option<DerivativeStudy>,
    /// Of a diagnosis.
    pub diagnosis: Option<Diagnosis>,
}

/// The model that a job names, or holds.
#[derive(Clone)]
pub struct NamedModel {
    pub name: String,
    pub place: ModelPlace,
}

/// Where the model of a job is.
#[derive(Clone)]
pub enum ModelPlace {
    /// Under `/models/`, by this id.
    Kept(String),
    /// It was stored, and deleted since.
    Deleted,
    /// In the job alone.
    InTheJob,
}

/// A maneuver that a job uses.
#[derive(Clone)]
pub struct UsedManeuver {
    pub id: String,
    pub label: String,
    pub role: Role,
}

/// The whole page as HTML.
pub fn job_page(view: &JobView) -> String {
    let content = html! {
        div id="job" data-job=(view.id) data-kind=(view.kind) data-over=(view.status.is_over())
            data-result=(view.estimate.is_some()) data-now=(view.now) data-started=[view.started.as_deref()] data-tolerance=(view.tolerance) {
            h1 { (view.title) }
            (facts(view))
            (state(view))
            (actions(view))
            @if view.status.is_over() { (findings(view)) } @else { (progress(view)) }
            @if let Some(diagnosis) = &view.diagnosis { (diagnosis::story(diagnosis, &explained())) }
            @if let Some(estimate) = &view.estimate { (result(view, estimate)) }
            @if let Some(study) = &view.study { (study_section(study)) }
            @if view.estimate.is_some() { (downloads(view)) }
        }
    };
    let frame = Frame {
        title: &view.title,
        under: "/",
        scripts: &["job.js"],
    };
    page(&frame, &content)
}

pub(super) fn facts(view: &JobView) -> Markup {
    html! {
        dl.facts {
            dt { "job" } dd { (kind_text(&view.kind)) " " code { (view.id) } }
            dt { "model" } dd {
                @match &view.model.place {
                    ModelPlace::Kept(id) => { a href={ "/models/" (id) } { (view.model.name) } }
                    ModelPlace::Deleted => { (view.model.name) " (deleted since; the job keeps its copy)" }
                    ModelPlace::InTheJob => { (view.model.name) " (written out in the job)" }
                }
            }
            dt { "maneuvers" } dd {
                @for (at, maneuver) in view.maneuvers.iter().enumerate() {
                    @if at > 0 { ", " }
                    a href={ "/maneuvers/" (maneuver.id) } { (maneuver.label) }
                    @if maneuver.role != Role::Estimation { " (" (diagnosis::part(maneuver.role)) ")" }
                }
            }
            dt { "submitted" } dd {
                (moment(&view.created))
                @if view.attempt > 1 { ", taken " (view.attempt) " times: a worker was lost or shut down" }
                @for tag in &view.tags { " " span.soft { "#" (tag) } }
            }
        }
    }
}

/// How it went, in words.
pub(super) fn state(view: &JobView) -> Markup {
    html! {
        p { (badge(view.status)) " "
            span id="state" role="status" { @if let Some(estimate) = &view.estimate { (estimate.reason) } }
        }
        @if !view.faults.is_empty() {
            div.note {
                ul { @for fault in &view.faults { li { code { (fault.pointer) } " " (fault.message) } } }
            }
        }
    }
}

fn actions(view: &JobView) -> Markup {
    html! {
        div.row.center.actions {
            @if view.status.is_over() {
                @if view.estimate.is_some() {
                    a.button.main href={ "/jobs/" (view.id) "/report" } { "Report" }
                }
                @if view.kind == "estimate" && view.estimate.is_some() {
                    button type="button" data-act="diagnose" { "Find what the model lacks" }
                }
                a.button href={ "/new?like=" (view.id) } { "New job like this" }
                button type="button" data-act="rerun" { "Run again" }
            } @else {
                button type="button" data-act="cancel" { "Cancel" }
            }
            span id="acted" role="status" {}
        }
    }
}

/// What a reader of the numbers should know before them.
pub(super) fn findings(view: &JobView) -> Markup {
    let of = |severity: Severity| {
        // a diagnosis tells its remarks itself
        let all = (view.findings.iter()).filter(|f| f.code != FindingCode::DiagnosisRemark.name());
        all.filter(move |finding| finding.severity == severity)
    };
    html! {
        @for severity in [Severity::Fault, Severity::Warning] {
            @for finding in of(severity) {
                p.note data-code=(finding.code) { strong { (lead(severity)) ": " } (finding.sentence()) }
            }
        }
        @if of(Severity::Note).next().is_some() {
            details {
                summary { "Notes" }
                ul {
                    @for finding in of(Severity::Note) {
                        li data-code=(finding.code) { (finding.sentence()) }
                    }
                }
            }
        }
    }
}

fn lead(severity: Severity) -> &'static str {
    match severity {
        Severity::Fault => "Not to be used as it is",
        Severity::Warning => "Warning",
        Severity::Note => "Note",
    }
}

/// Residuals over time, before and after, in a flight that took no part where there is one.
fn explained() -> Markup {
    html! {
        h3 { "What the effects explain" }
        div id="explained" data-loading="true" {}
    }
}

fn progress(view: &JobView) -> Markup {
    html! {
        section aria-labelledby="now" {
            h2 id="now" { "Progress" }
            p id="connection" role="status" {}
            p.soft { span id="elapsed" {} }
            div id="way" hidden { progress aria-label="progress" max="1" value="0" {} " " span {} }
            ol id="steps" reversed hidden {}
            @if has_course(view) { (course()) }
        }
    }
}

fn result(view: &JobView, estimate: &Estimate) -> Markup {
    html! {
        h2 id="histories" { "Measured and model" }
        p.soft { "Drag to look closer, double-click for the whole. All plots share the time axis." }
        div id="histories-plots" data-loading="true" {}
        (tables(estimate, [&html! {}, &html! {}]))
        h2 { "Residuals" }
        p.soft { "White residuals leave nothing to explain: no bar beyond the band, and a flat spectrum." }
        div id="residuals" data-loading="true" {}
        div.columns {
            @if !estimate.modes.is_empty() {
                section { h2 id="modes" { "Modes" } (eigenvalues::plane(&estimate.modes)) }
            }
            section { h2 id="correlation" { "Correlation of the estimates" } (correlation::map(estimate)) }
        }
        @if !estimate.modes.is_empty() {
            div.scroll tabindex="0" role="region" aria-labelledby="modes" { (mode_table(&estimate.modes)) }
        }
        p { a href={ "/jobs/" (view.id) "/dynamics" } { "Linear system, frequency responses, flying qualities" } }
        h2 { "Course of the iterations" }
        p.soft { (estimate.iterations) " iterations, " (estimate.evaluations) " evaluations with derivatives, " (estimate.simulations) " simulations" }
        @if has_course(view) { (course()) }
    }
}

/// A diagnosis is told by its steps: the iterations of its many fits are not kept.
fn has_course(view: &JobView) -> bool {
    view.kind != "diagnose"
}

fn course() -> Markup {
    html! {
        div.columns {
            figure { figcaption { "cost, -ln L" } div.plot id="cost" role="img" aria-label="cost by iteration" {} }
            figure { figcaption { "change of each parameter since the start, by its largest change" } div.plot id="course" role="img" aria-label="parameters by iteration" {} }
        }
    }
}

fn downloads(view: &JobView) -> Markup {
    let base = format!("/v1/jobs/{}", view.id);
    html! {
        h2 { "Downloads" }
        ul.links {
            li { a href={ (base) "/parameters?format=csv" } { "parameters (CSV)" } }
            li { a href={ (base) "/time-histories?format=csv" } { "time histories (CSV)" } }
            li { a href={ (base) "/residuals?format=csv" } { "residuals (CSV)" } }
            li { a href={ (base) "/trajectories?format=csv" } { "states and definitions with standard errors (CSV)" } }
            li { a href={ (base) "/frequency-response?format=csv" } { "frequency responses with standard errors (CSV)" } }
            li { a href={ (base) "/linear-system" } { "linear system (JSON)" } }
            li { a href={ (base) "/model?format=toml" } { "model as estimated (TOML)" } }
            li { a href={ (base) "/estimate" } { "estimate (JSON)" } }
            li { a href={ (base) "/residual-analysis" } { "residual analysis (JSON)" } }
            @if view.study.is_some() { li { a href={ (base) "/derivative-study" } { "derivative study (JSON)" } } }
            @if view.diagnosis.is_some() { li { a href={ (base) "/diagnosis" } { "diagnosis (JSON)" } } }
            li { a href={ (base) "/provenance" } { "provenance (JSON)" } }
        }
    }
}
