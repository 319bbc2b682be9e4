//! The page of a job's dynamics: linear system, transfer functions, frequency responses, flying qualities.

use maud::{Markup, PreEscaped, html};

use super::bode_figure::bode_svg;
use super::eigenvalues;
use super::estimate_tables::mode_table;
use super::layout::{Frame, page};
use crate::dynamics::{
    Bandwidth, Criterion, EquivalentSystem, FlyingQualities, FrequencyResponse, LinearSystem,
    NamedMatrix, Root, TransferFunction,
};
use crate::estimate::{Measure, five_digits as number};

/// What the page shows.
pub struct DynamicsView {
    /// Of the job.
    pub id: String,
    /// Of the job.
    pub title: String,
    pub system: LinearSystem,
    pub responses: Vec<FrequencyResponse>,
    pub qualities: FlyingQualities,
}

/// Pictures of one page.
const MOST_FIGURES: usize = 24;

/// The whole page as HTML.
pub fn dynamics_page(view: &DynamicsView) -> String {
    let system = &view.system;
    let link = |resource: &str, more: &[(&str, &str)]| link(view, resource, more);
    let table = link("frequency-response", &[("format", "csv")]);
    let content = html! {
        h1 { "Dynamics: " (view.title) }
        p { a href={ "/jobs/" (view.id) } { "The job's page" } }
        p.soft {
            "The estimated model linearised at the start of " (system.segment)
            @if system.is_everywhere { "; it is linear, and the same everywhere" }
            ". Numbers with their standard errors, SI."
        }
        @for remark in system.remarks.iter().chain(&view.qualities.remarks) { p.note { (remark) } }
        @if !system.modes.is_empty() {
            h2 id="modes" { "Modes" }
            (eigenvalues::plane(&system.modes))
            div.scroll tabindex="0" role="region" aria-labelledby="modes" { (mode_table(&system.modes)) }
        }
        (qualities(&view.qualities))
        (responses(&view.responses, &table))
        (functions(&system.transfer_functions))
        (matrices(system))
        h2 { "Downloads" }
        ul.links {
            li { a href=(link("linear-system", &[])) { "linear system (JSON)" } ", " a href=(link("linear-system", &[("format", "mat")])) { "as MAT file" } }
            li { "the model as functions in " a href=(link("source-code", &[("language", "c")])) { "C" } ", " a href=(link("source-code", &[("language", "python")])) { "Python" } ", " a href=(link("source-code", &[("language", "matlab")])) { "MATLAB" } }
            li { a href=(link("simulator-model", &[("format", "fmu")])) { "functional mock-up unit (FMI 2.0)" } ", " a href=(link("simulator-model", &[("format", "jsbsim")])) { "aerodynamics for JSBSim" } }
            li { a href=(link("frequency-response", &[("format", "csv")])) { "frequency responses (CSV)" } }
            li { a href=(link("flying-qualities", &[])) { "flying qualities (JSON)" } }
        }
    };
    let frame = Frame {
        title: &format!("Dynamics: {}", view.title),
        under: "/",
        scripts: &["figures.js"],
    };
    page(&frame, &content)
}

/// A resource of the job, at the start of the segment that the page is of.
fn link(view: &DynamicsView, resource: &str, more: &[(&str, &str)]) -> String {
    let path = format!("/v1/jobs/{}/{resource}?", view.id);
    let mut query = form_urlencoded::Serializer::for_suffix(path.clone(), path.len());
    query.append_pair("segment", &view.system.segment);
    query.extend_pairs(more).finish()
}

fn measured(measure: Option<Measure>) -> String {
    measure
        .map(|measure| measure.to_string())
        .unwrap_or_default()
}

fn qualities(qualities: &FlyingQualities) -> Markup {
    html! {
        h2 id="qualities" { "Flying qualities" }
        @if let Some(parameter) = qualities.control_anticipation_parameter {
            p { "Control anticipation parameter " (parameter) " rad/s² per g, at " (number(qualities.airspeed.unwrap_or_default())) " m/s" }
        }
        @if !qualities.equivalent_systems.is_empty() { (equivalent(&qualities.equivalent_systems)) }
        @if !qualities.bandwidths.is_empty() { (bandwidths(&qualities.bandwidths)) }
        @if !qualities.levels.is_empty() { (levels(&qualities.levels)) }
        @else { p.soft { "Levels: say category of the flight phase and class of the airplane, as in " code { "?category=B&class=II" } "." } }
    }
}

fn equivalent(systems: &[EquivalentSystem]) -> Markup {
    html! {
        h3 id="equivalent" { "Low-order equivalent systems" }
        div.scroll tabindex="0" role="region" aria-labelledby="equivalent" { table {
            thead { tr {
                th scope="col" { "response" } th.number scope="col" { "gain" } th.number scope="col" { "1/T of the numerator, 1/s" } th.number scope="col" { "frequency, rad/s" }
                th.number scope="col" { "damping ratio" } th.number scope="col" { "time constant, s" } th.number scope="col" { "delay, s" } th.number scope="col" { "mismatch" } th.number scope="col" { "band, rad/s" }
            } }
            tbody { @for system in systems { tr {
                th scope="row" { (system.output) "/" (system.input) } td.number { (system.gain) } td.number { (measured(system.numerator_root)) }
                td.number { (measured(system.natural_frequency)) } td.number { (measured(system.damping_ratio)) }
                td.number { (measured(system.time_constant)) } td.number { (system.delay) } td.number { (number(system.mismatch)) }
                td.number { (number(system.band[0])) " to " (number(system.band[1])) }
            } } }
        } }
    }
}

