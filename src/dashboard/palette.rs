//! Colours of series side by side: those of Okabe and Ito, as scripts have them, and lines between dashes beyond them.

use maud::{Markup, html};

const PALETTE: [&str; 7] = [
    "#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8a8f94",
];

/// The colour of a place, from 0.
pub(super) fn colour(at: usize) -> &'static str {
    PALETTE[at % PALETTE.len()]
}

/// The number and colour of a job, by which figures call it.
pub(super) fn number_of(at: usize) -> Markup {
    html! { span.key style={ "--of: " (colour(at)) } { (at + 1) } }
}
