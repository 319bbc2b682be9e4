//! The page of some jobs side by side: parameters, modes, time histories, and parameters over a condition.

use maud::{Markup, html};

use super::conditions::{self, Chosen, Offered};
use super::eigenvalues;
use super::error_bars::{ErrorBars, Point};
use super::estimate_tables::mode_table;
use super::layout::{Frame, page};
use super::palette::{colour, number_of};
use crate::estimate::Mode;
use crate::flight::{Shown, shown_in, with_error};
use crate::job::{Campaign, ComparedJob, ComparedParameter, ComparedValue, Comparison};

/// What the page shows.
pub struct CompareView {
    pub comparison: Comparison,
    /// What these jobs say together, over the chosen condition or as weighted means.
    pub campaign: Campaign,
    pub offered: Offered,
    pub chosen: Chosen,
}

/// A difference beyond so many standard errors is marked.
const FAR: f64 = 3.0;

/// The whole page as HTML.
pub fn compare_page(view: &CompareView) -> String {
    let comparison = &view.comparison;
    let ids: Vec<&str> = comparison.jobs.iter().map(|job| job.job.as_str()).collect();
    let content = html! {
        h1 { "Compare jobs" }
        (jobs(comparison, &view.chosen, &ids))
        (dependence(comparison))
        h2 id="parameters" { "Parameters" }
        p.soft { "Each with its standard error, below it the difference from the first job in standard errors of independent estimates, √(σ² + σ₁²); beyond " (FAR) " in bold." }
        (parameters(comparison))
        (bars(comparison))
        (modes(&comparison.jobs))
        h2 id="histories" { "Measured and model" }
        p.soft { "Dots are measured, lines are models, each in the colour of its job. Segments with the same samples of the same outputs share one plot. Of the others the first of each job stand in one, then the second, and so on, each from 0 s." }
        div id="compared" data-loading="true" data-jobs=(ids.join(",")) {}
        (conditions::section(&view.campaign, &view.offered, &view.chosen, &ids))
        h2 { "Downloads" }
        ul.links {
            li { a href={ "/v1/compare?jobs=" (ids.join(",")) "&format=csv" } { "comparison (CSV)" } }
            li { a href={ "/v1/compare?jobs=" (ids.join(",")) } { "comparison (JSON)" } }
        }
    };
    let frame = Frame {
        title: "Compare jobs",
        under: "/",
        scripts: &["compare.js"],
    };
    page(&frame, &content)
}

fn jobs(comparison: &Comparison, chosen: &Chosen, ids: &[&str]) -> Markup {
    let without = |at: usize| {
        let kept = ids.iter().enumerate().filter(|(other, _)| *other != at);
        let kept: Vec<&str> = kept.map(|(_, id)| *id).collect();
        conditions::address("/compare", chosen, &kept)
    };
    html! {
        div.scroll tabindex="0" role="region" aria-label="Jobs that are compared" { table {
            thead { tr { th scope="col" { "no." } th scope="col" { "job" } th.number scope="col" { "lowest R²" } th scope="col" { "outcome" } @if ids.len() > 2 { td {} } } }
            tbody { @for (at, job) in comparison.jobs.iter().enumerate() { tr {
                td { (number_of(at)) }
                th.names scope="row" { a href={ "/jobs/" (job.job) } { (job.name) } }
                td.number { @if let Some(fit) = &job.fit { @if let Some(r_squared) = fit.r_squared { (format!("{r_squared:.4}")) " (" (fit.output) ")" } } }
                td.soft.words { (job.reason) }
                @if ids.len() > 2 { td { a href=(without(at)) aria-label={ "leave out job " (at + 1) } { "leave out" } } }
            } } }
        } }
    }
}

/// Which jobs are not independent of each other.
fn dependence(comparison: &Comparison) -> Markup {
    let pairs = comparison.dependent_pairs().into_iter();
    let pairs: Vec<String> = pairs
        .map(|(one, other)| format!("{one} and {other}"))
        .collect();
    html! {
        @if !pairs.is_empty() {
            p.note {
                "Jobs " (pairs.join(", ")) " were fitted to samples of the same recording: they are not independent, and √(σ² + σ₁²) is not the standard error of their difference."
            }
        }
    }
}

fn parameters(comparison: &Comparison) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-labelledby="parameters" { table {
            thead { tr {
                th scope="col" { "parameter" } th scope="col" { "unit" }
                @for (at, job) in comparison.jobs.iter().enumerate() { th.number scope="col" title=(job.name) { (number_of(at)) } }
            } }
            tbody { @for row in &comparison.parameters {
                @let Shown { scale, unit } = shown_in(&row.unit);
                tr {
                    th scope="row" { (row.parameter) } td.soft { (unit) }
                    @for value in &row.values { td.number { @if let Some(value) = value { (cell(value, scale)) } } }
                }
            } }
        } }
    }
}

fn cell(value: &ComparedValue, scale: f64) -> Markup {
    let text = match value.standard_error {
        Some(error) => with_error(value.estimate * scale, error * scale),
        None => crate::estimate::five_digits(value.estimate * scale),
    };
    html! {
        (text)
        @if let Some(deviation) = value.deviation {
            br; @if deviation.abs() > FAR { strong { (format!("{deviation:+.1}")) } } @else { span.soft { (format!("{deviation:+.1}")) } }
            @if value.is_independent == Some(false) { span.soft title="not independent: samples in common" { "*" } }
        }
        @if !value.remark.is_empty() { br; span.soft { (value.remark) } }
    }
}

/// A small figure for each parameter that two jobs have.
fn bars(comparison: &Comparison) -> Markup {
    let several = |row: &&ComparedParameter| row.values.iter().flatten().count() > 1;
    html! {
        p.soft { "Error bars of 2 standard errors:" }
        div.tiles {
            @for row in comparison.parameters.iter().filter(several) {
                @let bars = bars_of(row);
                figure data-values=(bars.table()) {
                    figcaption { (row.parameter) " [" (shown_in(&row.unit).unit) "]" }
                    (bars.drawn())
                }
            }
        }
    }
}

fn bars_of(row: &ComparedParameter) -> ErrorBars {
    let Shown { scale, unit } = shown_in(&row.unit);
    let there = row.values.iter().enumerate();
    let there = there.filter_map(|(job, value)| Some((job, value.as_ref()?)));
    let points = there.enumerate().map(|(place, (job, value))| Point {
        x: place as f64,
        value: value.estimate * scale,
        error: value.standard_error.map(|error| error * scale),
        ends: None,
        series: job,
        is_outlier: false,
    });
    ErrorBars {
        label: format!(
            "{} in {unit} of each job with error bars; the table has the numbers",
            row.parameter
        ),
        along: None,
        places: "job",
        points: points.collect(),
        curve: Vec::new(),
    }
}

fn modes(jobs: &[ComparedJob]) -> Markup {
    let sets: Vec<(String, &str, &[Mode])> = (jobs.iter().enumerate())
        .map(|(at, job)| ((at + 1).to_string(), colour(at), job.modes.as_slice()))
        .collect();
    html! {
        @if jobs.iter().any(|job| !job.modes.is_empty()) {
            h2 id="modes" { "Modes" }
            (eigenvalues::plane_of_several(&sets))
            @for (at, job) in jobs.iter().enumerate().filter(|(_, job)| !job.modes.is_empty()) {
                details {
                    summary { "Modes of " (number_of(at)) " " (job.name) }
                    div.scroll tabindex="0" role="region" aria-label={ "modes of job " (at + 1) } { (mode_table(&job.modes)) }
                }
            }
        }
    }
}