fn bandwidths(bandwidths: &[Bandwidth]) -> Markup {
    html! {
        h3 id="bandwidth" { "Bandwidth and phase delay of attitudes" }
        div.scroll tabindex="0" role="region" aria-labelledby="bandwidth" { table {
            thead { tr {
                th scope="col" { "response" } th.number scope="col" { "bandwidth, rad/s" } th.number scope="col" { "by phase, rad/s" } th.number scope="col" { "by gain, rad/s" }
                th.number scope="col" { "phase is −180° at, rad/s" } th.number scope="col" { "phase delay, s" }
            } }
            tbody { @for row in bandwidths { tr {
                th scope="row" { (row.output) "/" (row.input) } td.number { (measured(row.bandwidth)) } td.number { (measured(row.phase)) }
                td.number { (measured(row.gain)) } td.number { (measured(row.neutral_frequency)) } td.number { (measured(row.phase_delay)) }
            } } }
        } }
    }
}

fn levels(levels: &[Criterion]) -> Markup {
    let level = |level: Option<u8>| level.map_or("none".to_string(), |level| level.to_string());
    html! {
        h3 id="levels" { "Levels" }
        div.scroll tabindex="0" role="region" aria-labelledby="levels" { table {
            thead { tr { th scope="col" { "requirement" } th.number scope="col" { "level" } th scope="col" { "within 2 standard errors" } th scope="col" { "level 1 asks for" } th scope="col" { "source" } } }
            tbody { @for criterion in levels { tr {
                th scope="row" { (criterion.what) } td.number { (level(criterion.level)) }
                td { @if let Some([best, worst]) = criterion.levels_within_2_standard_errors { @if best == worst { (level(best)) } @else { (level(best)) " to " (level(worst)) } } }
                td.soft { (criterion.level_1) } td.soft { (criterion.source) }
            } } }
        } }
    }
}

fn responses(responses: &[FrequencyResponse], table: &str) -> Markup {
    html! {
        h2 { "Frequency responses" }
        p.soft { "With bands of 2 standard errors; delays and lags of signals included." }
        @if responses.iter().any(|response| response.magnitude_db_standard_error.is_empty()) {
            p.note { "Where there is no band a parameter behind the response has no standard error, or the estimate is singular." }
        }
        div.columns {
            @for response in responses.iter().take(MOST_FIGURES) {
                figure.paper data-csv=(only(table, response)) {
                    figcaption { (response.output) " over " (response.input) }
                    div role="img" aria-label={ "magnitude and phase of " (response.output) " over " (response.input) } {
                        @match bode_svg(response) {
                            Ok(svg) => { (PreEscaped(svg)) }
                            Err(error) => { p { "The figure could not be drawn: " (error) } }
                        }
                    }
                }
            }
        }
        @if responses.len() > MOST_FIGURES {
            p { "There are " (responses.len()) " responses: the others are in " a href=(table) { "the table" } "." }
        }
    }
}

/// The table of one response.
fn only(table: &str, response: &FrequencyResponse) -> String {
    let begin = table.find('?').map_or(table.len(), |at| at + 1);
    let mut query = form_urlencoded::Serializer::for_suffix(table.to_string(), begin);
    query.append_pair("input", &response.input);
    query.append_pair("output", &response.output).finish()
}

fn functions(functions: &[TransferFunction]) -> Markup {
    let roots = |roots: &[Root]| {
        let words: Vec<String> = roots.iter().map(ToString::to_string).collect();
        words.join("; ")
    };
    html! {
        h2 id="functions" { "Transfer functions" }
        div.scroll tabindex="0" role="region" aria-labelledby="functions" { table {
            thead { tr { th scope="col" { "from, to" } th.number scope="col" { "gain" } th.number scope="col" { "static gain" } th scope="col" { "zeros, 1/s" } th scope="col" { "poles, 1/s" } th.number scope="col" { "delay, s" } } }
            tbody { @for function in functions { tr {
                th scope="row" { (function.input) " to " (function.output) } td.number { (function.gain) } td.number { (measured(function.static_gain)) }
                td { (roots(&function.zeros)) } td { (roots(&function.poles)) } td.number { (function.delay) }
            } } }
        } }
    }
}

fn matrices(system: &LinearSystem) -> Markup {
    html! {
        h2 { "A, B, C, D" }
        @for of in system.matrices() {
            @if !of.columns.is_empty() { (matrix(&of)) }
        }
    }
}

fn matrix(of: &NamedMatrix<'_>) -> Markup {
    let id = format!("matrix-{}", of.name);
    html! {
        h3 id=(id) { (of.name) }
        div.scroll tabindex="0" role="region" aria-labelledby=(id) { table {
            thead { tr { th scope="col" { "of" } @for column in &of.columns { th.number scope="col" { "by " (column) } } } }
            tbody { @for (at, row) in of.rows.iter().enumerate() { tr {
                th scope="row" { (row) @if matches!(of.name, "A" | "B") { "˙" } }
                @for cell in of.cells(at) {
                    td.number { (cell) }
                }
            } } }
        } }
    }
}
