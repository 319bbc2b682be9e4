//! What is left as a force that the model does not have: where, how large, when, and on what it depends.

use maud::{Markup, PreEscaped, html};

use super::force_figure::{force_over_quantity, force_over_time};
use crate::diagnose::{ForceDependence, ForceIn, Unmodelled};
use crate::estimate::{Role, five_digits as number};
use crate::flight::{Shown, shown_in};

pub(super) fn section(found: &Unmodelled) -> Markup {
    let Shown { scale, unit } = shown_in(&found.unit);
    html! {
        h3 { "What is left, as " (words(found.force_in)) " " (found.equation) }
        p { (found.sentence) "." }
        figure.paper role="img" aria-label={ "unmodelled force in " (found.equation) " over time" } {
            (drawn(force_over_time(&found.flights, &found.unit)))
            figcaption.soft {
                "With a band of 95 %; where the declared parameters imitate it the band is wide. "
                @for flight in found.flights.iter().filter(|flight| flight.role != Role::Estimation) {
                    (flight.segment) " took no part in the fit. "
                }
            }
        }
        @if let Some((best, curve)) = found.depends_on.iter().find_map(|d| Some((d, d.curve.as_ref()?))) {
            div.columns {
                figure.paper role="img" aria-label={ "unmodelled force over " (best.quantity) } {
                    (drawn(force_over_quantity(curve, (&best.quantity, &best.unit), ("force", &found.unit))))
                    figcaption.soft { "Over " (best.quantity) ", without what the declared parameters imitate of it" }
                }
                (dependences(&found.depends_on))
            }
        }
        dl.facts {
            dt { "evidence" } dd {
                "likelihood ratio " (format!("{:.1}", found.likelihood_ratio)) ", to pass: " (format!("{:.1}", found.threshold))
                ", worth " (format!("{:.0}", found.freedom)) " parameters"
            }
            @if let Some(next) = found.elsewhere.first() {
                dt { "next best" } dd { (words(next.force_in)) " " (next.equation) ": " (format!("{:.1}", next.likelihood_ratio)) }
            }
            dt { "size" } dd { "up to " (number(found.largest * scale)) " " (unit) ", rms " (number(found.rms * scale)) }
            dt { "spectrum" } dd {
                "most at " (number(found.spectrum.peak)) " Hz, four fifths of the power between " (number(found.spectrum.lower)) " and " (number(found.spectrum.upper)) " Hz"
            }
            @if !found.proposals.is_empty() {
                dt { "terms that would make it" } dd { (found.proposals.join(", ")) }
            }
        }
    }
}

fn words(force_in: ForceIn) -> &'static str {
    match force_in {
        ForceIn::State => "a force in the equation of",
        ForceIn::Coefficient => "an increment of",
        ForceIn::Output => "an error of the output",
    }
}

fn drawn(figure: Result<String, String>) -> Markup {
    match figure {
        Ok(svg) => PreEscaped(svg),
        Err(error) => html! { p { "The figure could not be drawn: " (error) } },
    }
}

fn dependences(all: &[ForceDependence]) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label="What the force depends on" {
            table {
                thead { tr { th scope="col" { "depends on" } th.number scope="col" { "share in flights not fitted" } } }
                tbody {
                    @for one in all {
                        tr { th scope="row" { (one.quantity) } td.number { (format!("{:.0} %", 100.0 * one.share)) } }
                    }
                }
            }
        }
    }
}
