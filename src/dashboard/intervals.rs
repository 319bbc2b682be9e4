//! Confidence intervals by several methods side by side: as a table, and each parameter as a picture.

use maud::{Markup, html};

use super::error_bars::{ErrorBars, Point};
use super::palette::colour;
use crate::estimate::{
    ConfidenceInterval, ConfidenceIntervals, IntervalMethod, ParameterIntervals,
};
use crate::flight::{Shown, bounded, shown_in};

/// Half the width of a 95 % interval, standard deviations.
const HALF_WIDTH: f64 = 1.96;

/// Everything that was found.
pub(super) fn intervals(found: &ConfidenceIntervals) -> Markup {
    let methods = methods(found);
    html! {
        h2 id="intervals" { "95 % confidence intervals" }
        @if let Some(made_of) = found.made_of() { p.soft { (made_of) } }
        @for remark in &found.remarks { p.note { (remark) } }
        @if !methods.is_empty() {
            div.scroll tabindex="0" role="region" aria-labelledby="intervals" { (table(found, &methods)) }
            (legend(&methods))
            div.tiles {
                @for parameter in &found.parameters {
                    @let bars = bars_of(parameter, &methods);
                    figure data-values=(bars.table()) {
                        figcaption { (parameter.label()) " [" (shown_in(&parameter.unit).unit) "]" }
                        (bars.drawn())
                    }
                }
            }
        }
    }
}

/// In the order of the answer.
fn methods(found: &ConfidenceIntervals) -> Vec<IntervalMethod> {
    let mut methods = Vec::new();
    for interval in found.parameters.iter().flat_map(|of| &of.intervals) {
        if !methods.contains(&interval.method) {
            methods.push(interval.method);
        }
    }
    methods
}

fn of(parameter: &ParameterIntervals, method: IntervalMethod) -> Option<&ConfidenceInterval> {
    parameter.intervals.iter().find(|one| one.method == method)
}

fn table(found: &ConfidenceIntervals, methods: &[IntervalMethod]) -> Markup {
    html! {
        table {
            thead { tr {
                th scope="col" { "parameter" } th scope="col" { "unit" }
                @for method in methods { th.number scope="col" { (method.title()) } }
            } }
            tbody {
                @for parameter in &found.parameters {
                    @let Shown { scale, unit } = shown_in(&parameter.unit);
                    tr {
                        th scope="row" { (parameter.label()) }
                        td.soft { (unit) }
                        @for method in methods {
                            td.number { @if let Some(interval) = of(parameter, *method) { (cell(interval, scale)) } }
                        }
                    }
                }
            }
        }
    }
}

/// Both ends, and below them the standard deviation or the asymmetry, and what else there is to say.
fn cell(interval: &ConfidenceInterval, scale: f64) -> Markup {
    let width = interval.lower.zip(interval.upper).map(|(a, b)| b - a);
    let deviation = interval.standard_deviation.map(|error| error * scale);
    let size = deviation.or_else(|| width.map(|width| 0.5 * width * scale / HALF_WIDTH));
    let end = |value: Option<f64>| match value {
        Some(value) => bounded(value * scale, size)[0].replace('-', "\u{2212}"),
        None => "?".to_string(),
    };
    html! {
        (end(interval.lower)) " to " (end(interval.upper))
        @match (deviation, interval.asymmetry) {
            (Some(error), _) => { br; span.soft { "s.d. " (bounded(0.0, Some(error))[1]) } }
            (None, Some(ratio)) => { br; span.soft { "asymmetry " (format!("{ratio:.2}")) } }
            (None, None) => {}
        }
        @if !interval.remark().is_empty() { br; span.soft { (interval.remark()) } }
    }
}

fn legend(methods: &[IntervalMethod]) -> Markup {
    html! {
        p.soft {
            @for (at, method) in methods.iter().enumerate() {
                span style={ "color:" (colour(at)) } { "\u{25cf}" } " " (at + 1) " " (method.title()) "  "
            }
        }
    }
}

fn bars_of(parameter: &ParameterIntervals, methods: &[IntervalMethod]) -> ErrorBars {
    let Shown { scale, unit } = shown_in(&parameter.unit);
    let there = methods.iter().enumerate();
    let there = there.filter_map(|(at, method)| Some((at, of(parameter, *method)?)));
    let points = there.enumerate().map(|(place, (at, interval))| Point {
        x: place as f64,
        value: parameter.estimate * scale,
        error: None,
        // an end that was not found is not drawn
        ends: Some(
            [interval.lower, interval.upper].map(|end| end.unwrap_or(parameter.estimate) * scale),
        ),
        series: at,
        is_outlier: false,
    });
    ErrorBars {
        label: format!(
            "{} in {unit} with its interval by each method; the table has the numbers",
            parameter.label()
        ),
        along: None,
        places: "method",
        points: points.collect(),
        curve: Vec::new(),
    }
}
