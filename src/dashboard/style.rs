//! Colours of figures.

/// Measured and model must be told apart by colour-blind readers and in print: blue dots, orange line
/// (Okabe and Ito).
pub(super) const MEASURED: plotters::style::RGBColor = plotters::style::RGBColor(0, 114, 178);
pub(super) const MODEL: plotters::style::RGBColor = plotters::style::RGBColor(213, 94, 0);

/// The model before its effects were found: grey, behind.
pub(super) const DECLARED: plotters::style::RGBColor = plotters::style::RGBColor(150, 150, 150);
