//! Colours of series side by side: those of Okabe and Ito, as scripts have them, and lines between dashes beyond them.

const PALETTE: [&str; 7] = [
    "#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8a8f94",
];

/// The colour of a place, from 0.
pub(super) fn colour(at: usize) -> &'static str {
    PALETTE[at % PALETTE.len()]
}
