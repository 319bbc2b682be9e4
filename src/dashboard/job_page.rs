//! The page of one job: outcome, parameter table, fit, and time histories.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::figure::history_svg;
use super::style::CSS;
use crate::estimate::{Estimate, TimeHistory, five_digits as number};
use crate::flight::Finding;
use crate::job::{Fault, Status};

/// What the page shows.
pub struct JobView<'a> {
    pub id: &'a str,
    pub name: &'a str,
    pub model: &'a str,
    pub status: Status,
    /// Why it failed.
    pub faults: &'a [Fault],
    /// What is odd about the data in use.
    pub findings: &'a [Finding],
    pub estimate: Option<&'a Estimate>,
    pub histories: &'a [TimeHistory],
}

/// The whole page as HTML.
pub fn job_page(view: &JobView<'_>) -> String {
    let title = if view.name.is_empty() {
        view.model
    } else {
        view.name
    };
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) " - Trimtab" }
                style { (PreEscaped(CSS)) }
            }
            body {
                h1 { (title) }
                p.soft { "model " (view.model) ", job " (view.id) }
                (state(view))
                @if let Some(estimate) = view.estimate {
                    h2 { "Parameters" }
                    div.scroll { (parameter_table(estimate)) }
                    h2 { "Fit" }
                    div.scroll { (output_table(estimate)) }
                }
                @for history in view.histories {
                    h2 { "Time histories, segment " (history.segment) }
                    figure role="img" aria-label={ "measured and model outputs of segment " (history.segment) } {
                        @match history_svg(history) {
                            Ok(svg) => { (PreEscaped(svg)) }
                            Err(error) => { p { "The figure could not be drawn: " (error) } }
                        }
                    }
                }
                (links(view))
            }
        }
    };
    page.into_string()
}

fn state(view: &JobView<'_>) -> Markup {
    html! {
        @match view.estimate {
            Some(estimate) => { p role="status" { strong { (view.status.name()) } ": " (estimate.reason) } }
            None => { p role="status" id="state" { strong { (view.status.name()) } } }
        }
        @if !view.faults.is_empty() {
            ul { @for fault in view.faults { li { code { (fault.pointer) } " " (fault.message) } } }
        }
        @for finding in view.findings {
            p { strong { "Note: " } (finding.message) "; " (finding.remedy) }
        }
        @if !view.status.is_over() {
            // the log says when there is something new to show
            script { (PreEscaped(format!(
                "const log = new EventSource('/v1/jobs/{}/events');\
                 const show = event => {{ const i = JSON.parse(event.data);\
                   document.getElementById('state').textContent = 'iteration ' + i.number + ', -ln L ' + i.cost; }};\
                 const search = event => {{ document.getElementById('state').textContent = JSON.parse(event.data).text; }};\
                 log.addEventListener('start', search);\
                 log.addEventListener('iteration', show);\
                 for (const end of ['succeeded', 'failed', 'cancelled']) log.addEventListener(end, () => {{ log.close(); location.reload(); }});",
                view.id
            ))) }
        }
    }
}

fn parameter_table(estimate: &Estimate) -> Markup {
    html! {
        table {
            thead { tr {
                th { "parameter" } th { "unit" } th.number { "start" } th.number { "estimate" }
                th.number { "standard error" } th { "" }
            } }
            tbody {
                @for parameter in &estimate.parameters {
                    tr {
                        td { (parameter.name) @if let Some(segment) = &parameter.segment { " [" (segment) "]" } }
                        td.soft { (parameter.unit) }
                        td.number.soft { (number(parameter.start)) }
                        td.number { (number(parameter.estimate)) }
                        td.number { @if let Some(error) = parameter.standard_error { (number(error)) } }
                        td.soft { (parameter.remark()) }
                    }
                }
            }
        }
    }
}

fn output_table(estimate: &Estimate) -> Markup {
    html! {
        table {
            thead { tr {
                th { "output" } th { "unit" } th.number { "rms residual" } th.number { "mean residual" }
                th.number { "R²" } th.number { "Theil" }
            } }
            tbody {
                @for output in &estimate.outputs {
                    tr {
                        td { (output.name) } td.soft { (output.unit) }
                        td.number { (number(output.rms)) } td.number { (number(output.bias)) }
                        td.number { (format!("{:.4}", output.r_squared)) } td.number { (format!("{:.4}", output.theil)) }
                    }
                }
            }
        }
    }
}

fn links(view: &JobView<'_>) -> Markup {
    let base = format!("/v1/jobs/{}", view.id);
    html! {
        h2 { "Downloads" }
        ul.links {
            li { a href={ (base) "/parameters?format=csv" } { "parameters (CSV)" } }
            li { a href={ (base) "/time-histories?format=csv" } { "time histories (CSV)" } }
            li { a href={ (base) "/estimate" } { "estimate (JSON)" } }
            li { a href={ (base) "/model" } { "model" } }
            li { a href="/docs" { "API" } }
        }
    }
}
