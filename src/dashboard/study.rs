//! A derivative study on the page of its job: figures, techniques, costs and descents.

use maud::{Markup, PreEscaped, html};

use super::study_figure::{cost_figure, error_figure};
use crate::estimate::Scaling;
use crate::estimate::study::{DerivativeStudy, DescentResult};

/// Everything that the study found.
pub(super) fn study_section(study: &DerivativeStudy) -> Markup {
    html! {
        h2 { "Derivative techniques" }
        p.soft {
            (study.size.samples) " samples, " (study.size.states) " states, " (study.size.outputs) " outputs, "
            (study.size.unknowns) " unknowns; one gradient at the start values, and an estimation with each"
        }
        div.scroll tabindex="0" role="region" aria-label="Table" { (techniques(study)) }
        (figure("error of the gradient against the step", error_figure(&study.error_curves)))
        (figure("cost of a gradient against the number of parameters", cost_figure(&study.costs)))
        p.soft {
            "By the formulas of Machado 2022 (Euler scheme, full matrices): direct "
            (count(study.formula.direct_multiplications + study.formula.direct_additions)) " operations, reverse "
            (count(study.formula.reverse_multiplications + study.formula.reverse_additions)) "."
        }
        h2 { "The same gradient, other optimisers" }
        div.scroll tabindex="0" role="region" aria-label="Table" { (descents(&study.descents)) }
    }
}

fn figure(label: &str, svg: Result<String, String>) -> Markup {
    html! {
        figure.paper role="img" aria-label=(label) {
            @match svg {
                Ok(svg) => { (PreEscaped(svg)) }
                Err(error) => { p { "The figure could not be drawn: " (error) } }
            }
        }
    }
}

fn techniques(study: &DerivativeStudy) -> Markup {
    html! {
        table {
            thead { tr {
                th scope="col" { "technique" } th.number scope="col" { "error" } th.number scope="col" { "operations" } th.number scope="col" { "simulations" }
                th.number scope="col" { "CPU" } th.number scope="col" { "wall" } th.number scope="col" { "memory" } th.number scope="col" { "iterations" }
                th scope="col" { "outcome" } th.number scope="col" { "estimation" }
            } }
            tbody {
                @for row in &study.techniques {
                    tr {
                        td { (row.technique.replace('_', " ")) }
                        td.number { @match row.gradient_error {
                            Some(error) => { (format!("{error:.1e}")) }
                            None => { "reference" }
                        } }
                        td.number { (count(row.operations)) }
                        td.number { (row.simulations) }
                        td.number { (time(row.cpu_seconds)) }
                        td.number { (time(row.wall_seconds)) }
                        td.number { (format!("{:.0} kB", row.bytes as f64 / 1e3)) }
                        td.number { (row.iterations) }
                        td { (row.outcome) }
                        td.number { (time(row.estimation_wall_seconds)) }
                    }
                }
            }
        }
    }
}

fn descents(descents: &[DescentResult]) -> Markup {
    html! {
        table {
            thead { tr {
                th scope="col" { "optimiser" } th scope="col" { "Hessian at the start" } th.number scope="col" { "iterations" }
                th.number scope="col" { "gradients" } th.number scope="col" { "above the minimum" } th scope="col" { "" }
            } }
            tbody {
                @for row in descents {
                    tr {
                        td { (row.optimiser) }
                        td { (match row.scaling {
                            None => "information matrix, at every step",
                            Some(Scaling::Information) => "information matrix",
                            Some(Scaling::Sizes) => "sizes of the parameters",
                            Some(Scaling::None) => "none",
                        }) }
                        td.number { (row.iterations) }
                        td.number { (row.gradients) }
                        td.number { (format!("{:.1e}", row.cost_excess)) }
                        td.soft { (if row.reached { "" } else { "not there" }) }
                    }
                }
            }
        }
    }
}

fn count(operations: u64) -> String {
    format!("{:.2e}", operations as f64)
}

fn time(seconds: f64) -> String {
    if seconds < 1e-3 {
        format!("{:.0} µs", seconds * 1e6)
    } else if seconds < 1.0 {
        format!("{:.2} ms", seconds * 1e3)
    } else {
        format!("{seconds:.2} s")
    }
}
