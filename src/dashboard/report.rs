//! The report of a job: one file with everything in it, to be printed, signed and kept.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::assets::STYLE;
use super::estimate_tables::{mode_table, tables};
use super::figure::history_svg;
use super::job_page::{JobView, facts, findings, state};
use super::layout::head;
use super::report_basis::{ReportRecording, channels, model, recordings};
use super::report_method::method;
use super::residual_figures::residual_figures;
use super::study::study_section;
use super::tolerances::tolerances;
use super::{correlation, diagnosis, eigenvalues};
use crate::diagnose::ResidualAnalysis;
use crate::estimate::{Estimate, Role, TimeHistory};
use crate::job::{JobSpec, Maker};
use crate::model::ModelDocument;

/// What the report tells.
pub struct ReportView {
    pub job: JobView,
    pub spec: JobSpec,
    /// As it was estimated; absent without a result.
    pub document: Option<ModelDocument>,
    /// In the order of the spec.
    pub recordings: Vec<ReportRecording>,
    pub histories: Vec<TimeHistory>,
    /// Of the flights that were fitted.
    pub residuals: Vec<ResidualAnalysis>,
    /// Absent of a result that was made before it was recorded.
    pub made_by: Option<Maker>,
    /// Of the service, so that links lead somewhere when the file is elsewhere.
    pub origin: String,
    /// When the report was written, RFC 3339.
    pub written: String,
}

/// The whole file as HTML.
pub fn report(view: &ReportView) -> String {
    let job = &view.job;
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                (head(&format!("Report: {}", job.title)))
                base href=(view.origin);
                style { (PreEscaped(STYLE)) (PreEscaped(running_title(job))) }
            }
            body.report {
                main {
                    p.soft { "Parameter estimation report, Trimtab" }
                    h1 { (job.title) }
                    (facts(job))
                    (state(job))
                    p.row.actions {
                        a href={ "/jobs/" (job.id) } { "The job's page" }
                        a href={ "/jobs/" (job.id) "/report" } download={ "trimtab-" (job.id) ".html" } { "Save as a file" }
                    }
                    (findings(job))
                    @if let Some(found) = &job.diagnosis { (diagnosis::story(found, &html! {})) }
                    @if let Some(estimate) = &job.estimate { (result(view, estimate)) }
                    @if let Some(study) = &job.study { (study_section(study)) }
                    @if let Some(document) = &view.document {
                        (model(document))
                        (channels(&view.spec, document, &view.recordings))
                    }
                    (recordings(&view.recordings))
                    (method(&view.spec, job.estimate.as_ref()))
                    (provenance(view))
                    (signatures())
                }
            }
        }
    };
    page.into_string()
}

/// What stands at the top of each printed page.
fn running_title(job: &JobView) -> String {
    // as a string of CSS: all but plain characters by their numbers
    let plain = |c: char| c.is_alphanumeric() || " .,:+-/()".contains(c);
    let title: String = (job.title.chars().take(90))
        .map(|c| {
            if plain(c) {
                c.to_string()
            } else {
                format!("\\{:x} ", c as u32)
            }
        })
        .collect();
    format!(
        "@page {{ @top-left {{ content: \"{title}\"; }} @top-right {{ content: \"job {}\"; }} }}",
        job.id
    )
}

fn result(view: &ReportView, estimate: &Estimate) -> Markup {
    html! {
        (tables(estimate, [&source(view, "parameters"), &source(view, "estimate")]))
        // what a reconstruction computes is recorded motion, and no response
        @if !estimate.modes.is_empty() { (tolerances(&view.histories)) }
        @for history in &view.histories {
            section.whole {
                h2 { "Measured and model: " (history.segment) @if history.role != Role::Estimation { " (" (diagnosis::part(history.role)) ")" } }
                (source(view, "time-histories"))
                figure.paper role="img" aria-label={ "measured and model outputs of " (history.segment) } {
                    @match history_svg(history) {
                        Ok(svg) => { (PreEscaped(svg)) }
                        Err(error) => { p { "The figure could not be drawn: " (error) } }
                    }
                }
            }
        }
        h2 { "Residuals" }
        (source(view, "residual-analysis"))
        (residual_figures(&view.residuals))
        @if !estimate.modes.is_empty() {
            h2 id="modes" { "Modes" }
            (eigenvalues::plane(&estimate.modes))
            div.scroll tabindex="0" role="region" aria-labelledby="modes" { (mode_table(&estimate.modes)) }
        }
        section.whole {
            h2 { "Correlation of the estimates" }
            (correlation::map(estimate))
        }
    }
}

/// Where the numbers that follow come from.
fn source(view: &ReportView, resource: &str) -> Markup {
    let path = format!("/v1/jobs/{}/{resource}", view.job.id);
    html! { p.soft { "From " a href=(path) { (path) } } }
}

fn provenance(view: &ReportView) -> Markup {
    html! {
        h2 { "Provenance" }
        (source(view, "provenance"))
        dl.facts {
            @for maneuver in &view.job.maneuvers {
                dt { (maneuver.label) } dd { "SHA-256 " code { (maneuver.id) } }
            }
            @if let Some(maker) = &view.made_by {
                dt { "program" } dd { "Trimtab " (maker.version) ", SHA-256 " code { (maker.program) } }
                dt { "processor" } dd { (maker.architecture) ", " (maker.vector_instructions) }
            }
            dt { "written" } dd { (view.written) }
        }
    }
}

/// Who answers for it.
fn signatures() -> Markup {
    html! {
        section.whole.signatures {
            h2 id="signatures" { "Signatures" }
            div.scroll tabindex="0" role="region" aria-labelledby="signatures" { table {
                thead { tr { td {} th scope="col" { "name" } th scope="col" { "date" } th scope="col" { "signature" } } }
                tbody { @for who in ["Prepared by", "Checked by", "Approved by"] { tr { th scope="row" { (who) } td {} td {} td {} } } }
            } }
        }
    }
}
