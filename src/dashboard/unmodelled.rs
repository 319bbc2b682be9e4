//! What is left as a force that the model does not have: where, how large, when, and on what it depends.

use maud::{Markup, PreEscaped, html};

use super::force_figure::{MOST_FLIGHTS, force_over_quantity, force_over_time};
use crate::diagnose::{ForceDependence, ForceIn, LeftBy, Unmodelled};
use crate::estimate::{Role, five_digits as number};
use crate::flight::{Shown, shown_in};

/// The sentence stands in the verdict above; here are the pictures and numbers behind it.
pub(super) fn section(found: &Unmodelled) -> Markup {
    let Shown { scale, unit } = shown_in(&found.unit);
    let force = force_in(found);
    let more = found.flights.len().saturating_sub(MOST_FLIGHTS);
    html! {
        section.whole aria-labelledby="unmodelled" {
            h3 id="unmodelled" { (left(found.left_by)) ", as " (words(found.force_in)) " " (found.equation) }
            figure.paper {
                div role="img" aria-label={ "unmodelled force in " (found.equation) " over time" } { (drawn(force_svg(found))) }
                figcaption.soft {
                    "Where the declared parameters imitate it the band is wide."
                    @if found.flights.iter().any(|flight| flight.role != Role::Estimation) {
                        " In flights that were not fitted the parameters are as the fit has them, and the band is that of noise alone."
                    }
                    @if more > 0 { " " (more) " more flights are in the JSON." }
                }
            }
            @if let Some((best, curve)) = found.depends_on.iter().find_map(|d| Some((d, d.curve.as_ref()?))) {
                div.columns {
                    figure.paper {
                        div role="img" aria-label={ "unmodelled force over " (best.quantity) } {
                            (drawn(force_over_quantity(curve, (&best.quantity, &best.unit), (&force, &found.unit))))
                        }
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
                dt { "size" } dd { "up to " (number(found.largest * scale)) " " (unit) ", rms " (number(found.rms * scale)) " " (unit) }
                dt { "spectrum" } dd {
                    "most at " (number(found.spectrum.peak)) " Hz, four fifths of the power between " (number(found.spectrum.lower)) " and " (number(found.spectrum.upper)) " Hz"
                }
                @if !found.proposals.is_empty() {
                    dt { "worth trying" } dd { (found.proposals.join(", ")) }
                }
            }
        }
    }
}

fn left(by: LeftBy) -> &'static str {
    match by {
        LeftBy::WithEffects => "What is left",
        LeftBy::Declared => "What the declared model leaves",
    }
}

/// An unmodelled force over the time of each flight, as SVG; angles in degrees.
///
/// # Errors
/// The drawing library's words; none is known for finite numbers.
pub fn force_svg(found: &Unmodelled) -> Result<String, String> {
    force_over_time(&found.flights, (&force_in(found), &found.unit))
}

/// As axes call it.
fn force_in(found: &Unmodelled) -> String {
    match found.force_in {
        ForceIn::State => format!("force in {}", found.equation),
        ForceIn::Coefficient => format!("increment of {}", found.equation),
        ForceIn::Output => format!("error of {}", found.equation),
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
