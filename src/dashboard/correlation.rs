//! The correlation of the estimates as a map: what stands out is what the data cannot tell apart.

use maud::{Markup, html};

use crate::estimate::{Estimate, ParameterEstimate};
use crate::flight::decimals;

/// Of more estimates than these the map is no picture any more.
const MOST: usize = 40;

/// Beyond it two estimates are hard to tell apart.
const HIGH: f64 = 0.9;

/// A table of all pairs, coloured by size and sign.
pub(super) fn map(estimate: &Estimate) -> Markup {
    let free: Vec<&ParameterEstimate> = (estimate.parameters.iter())
        .filter(|parameter| !parameter.fixed)
        .collect();
    let rows = &estimate.correlation;
    let pairs = high_pairs(&free, rows);
    html! {
        @if rows.is_empty() || rows.len() != free.len() {
            p.soft { "There is none: no minimum was reached, or nothing was free." }
        } @else {
            @if pairs.is_empty() {
                p { "No pair is correlated beyond " (HIGH) "." }
            } @else {
                p { "Correlated beyond " (HIGH) ": " (pairs.join(", ")) "." }
            }
            @if rows.len() <= MOST {
                div.scroll tabindex="0" role="region" aria-label="Correlation of the estimates" {
                    table.map {
                        thead { tr { td {} @for parameter in &free { th scope="col" { (label(parameter)) } } } }
                        tbody {
                            @for (at, (parameter, row)) in free.iter().zip(rows).enumerate() {
                                tr {
                                    th scope="row" { (label(parameter)) }
                                    @for value in &row[..=at] {
                                        td style=(colour(*value)) { (decimals(*value, 2)) }
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn label(parameter: &ParameterEstimate) -> String {
    match &parameter.segment {
        Some(segment) => format!("{} [{segment}]", parameter.name),
        None => parameter.name.clone(),
    }
}

fn high_pairs(free: &[&ParameterEstimate], rows: &[Vec<f64>]) -> Vec<String> {
    let mut pairs = Vec::new();
    for (at, row) in rows.iter().enumerate().take(free.len()) {
        for (other, value) in row.iter().enumerate().take(at) {
            if value.abs() > HIGH {
                let [first, second] = [other, at].map(|k| label(free[k]));
                pairs.push(format!("{first} and {second} ({value:.2})"));
            }
        }
    }
    pairs
}

/// Blue for the same sign, orange for opposite ones, the stronger the larger; the number tells it, too.
fn colour(value: f64) -> String {
    let side = if value >= 0.0 {
        "--measured"
    } else {
        "--model"
    };
    let share = (value.abs().min(1.0).powi(2) * 45.0).round();
    format!("background: color-mix(in srgb, var({side}) {share}%, transparent)")
}
