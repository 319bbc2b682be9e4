//! Colours of figures: those of Okabe and Ito, which colour-blind readers tell apart, and print does.

use plotters::style::RGBColor;

/// Blue, in dots.
pub(super) const MEASURED: RGBColor = RGBColor(0, 114, 178);
/// Orange, in lines.
pub(super) const MODEL: RGBColor = RGBColor(213, 94, 0);
/// Green, where there is a third of equal rank.
pub(super) const THIRD: RGBColor = RGBColor(0, 158, 115);

/// The model before its effects were found: grey, behind.
pub(super) const DECLARED: RGBColor = RGBColor(150, 150, 150);
