//! The page of one job: outcome, parameter table, fit, and time histories.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::figure::history_svg;
use super::study::study_section;
use super::style::CSS;
use crate::estimate::study::DerivativeStudy;
use crate::estimate::{
    Estimate, FilterEstimate, Measure, Mode, OutputFit, Role, TimeHistory, five_digits as number,
};
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
    /// Of a derivative study.
    pub study: Option<&'a DerivativeStudy>,
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
                    @if let Some(filter) = &estimate.filter {
                        h2 { "Process noise" }
                        div.scroll { (process_noise_table(filter)) }
                    }
                    h2 { "Fit" }
                    div.scroll { (output_table(&estimate.outputs)) }
                    @if !estimate.modes.is_empty() {
                        h2 { "Modes" }
                        div.scroll { (mode_table(&estimate.modes)) }
                    }
                    @for prediction in &estimate.prediction {
                        h2 { "Prediction of segment " (prediction.segment) }
                        p { (prediction.reason) }
                        div.scroll { (output_table(&prediction.outputs)) }
                    }
                }
                @if let Some(study) = view.study { (study_section(study)) }
                @for history in view.histories {
                    h2 { "Time histories, segment " (history.segment) @if history.role == Role::Validation { " (predicted)" } }
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
            None => { p role="status" id="state" data-job=(view.id) { strong { (view.status.name()) } } }
        }
        @if !view.faults.is_empty() {
            ul { @for fault in view.faults { li { code { (fault.pointer) } " " (fault.message) } } }
        }
        @for remark in view.estimate.map(Estimate::remarks).unwrap_or_default() {
            p { strong { "Note: " } (remark) }
        }
        @for finding in view.findings {
            p { strong { "Note: " } (finding.message) "; " (finding.remedy) }
        }
        @if !view.status.is_over() {
            // the log says when there is something new to show
            script src="/assets/follow.js" {}
        }
    }
}

fn parameter_table(estimate: &Estimate) -> Markup {
    html! {
        table {
            thead { tr {
                th { "parameter" } th { "unit" } th.number { "start" } th.number { "estimate" }
                th.number { "standard error" } th.number { "if residuals were white" } th { "" }
            } }
            tbody {
                @for parameter in &estimate.parameters {
                    tr {
                        td { (parameter.name) @if let Some(segment) = &parameter.segment { " [" (segment) "]" } }
                        td.soft { (parameter.unit) }
                        td.number.soft { (number(parameter.start)) }
                        td.number { (number(parameter.estimate)) }
                        td.number { @if let Some(error) = parameter.standard_error { (number(error)) } }
                        td.number.soft { @if let Some(error) = parameter.conventional_standard_error { (number(error)) } }
                        td.soft { (estimate.remark(parameter)) }
                    }
                }
            }
        }
    }
}

fn process_noise_table(filter: &FilterEstimate) -> Markup {
    html! {
        table {
            thead { tr {
                th { "state" } th { "unit" } th.number { "start" } th.number { "intensity" }
                th.number { "standard error" } th { "" }
            } }
            tbody {
                @for noise in &filter.process_noise {
                    tr {
                        td { (noise.state) } td.soft { (noise.unit) }
                        td.number.soft { (number(noise.start)) } td.number { (number(noise.estimate)) }
                        td.number { @if let Some(error) = noise.standard_error { (number(error)) } }
                        td.soft { (noise.remark()) }
                    }
                }
            }
        }
        p.soft { "Outputs are predicted from sample to sample by a Kalman filter; residuals are innovations." }
    }
}

fn output_table(outputs: &[OutputFit]) -> Markup {
    html! {
        table {
            thead { tr {
                th { "output" } th { "unit" } th.number { "rms residual" } th.number { "mean residual" }
                th.number { "R²" } th.number { "Theil" } th.number { "of which bias" } th.number { "variance" } th.number { "covariance" }
                th.number { "lag-1 autocorrelation" } th.number { "effective samples" }
            } }
            tbody {
                @for output in outputs {
                    tr {
                        td { (output.name) } td.soft { (output.unit) }
                        td.number { (number(output.rms)) } td.number { (number(output.bias)) }
                        td.number { (format!("{:.4}", output.r_squared)) } td.number { (format!("{:.4}", output.theil)) }
                        @let shares = output.theil_shares;
                        @for share in [shares.bias, shares.variance, shares.covariance] {
                            td.number.soft { (format!("{share:.2}")) }
                        }
                        td.number { (format!("{:.2}", output.autocorrelation)) }
                        td.number { (format!("{:.0}", output.effective_samples)) }
                    }
                }
            }
        }
    }
}

fn mode_table(modes: &[Mode]) -> Markup {
    let text = |measure: Option<Measure>| measure.map(|m| m.to_string()).unwrap_or_default();
    html! {
        table {
            thead { tr {
                th { "mode" } th.number { "eigenvalue, 1/s" } th.number { "frequency, rad/s" } th.number { "damping ratio" }
                th.number { "period, s" } th.number { "time constant, s" } th.number { "to half, s" } th.number { "to double, s" } th { "" }
            } }
            tbody {
                @for mode in modes {
                    tr {
                        td { (mode.label()) } td.number { (mode.eigenvalue()) }
                        td.number { (text(mode.natural_frequency)) } td.number { (text(mode.damping_ratio)) }
                        td.number { (text(mode.period)) } td.number { (text(mode.time_constant)) }
                        td.number { (text(mode.time_to_half)) } td.number { (text(mode.time_to_double)) }
                        td.soft { (mode.remark) }
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
            li { a href={ (base) "/residual-analysis" } { "residual analysis (JSON)" } }
            li { a href={ (base) "/estimate" } { "estimate (JSON)" } }
            li { a href={ (base) "/model" } { "model" } }
            @if view.study.is_some() { li { a href={ (base) "/derivative-study" } { "derivative study (JSON)" } } }
            li { a href="/docs" { "API" } }
        }
    }
}
